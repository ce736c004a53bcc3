//! `entropy`: the most informative question per second (after Deits et al. 2013).

use crate::{Belief, Decision, DecisionProblem, Planner, Step};

use super::{Entry, Outlook};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "entropy",
    about: "Asks for the most information per second (Deits et al. 2013).",
    make: || Box::new(Entropy),
};

/// Asks for the most expected information per cost, and picks once a question costs more than the
/// doubt about the most probable object puts at stake.
#[derive(Clone, Copy, Debug, Default)]
struct Entropy;

/// Information below this, in nats, is rounding: of questions that differ by less the first is
/// asked.
const NOTHING: f64 = 1e-9;

impl Planner for Entropy {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, _: Step) -> Decision {
        let problem = &problem.with_final_picks();
        let outlook = Outlook::new(problem, belief);
        let price = |query| outlook.reduced.channel(query).price;
        let rate = |query, information: f64| information / price(query).cost;
        let most = (outlook.one_step.choices.iter())
            .filter(|choice| choice.information > NOTHING)
            .reduce(|a, b| {
                let more = rate(b.query, b.information) - rate(a.query, a.information);
                if more > NOTHING { b } else { a }
            });
        let costs = &problem.costs;
        let at_stake = (1.0 - outlook.one_step.peak) * (costs.correct + costs.wrong);
        // Asking also puts the reward off.
        let worth_it = most.filter(|choice| {
            let price = price(choice.query);
            at_stake > price.cost + (1.0 - price.discount) * costs.correct
        });
        outlook.decide(problem, belief, worth_it)
    }
}
