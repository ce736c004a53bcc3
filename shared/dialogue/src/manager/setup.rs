//! Settings by which the manager decides.

use scene::Scene;
use vocabulary::gesture::Gestures;
use vocabulary::{Acquaintance, Actions, Announce, Costs, Durations, Prior, TurnTaking};

use crate::{DecisionProblem, Model};

/// Everything that the manager decides by, besides its planner.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup {
    /// The scene.
    pub scene: Scene,
    /// Observation model of the scene.
    pub model: Model,
    /// Costs of the actions.
    pub costs: Costs,
    /// Measured durations of the actions, if any.
    pub durations: Option<Durations>,
    /// Actions that the robot may take.
    pub actions: Actions,
    /// Whether an announced pick can be denied, in the planner's eyes.
    pub announce: Announce,
    /// Prior of a new interaction.
    pub prior: Prior,
    /// Model of pointing gestures and the user's place (metres, frame `base`); `None` if gestures
    /// do not count.
    pub gestures: Option<(Gestures, [f64; 3])>,
    /// Settings of turn-taking.
    pub turns: TurnTaking,
    /// Settings of learning about people who give their name.
    pub people: Acquaintance,
    /// Whether objects come from perception; those of the scene are then the possible ones.
    pub perceives: bool,
}

impl Setup {
    /// Returns the decision problem for planners.
    pub(super) fn problem(&self) -> DecisionProblem<'_> {
        let problem = DecisionProblem::new(self.model.plain(), self.costs, self.actions);
        DecisionProblem { durations: self.durations.as_ref(), announce: self.announce, ..problem }
    }
}
