//! The decision problem of `plan`, `export` and `study`.

use command_line::args::ConfigArgs;
use command_line::configuration;
use setup::DialogueSettings;
use std::path::Path;

use config::CostsFrom;
use dialogue::{Model, registry};
use model_reader::Configured;
use preflight::ArmSetup;
use scene::Scene;
use service::exit::{Exit, Failure};
use vocabulary::{Actions, Announce, Costs, Language, Mode, Params};

use crate::args::{GroundArgs, PlanArgs, ProblemArgs};
use crate::batch::{Calibrator, Decider, Grounder, Problem};
use crate::scene_file;

/// Default planner without an option and a configuration.
const PLANNER: &str = "lookahead";

/// The name of the planner that is configured for a problem.
pub(crate) fn planner_of(problem: &Problem) -> &str {
    problem.settings.as_ref().map_or(PLANNER, |settings| &settings.dialogue.planner)
}

/// Returns the named planner with the decision problem.
pub(crate) fn decider(args: &PlanArgs) -> Result<Decider, Failure> {
    let follows = args.problem.config.is_given();
    let problem = of_scene(&args.scene, &args.problem, follows)?;
    let planner = registry::planner(args.planner.as_deref().unwrap_or(planner_of(&problem)))
        .map_err(|error| Failure::new(Exit::Config, error.to_string()))?;
    Ok(Decider { problem, planner })
}

/// The reader of utterances about a scene.
pub(crate) fn grounder(args: &GroundArgs) -> Result<Grounder, Failure> {
    let scene = scene_file::load_named(&args.scene, &args.config)?;
    let language = match args.language {
        Some(language) => language,
        None if args.config.is_given() => configuration::settings(&args.config)?.dialogue.language,
        None => Language::Careful,
    };
    Ok(Grounder::new(scene, language))
}

/// The calibrator of the configured language model for a scene.
pub(crate) fn calibrator(scene: &Path, config: &ConfigArgs) -> Result<Calibrator, Failure> {
    let Configured(model) = configuration::settings(config)?.part()?;
    let model = model.ok_or_else(|| {
        let help = "help: set dialogue.model.url and dialogue.model.model";
        let what = "--calibrate: the configuration has no language model";
        Failure::new(Exit::Config, format!("{what}; {help}"))
    })?;
    Calibrator::new(scene_file::load_named(scene, config)?, model)
}

/// The problem of a scene given by its file or by its name in the configuration. With `follows`,
/// all that the command line leaves open is as the robot of the configuration does it.
pub(crate) fn of_scene(
    scene: &Path,
    args: &ProblemArgs,
    follows: bool,
) -> Result<Problem, Failure> {
    problem(scene_file::load_named(scene, &args.config)?, args, follows)
}

/// Builds the problem from the command line, else the configuration, else, if none is named or
/// found, the defaults.
fn problem(scene: Scene, args: &ProblemArgs, follows: bool) -> Result<Problem, Failure> {
    let config = &args.config;
    let settings = match configuration::folder(config) {
        Err(_) if !config.is_given() => None,
        _ => Some(configuration::settings(config)?),
    };
    let configured = settings.as_ref().map(|settings| &settings.dialogue);
    let params = configured.map_or_else(Params::default, |dialogue| dialogue.params);
    // Else every answer is as reliable as a yes or no.
    let params = if follows { params } else { Params { open: None, choice: None, ..params } };
    let preset = args.costs.as_deref().and_then(Costs::preset);
    let costs = preset.or(configured.map(|dialogue| dialogue.costs)).unwrap_or_default();
    let followed = settings.as_ref().filter(|_| follows);
    let scene = match followed {
        Some(settings) => settings.dialogue.by_place(scene),
        None => scene,
    };
    let all = Actions { mode: Mode::Remote, attribute: true, which: true, choice: false };
    let allowed = followed.map_or(all, |settings| settings.dialogue.actions);
    let actions = Actions {
        mode: args.mode.unwrap_or(allowed.mode),
        attribute: allowed.attribute && !args.no_attr,
        which: allowed.which && !args.no_which,
        choice: (allowed.choice || args.choice) && !args.no_choice,
    };
    let model =
        followed.map_or_else(|| Model::new(&scene, params), |settings| settings.model_of(&scene));
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
    let heard = followed.map(|settings| settings.dialogue.announce.heard);
    let announce = Announce { heard: args.announce.or(heard).unwrap_or_default(), cost_s };
    Ok(Problem { scene, model, costs, durations, actions, announce, settings })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn problem_follows_the_configuration_where_it_is_asked_to() {
        let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config");
        let set = [("dialogue.mode", "present"), ("dialogue.announce.heard", "0.5")];
        let set = set.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec();
        let config = ConfigArgs { config: Some(config), set, profile: None };
        let args = ProblemArgs {
            mode: None,
            no_attr: false,
            no_which: false,
            choice: false,
            no_choice: false,
            costs: None,
            announce: None,
            config,
        };
        let scene = Path::new("bowls");
        let followed = of_scene(scene, &args, true).unwrap();
        assert_eq!((followed.actions.mode, followed.actions.which), (Mode::Present, false));
        assert_eq!(followed.announce.heard, 0.5);
        let own = of_scene(scene, &args, false).unwrap();
        assert_eq!((own.actions.mode, own.actions.which), (Mode::Remote, true));
        assert_eq!((own.actions.choice, own.model.params().choice), (false, None));
        assert_eq!(own.announce.heard, 0.0);
        let args = ProblemArgs { mode: Some(Mode::Remote), announce: Some(0.1), ..args };
        let mixed = of_scene(scene, &args, true).unwrap();
        assert!(mixed.actions.choice && mixed.model.params().choice.is_some());
        let choosing = ProblemArgs { choice: true, ..args };
        assert!(of_scene(scene, &choosing, true).unwrap().actions.choice);
        assert_eq!((mixed.actions.mode, mixed.announce.heard), (Mode::Remote, 0.1));
    }
}
