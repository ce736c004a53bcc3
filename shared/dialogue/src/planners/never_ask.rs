//! `never-ask`: the predecessor's baseline that acts on the request alone.

use crate::{Belief, Decision, DecisionProblem, Planner, Step};

use super::{Entry, Outlook};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "never-ask",
    about: "Acts on the request alone; the predecessor's baseline.",
    make: || Box::new(NeverAsk),
};

/// Picks the most probable object, or waits if a pick is worth less than waiting for ever.
#[derive(Clone, Copy, Debug, Default)]
struct NeverAsk;

impl Planner for NeverAsk {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, _: Step) -> Decision {
        let problem = &problem.with_final_picks();
        Outlook::new(problem, belief).decide(problem, belief, None)
    }
}
