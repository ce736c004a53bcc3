//! The decision problem that `plan` is asked about.

use dialogue::{Actions, Costs, Model, Params, registry};
use runtime::exit::Exit;

use super::place;
use crate::batch::Decider;
use crate::cli::PlanArgs;
use crate::scene_file;
use crate::trouble::Trouble;

/// What decides where neither the command line nor a configuration says.
const PLANNER: &str = "lookahead";

/// The planner and its problem: what the command line says, else the configuration, else, where no
/// configuration is found, what is built in.
///
/// # Errors
/// A scene or a configuration that is wrong.
pub(super) fn decider(args: &PlanArgs) -> Result<Decider, Trouble> {
    let scene = scene_file::load(&args.scene)?;
    let named = args.config.config.is_some()
        || args.config.profile.is_some()
        || !args.config.set.is_empty();
    let dialogue = match place::config_folder(&args.config) {
        Err(_) if !named => None,
        _ => Some(place::settings(&args.config)?.dialogue),
    };
    let configured = dialogue.as_ref();
    let params = configured.map_or_else(Params::default, |dialogue| dialogue.params);
    let preset = args.costs.as_deref().and_then(Costs::preset);
    let costs = preset.or(configured.map(|dialogue| dialogue.costs)).unwrap_or_default();
    let planner = args.planner.as_deref().or(configured.map(|dialogue| &*dialogue.planner));
    let planner = registry::planner(planner.unwrap_or(PLANNER))
        .map_err(|error| Trouble::new(Exit::Config, error.to_string()))?;
    let actions =
        Actions { mode: args.mode.into(), attribute: !args.no_attr, which: !args.no_which };
    let model = Model::new(&scene, params);
    Ok(Decider { scene, model, costs, actions, planner })
}
