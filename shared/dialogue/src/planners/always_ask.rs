//! `always-ask`: the predecessor's baseline that never picks without having asked.

use vocabulary::{Actions, Mode};

use crate::{Belief, Decision, DecisionProblem, Planner, Step};

use super::{Entry, Outlook};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "always-ask",
    about: "Picks only after a question and at 95 %; the predecessor's baseline.",
    make: || Box::new(AlwaysAsk),
};

/// Asks at least once, and until one object is very probable: on site, it points at the most
/// probable object; remotely, it asks the most informative question. Objects that no question can
/// distinguish count as one.
#[derive(Clone, Copy, Debug, Default)]
struct AlwaysAsk;

/// Probability from which on it is sure.
const SURE: f64 = 0.95;

impl Planner for AlwaysAsk {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        let actions = match problem.actions.mode {
            Mode::Present => {
                Actions { mode: Mode::Present, attribute: false, which: false, choice: false }
            }
            Mode::Remote => problem.actions,
        };
        let problem = &DecisionProblem { actions, ..problem.with_final_picks() };
        let outlook = Outlook::new(problem, belief);
        // Pointing questions come in order of falling probability: the first is at the most
        // probable object, even if pointing at the next is as informative.
        let choices = outlook.one_step.choices.iter();
        let question = choices.reduce(|a, b| {
            let more = problem.actions.mode == Mode::Remote && b.information > a.information;
            if more { b } else { a }
        });
        let sure = outlook.one_step.peak >= SURE && step.step > 0;
        outlook.decide(problem, belief, question.filter(|_| !sure))
    }
}
