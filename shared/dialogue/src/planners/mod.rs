//! The planners, one file each, and the common parts of their decisions.

mod searched;

/// Declares the planners' modules and lists their entries.
macro_rules! declare {
    ($($module:ident $name:literal),+ $(,)?) => {
        $(mod $module;)+

        /// Every planner, as in [`PLANNERS`].
        pub(crate) const ALL: [Entry; PLANNERS.len()] = [$($module::ENTRY),+];
    };
}

vocabulary::planners!(declare);

pub use lookahead::Lookahead;
pub use optimal::Optimal;

use vocabulary::{Action, PLANNERS};

use crate::Planner;
use crate::planning::{Bound, Choice, OneStepEvaluator, OneStepLookahead, Reduced};
use crate::{Belief, Decision, DecisionProblem};

/// A planner in the registry.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// Name on the command line and in the configuration.
    pub name: &'static str,
    /// Description in one sentence.
    pub about: &'static str,
    /// Makes the planner with its default settings.
    pub make: fn() -> Box<dyn Planner + Send>,
}

/// Most picks that a decision weighs.
const PICKS_MAX: usize = 3;

/// A belief seen one step ahead, as the planners see it that look no further. They take picks for
/// final ([`DecisionProblem::with_final_picks`]).
struct Outlook {
    reduced: Reduced,
    one_step: OneStepLookahead,
}

impl Outlook {
    fn new(problem: &DecisionProblem<'_>, belief: &Belief) -> Self {
        let reduced = Reduced::new(problem, belief);
        let bound = Bound::new(&reduced, &problem.costs);
        let one_step = OneStepEvaluator::new(&reduced, &bound).look_ahead(&reduced.mass);
        Self { reduced, one_step }
    }

    /// The better of picking and waiting.
    fn stop(&self, problem: &DecisionProblem<'_>) -> Action {
        stop(problem, &self.reduced, self.one_step.class, self.one_step.stop)
    }

    /// The decision to stop, or to ask `choice`. The value of a question is the value of stopping
    /// after its answer.
    fn decide(
        &self,
        problem: &DecisionProblem<'_>,
        belief: &Belief,
        choice: Option<&Choice>,
    ) -> Decision {
        let asks = |choice: &Choice| Action::Ask(self.reduced.question(choice.query));
        let asked = self.one_step.choices.iter().map(|c| (asks(c), c.value.lower)).collect();
        let (action, value) = choice.map_or_else(
            || (self.stop(problem), self.one_step.stop),
            |choice| (asks(choice), choice.value.lower),
        );
        let expected_questions = choice.map_or(0.0, |choice| {
            self.reduced.channel(choice.query).times_until_spent(self.one_step.entropy)
        });
        let alternatives = alternatives(problem, belief, asked, action);
        Decision { action, value, alternatives, expected_questions, bounds: None }
    }
}

/// The better of picking from a class and waiting, given the value of the better one.
fn stop(problem: &DecisionProblem<'_>, reduced: &Reduced, class: usize, value: f64) -> Action {
    if value <= problem.costs.wait_value() {
        return Action::Wait;
    }
    Action::Pick(reduced.best[class])
}

/// The alternatives, best first: questions, the best picks if these are final, and waiting, without
/// the choice.
fn alternatives(
    problem: &DecisionProblem<'_>,
    belief: &Belief,
    mut weighed: Vec<(Action, f64)>,
    chosen: Action,
) -> Vec<(Action, f64)> {
    weighed.push((Action::Wait, problem.costs.wait_value()));
    let chances = match problem.announce.is_final() {
        true => problem.concessions.chances(problem.model, belief),
        false => Vec::new(),
    };
    let mut picks: Vec<(usize, f64)> = chances.into_iter().enumerate().collect();
    let likelier = |a: &(usize, f64), b: &(usize, f64)| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0));
    if picks.len() > PICKS_MAX {
        picks.select_nth_unstable_by(PICKS_MAX, likelier);
        picks.truncate(PICKS_MAX);
    }
    let picks = picks.into_iter();
    weighed.extend(picks.map(|(i, p)| (Action::Pick(i.into()), problem.costs.pick_value(p))));
    weighed.retain(|(action, _)| *action != chosen);
    weighed.sort_by(|a, b| b.1.total_cmp(&a.1));
    weighed.truncate(Decision::ALTERNATIVES_MAX);
    weighed
}

#[cfg(test)]
mod announced_tests;
#[cfg(test)]
mod tests;
