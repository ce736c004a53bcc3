//! `no-attribute`: the paper's baseline, which cannot ask about attributes (section 5).

use vocabulary::Actions;

use super::Entry;
use crate::{Belief, Decision, DecisionProblem, Lookahead, Planner, Step};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "no-attribute",
    about: "Asks no questions about attributes; the paper's baseline.",
    make: || Box::new(NoAttribute::default()),
};

/// [`Lookahead`] with nothing but waiting, pointing and picking. Remotely it cannot point either,
/// and picks or waits.
#[derive(Clone, Debug, Default)]
struct NoAttribute(Lookahead);

impl Planner for NoAttribute {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        let mode = problem.actions.mode;
        let actions = Actions { mode, attribute: false, which: false, choice: false };
        self.0.decide(&DecisionProblem { actions, ..*problem }, belief, step)
    }
}
