//! The decision problem that `plan` and `export` are about.

use std::path::{Path, PathBuf};

use dialogue::{Actions, Costs, Model, Params, registry};
use runtime::exit::Exit;
use scene::Scene;
use settings::Dialogue;

use super::place;
use crate::batch::Decider;
use crate::cli::{ConfigArgs, PlanArgs, ProblemArgs};
use crate::scene_file;
use crate::trouble::Trouble;

/// What decides where neither the command line nor a configuration says.
const PLANNER: &str = "lookahead";

/// A scene's decision problem, with what it borrows.
pub(super) struct Problem {
    pub(super) scene: Scene,
    pub(super) model: Model,
    pub(super) costs: Costs,
    pub(super) actions: Actions,
}

/// The planner and its problem.
///
/// # Errors
/// A scene or a configuration that is wrong.
pub(super) fn decider(args: &PlanArgs) -> Result<Decider, Trouble> {
    let scene = scene_file::load(&args.scene)?;
    let configured = configured(&args.problem.config)?;
    let Problem { scene, model, costs, actions } =
        problem(scene, &args.problem, configured.as_ref());
    let named = configured.as_ref().map(|dialogue| &*dialogue.planner);
    let planner = registry::planner(args.planner.as_deref().or(named).unwrap_or(PLANNER))
        .map_err(|error| Trouble::new(Exit::Config, error.to_string()))?;
    Ok(Decider { scene, model, costs, actions, planner })
}

/// The problem of a scene given by its file or by its name in the configuration.
///
/// # Errors
/// A scene or a configuration that is wrong.
pub(super) fn of_scene(scene: &Path, args: &ProblemArgs) -> Result<Problem, Trouble> {
    let scene = scene_file::load(&scene_path(scene, &args.config)?)?;
    Ok(problem(scene, args, configured(&args.config)?.as_ref()))
}

/// What the command line says, else the configuration, else what is built in.
fn problem(scene: Scene, args: &ProblemArgs, configured: Option<&Dialogue>) -> Problem {
    let params = configured.map_or_else(Params::default, |dialogue| dialogue.params);
    let preset = args.costs.as_deref().and_then(Costs::preset);
    let costs = preset.or(configured.map(|dialogue| dialogue.costs)).unwrap_or_default();
    let actions =
        Actions { mode: args.mode.into(), attribute: !args.no_attr, which: !args.no_which };
    let model = Model::new(&scene, params);
    Problem { scene, model, costs, actions }
}

/// The configuration; none where none is named and none is found.
fn configured(args: &ConfigArgs) -> Result<Option<Dialogue>, Trouble> {
    let named = args.config.is_some() || args.profile.is_some() || !args.set.is_empty();
    match place::config_folder(args) {
        Err(_) if !named => Ok(None),
        _ => Ok(Some(place::settings(args)?.dialogue)),
    }
}

/// A word that is no file's name is one of the configuration's scenes.
fn scene_path(named: &Path, args: &ConfigArgs) -> Result<PathBuf, Trouble> {
    let is_word = named.extension().is_none() && named.components().count() == 1;
    if named.is_file() || !is_word {
        return Ok(named.to_owned());
    }
    let scenes = place::config_folder(args)?.join("scenes");
    let path = scenes.join(named).with_extension("toml");
    if path.is_file() {
        return Ok(path);
    }
    let (name, folder) = (named.display(), scenes.display());
    let what = format!("{name}: there is no file of that name, nor a scene in {folder}");
    let cure = "name a scene file, or a scene without its folder and ending, e.g. bowls";
    Err(Trouble::new(Exit::Config, format!("{what} ({cure})")))
}
