//! A partially observable Markov decision problem with finitely many states.

use crate::{Matrix, Rewards};

/// Most pairs of an action and a state: beyond, text is no sensible form of a problem.
pub const PAIRS_MAX: usize = 5_000_000;

/// A decision problem `(S, A, T, R, Ω, O)`. Lists that were given as a count alone have the names
/// `0`, `1`, `2` …
#[derive(Clone, Debug, PartialEq)]
pub struct Pomdp {
    /// Discount per action.
    pub discount: f64,
    /// Whether amounts are paid to the agent or by it.
    pub values: Values,
    /// Names of the states.
    pub states: Vec<String>,
    /// Names of the actions.
    pub actions: Vec<String>,
    /// Names of the observations.
    pub observations: Vec<String>,
    /// The belief at the start, per state.
    pub start: Start,
    /// `T(s, a, s')`: a matrix per action, a row per start state, a column per end state.
    pub transition: Vec<Matrix>,
    /// `O(s', a, o)`: a matrix per action, a row per end state, a column per observation.
    pub observation: Vec<Matrix>,
    /// `R(s, a, s', o)`.
    pub reward: Rewards,
}

/// Sign of the amounts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Values {
    /// The more the better.
    Reward,
    /// The less the better.
    Cost,
}

/// Probability of every state at the start.
pub type Start = Vec<f64>;

impl Pomdp {
    /// Expected amount of an action in a state: `Σ_s' T(s,a,s') Σ_o O(s',a,o) R(s,a,s',o)`, with
    /// the sign of a reward.
    pub fn expected_reward(&self, action: usize, state: usize) -> f64 {
        let mut sum = 0.0;
        for &(end, to) in self.transition[action].row(state) {
            for &(seen, p) in self.observation[action].row(end as usize) {
                sum += to * p * self.reward.get(action, state, end as usize, seen as usize);
            }
        }
        match self.values {
            Values::Reward => sum,
            Values::Cost => -sum,
        }
    }
}
