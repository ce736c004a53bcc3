//! Scenes and problems for the tests of this crate.

use dialogue::{Actions, Costs, DecisionProblem, Mode, Model};
use scene::Scene;

/// The paper's six bowls, with places.
pub(crate) fn bowls() -> Scene {
    Scene::from_toml("bowls.toml", include_str!("../../../../config/scenes/bowls.toml"))
        .unwrap_or_else(|problems| panic!("{problems:?}"))
}

pub(crate) fn yes_no(model: &Model) -> DecisionProblem<'_> {
    let actions = Actions { mode: Mode::Remote, attribute: true, which: false };
    DecisionProblem::new(model, Costs::SECONDS, actions)
}
