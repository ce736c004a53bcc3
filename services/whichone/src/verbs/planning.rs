//! The decision problem of `plan`, `export` and `study`.

use std::path::{Path, PathBuf};

use config::CostsFrom;
use dialogue::{Actions, Announce, Costs, Model, Params, registry};
use preflight::ArmSetup;
use scene::Scene;
use service::exit::{Exit, Failure};

use super::paths;
use crate::batch::{Decider, Problem};
use crate::cli::{ConfigArgs, PlanArgs, ProblemArgs};
use crate::scene_file;

/// Default planner without an option and a configuration.
const PLANNER: &str = "lookahead";

/// The name of the planner that is configured for a problem.
pub(super) fn planner_of(problem: &Problem) -> &str {
    problem.settings.as_ref().map_or(PLANNER, |settings| &settings.dialogue.planner)
}

/// The planner and its problem.
pub(super) fn decider(args: &PlanArgs) -> Result<Decider, Failure> {
    let problem = of_scene(&args.scene, &args.problem)?;
    let planner = registry::planner(args.planner.as_deref().unwrap_or(planner_of(&problem)))
        .map_err(|error| Failure::new(Exit::Config, error.to_string()))?;
    Ok(Decider { problem, planner })
}

/// The problem of a scene given by its file or by its name in the configuration.
pub(super) fn of_scene(scene: &Path, args: &ProblemArgs) -> Result<Problem, Failure> {
    problem(load_scene(scene, &args.config)?, args)
}

/// Reads a scene given by its file or by its name in the configuration.
pub(super) fn load_scene(named: &Path, args: &ConfigArgs) -> Result<Scene, Failure> {
    scene_file::load(&scene_path(named, args)?)
}

/// Builds the problem from the command line, else the configuration, else, if none is named or
/// found, the defaults.
fn problem(scene: Scene, args: &ProblemArgs) -> Result<Problem, Failure> {
    let config = &args.config;
    let settings = match paths::config_folder(config) {
        Err(_) if !config.is_given() => None,
        _ => Some(paths::settings(config)?),
    };
    let configured = settings.as_ref().map(|settings| &settings.dialogue);
    let params = configured.map_or_else(Params::default, |dialogue| dialogue.params);
    let preset = args.costs.as_deref().and_then(Costs::preset);
    let costs = preset.or(configured.map(|dialogue| dialogue.costs)).unwrap_or_default();
    let actions = Actions { mode: args.mode, attribute: !args.no_attr, which: !args.no_which };
    let model = Model::new(&scene, params);
    // A preset counts in units of its own.
    let of_robot = settings
        .as_ref()
        .filter(|settings| preset.is_none() && settings.dialogue.costs_from == CostsFrom::Robot);
    let durations = of_robot
        .map(|settings| {
            let setup = ArmSetup::new(settings)?;
            preflight::durations(settings, &setup, &scene, actions.point())
                .map_err(|error| Failure::new(Exit::Config, error.to_string()))
        })
        .transpose()?;
    let cost_s = configured.map_or(Announce::COST_S, |dialogue| dialogue.announce.cost_s);
    let announce = Announce { heard: args.announce.unwrap_or_default(), cost_s };
    Ok(Problem { scene, model, costs, durations, actions, announce, settings })
}

/// Resolves a scene: a name without folder and extension is looked up in the configuration.
pub(super) fn scene_path(named: &Path, args: &ConfigArgs) -> Result<PathBuf, Failure> {
    let is_word = named.extension().is_none() && named.components().count() == 1;
    if named.is_file() || !is_word {
        return Ok(named.to_owned());
    }
    let scenes = paths::config_folder(args)?.join("scenes");
    let path = scenes.join(named).with_extension("toml");
    if path.is_file() {
        return Ok(path);
    }
    let (name, folder) = (named.display(), scenes.display());
    let what = format!("{name}: expected a scene file or the name of a scene in {folder}");
    let help = "name a scene file, or a scene without its folder and extension, e.g. bowls";
    Err(Failure::new(Exit::Config, format!("{what}; help: {help}")))
}
