//! What the manager decides by: the shipped configuration, which a page cannot read.
//!
//! A test compares it with `config/*.toml` as the robot reads them.

use dialogue::manager::{Manager, Setup};
use dialogue::registry::{self, UnknownPlanner};
use dialogue::{CERTAIN_SMOOTHING, Confusion, Model, NotAConfusion};
use scene::Scene;
use vocabulary::{
    Acquaintance, Actions, Announce, Costs, Language, PLANNERS, Params, Prior, PriorObjects,
    Reliability, TurnTaking,
};

/// How utterances are read.
pub const LANGUAGE: Language = Language::Careful;
/// Probability that a user takes a value for another one.
const MISPERCEPTION: f64 = 0.004;
const OPEN: Reliability = Reliability { p_l: 0.85, epsilon: 0.03 };
const CHOICE: Reliability = Reliability { p_l: 0.93, epsilon: 0.015 };
const PRIOR: Prior = Prior { objects: PriorObjects::Uniform, smoothing: 1.0, absent: 0.0 };
const ANNOUNCE: Announce = Announce { heard: 0.0, cost_s: 8.0 };

/// Error of building a dialogue manager for a scene.
#[derive(Debug, thiserror::Error)]
pub enum SetupError {
    /// The planner does not exist.
    #[error(transparent)]
    Planner(#[from] UnknownPlanner),
    /// The language's table of similar words is inconsistent.
    #[error(transparent)]
    Confusion(#[from] NotAConfusion),
}

/// Returns the dialogue manager of a scene.
///
/// # Errors
/// An inconsistent table of similar words.
pub fn manager(scene: Scene) -> Result<Manager, SetupError> {
    let planner = registry::planner(PLANNERS[0])?;
    let key = scene.key();
    Ok(Manager::new(setup(scene)?, planner, key))
}

/// Returns everything that the manager decides by, besides its planner.
///
/// # Errors
/// An inconsistent table of similar words.
pub fn setup(scene: Scene) -> Result<Setup, NotAConfusion> {
    let params = Params { open: Some(OPEN), choice: Some(CHOICE), ..Params::default() };
    let rates = vec![MISPERCEPTION; scene.attributes().len()];
    let model = Model::new(&scene, params)
        .with_certain_words(CERTAIN_SMOOTHING)
        .with_misperceptions(&rates)
        .with_confusion(Confusion::from_rows(words::confusion(&scene))?);
    Ok(Setup {
        scene,
        model,
        costs: Costs::default(),
        durations: None,
        actions: Actions { which: false, choice: true, ..Actions::default() },
        announce: ANNOUNCE,
        prior: PRIOR,
        gestures: None,
        turns: TurnTaking::default(),
        people: Acquaintance::default(),
        perceives: false,
    })
}
