//! A scene with everything that simulations need of it, for the tests of this crate.

use dialogue::{DecisionProblem, Model, registry};
use language::Reader;
use preflight::{Pace, Voice};
use scene::Scene;
use vocabulary::{Acquaintance, Actions, Costs, Language, Mode, Params, TurnTaking};

use crate::simulation::users::Domain;
use crate::simulation::{CachedPlanner, Room};

/// The paper's six bowls, with places.
pub(crate) fn bowls() -> Scene {
    Scene::from_toml("bowls.toml", include_str!("../../../../config/scenes/bowls.toml"))
        .unwrap_or_else(|problems| panic!("{problems:?}"))
}

pub(crate) fn planner(name: &str) -> CachedPlanner {
    CachedPlanner::new(registry::planner(name).unwrap())
}

/// The six bowls, and how people talk about them.
pub(crate) struct House {
    pub(crate) scene: Scene,
    pub(crate) reader: Reader,
    pub(crate) model: Model,
    pace: Pace,
}

impl House {
    pub(crate) fn new() -> Self {
        let scene = bowls();
        let reader = Reader::new(&scene, Language::Careful);
        let model = Model::new(&scene, Params::default());
        Self { scene, reader, model, pace: Pace::default() }
    }

    pub(crate) fn domain(&self) -> Domain<'_> {
        Domain { scene: &self.scene, model: &self.model }
    }

    /// A remote robot that asks yes/no questions.
    pub(crate) fn problem(&self) -> DecisionProblem<'_> {
        let actions = Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };
        DecisionProblem::new(&self.model, Costs::SECONDS, actions)
    }

    pub(crate) fn room(&self) -> Room<'_> {
        Room {
            scene: &self.scene,
            reader: &self.reader,
            problem: self.problem(),
            turns: TurnTaking::default(),
            voice: Voice::default(),
            pace: &self.pace,
            motions: None,
            people: Acquaintance::default(),
            request: true,
            denials: true,
        }
    }
}
