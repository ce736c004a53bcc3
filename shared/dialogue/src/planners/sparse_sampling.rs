//! `sparse-sampling`: the predecessor's planner (Kearns, Mansour and Ng 2002, over beliefs).

use vocabulary::{Action, Rng};

use crate::planning::{Query, Reduced, outcomes};
use crate::{Belief, Decision, DecisionProblem, Planner, Step};

use super::{Entry, Outlook, alternatives};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "sparse-sampling",
    about: "Draws answers two questions ahead; the predecessor's planner.",
    make: || Box::new(SparseSampling::default()),
};

/// Looks a fixed number of questions ahead, and for every question draws a few answers instead of
/// weighing all of them. The predecessor's public configuration has a horizon of 2.
///
/// Sampling causes its errors: three draws mostly miss the improbable answer. The same interaction
/// and step draw the same answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct SparseSampling {
    /// How many questions to look ahead, with a pick behind the last.
    horizon: u32,
    /// How many answers to draw for a question.
    width: usize,
}

impl Default for SparseSampling {
    fn default() -> Self {
        Self { horizon: 2, width: 3 }
    }
}

/// State of a sampling planner's look-ahead.
struct Tree<'a> {
    reduced: &'a Reduced,
    problem: &'a DecisionProblem<'a>,
    queries: Vec<Query>,
    width: usize,
    rng: Rng,
}

impl Planner for SparseSampling {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        let problem = &problem.with_final_picks();
        let outlook = Outlook::new(problem, belief);
        let Outlook { reduced, one_step } = &outlook;
        let queries = reduced.all_queries();
        let rng = Rng::new(step.interaction.wrapping_mul(0x1_0000_0001) ^ u64::from(step.step));
        let mut tree = Tree { reduced, problem, queries, width: self.width, rng };
        let asked = tree.ask(&reduced.mass, self.horizon);
        let best = asked.iter().copied().reduce(|a, b| if b.1 > a.1 { b } else { a });
        let best = best.filter(|(_, value)| *value > one_step.stop);
        let asks = |query| Action::Ask(reduced.question(query));
        let (action, value) = best.map_or_else(
            || (outlook.stop(problem), one_step.stop),
            |(query, value)| (asks(query), value),
        );
        let expected_questions =
            best.map_or(0.0, |(q, _)| reduced.channel(q).times_until_spent(one_step.entropy));
        let asked = asked.iter().map(|(query, value)| (asks(*query), *value)).collect();
        let alternatives = alternatives(problem, belief, asked, action);
        Decision { action, value, alternatives, expected_questions, bounds: None }
    }
}

impl Tree<'_> {
    /// Value of every question at a belief with that many questions to go.
    fn ask(&mut self, mass: &[f64], horizon: u32) -> Vec<(Query, f64)> {
        let queries = self.queries.clone();
        queries.into_iter().map(|query| (query, self.sample(query, mass, horizon))).collect()
    }

    fn sample(&mut self, query: Query, mass: &[f64], horizon: u32) -> f64 {
        let answers = outcomes(self.reduced, query, mass);
        let mut drawn = vec![0_usize; answers.len()];
        for _ in 0..self.width {
            let index = self.rng.index(answers.iter().map(|(probability, _)| *probability));
            drawn[index.unwrap_or(answers.len() - 1)] += 1;
        }
        let mut sum = 0.0;
        for (times, (_, after)) in drawn.into_iter().zip(&answers).filter(|(times, _)| *times > 0) {
            sum += times as f64 * self.value(after, horizon - 1);
        }
        self.reduced.channel(query).price.pay(sum / self.width as f64)
    }

    fn value(&mut self, mass: &[f64], horizon: u32) -> f64 {
        let tops = mass.iter().zip(&self.reduced.share).map(|(mass, share)| mass * share);
        let pick = self.problem.costs.pick_value(tops.fold(0.0, f64::max));
        let stop = pick.max(self.problem.costs.wait_value());
        if horizon == 0 {
            return stop;
        }
        self.ask(mass, horizon).into_iter().fold(stop, |best, (_, value)| best.max(value))
    }
}
