//! What every planner is: a function from a belief to a decision.

use serde::{Deserialize, Serialize};

use crate::{Actions, Belief, Costs, Decision, Model};

/// The decision problem `(S, A, T, R, Ω, O)` of section 3, but for the belief.
///
/// `Q_t` and `Q_v` are known to the robot and `D` never changes, so what a planner needs of the
/// state is the belief over objects alone.
#[derive(Clone, Copy, Debug)]
pub struct DecisionProblem<'a> {
    /// Objects, attributes, and how people answer.
    pub model: &'a Model,
    /// What actions cost and a pick is worth.
    pub costs: Costs,
    /// What the robot can do.
    pub actions: Actions,
}

/// Which decision of which interaction: all the randomness that a planner may use, so that a
/// replay decides the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Step {
    /// Which interaction, counted over the life of the group.
    pub interaction: u64,
    /// Which decision in it, from 0.
    pub step: u32,
}

/// A planner.
///
/// A decision depends on problem, belief and step alone. A planner may keep what it computed, but
/// never so that an earlier decision shows in a later one.
pub trait Planner {
    /// The name that the registry knows it by.
    fn name(&self) -> &'static str;

    /// What to do.
    ///
    /// # Panics
    /// If the belief is not about the problem's scene.
    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision;
}
