//! `never-ask`: the predecessor's baseline that acts on what it was told unasked.

use crate::{Belief, Decision, DecisionProblem, Planner, Step};

use super::Outlook;

/// Picks the most probable object, or waits where a pick is worth less than waiting for ever.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NeverAsk;

impl Planner for NeverAsk {
    fn name(&self) -> &'static str {
        "never-ask"
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, _: Step) -> Decision {
        Outlook::new(problem, belief).decide(problem, belief, None)
    }
}
