//! `no-attribute`: the paper's baseline, which cannot ask about attributes (section 5).

use crate::{Actions, Belief, Decision, DecisionProblem, Lookahead, Planner, Step};

/// [`Lookahead`] with nothing but waiting, pointing and picking. Remotely it cannot point either,
/// and picks or waits.
#[derive(Clone, Debug, Default)]
pub(crate) struct NoAttribute(Lookahead);

impl Planner for NoAttribute {
    fn name(&self) -> &'static str {
        "no-attribute"
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        let actions = Actions { mode: problem.actions.mode, attribute: false, which: false };
        self.0.decide(&DecisionProblem { actions, ..*problem }, belief, step)
    }
}
