//! A decision from searching the beliefs that questions lead to.

use std::panic::resume_unwind;
use std::thread;

use vocabulary::Action;

use crate::planning::{Bound, Certify, Effort, Move, Reduced, Revealed, Search, Value};
use crate::{Belief, Decision, DecisionProblem};

use super::{alternatives, stop};

/// Searches from a belief with the effort that the reduced problem deserves, and takes the question
/// that looks best.
pub(super) fn searched(
    problem: &DecisionProblem<'_>,
    belief: &Belief,
    effort: impl Fn(&Reduced) -> Effort,
) -> Decision {
    let reduced = Reduced::new(problem, belief);
    let bound = Bound::new(&reduced, &problem.costs);
    let mut search = Search::new(&reduced, &bound);
    let effort = effort(&reduced);
    search.run(effort);
    let certified = certify(&mut search, &reduced, problem, effort);
    let root = search.root();
    let does = |to| match to {
        Move::Ask(query) => Action::Ask(reduced.question(query)),
        Move::Announce(class) => Action::Pick(reduced.best[class as usize]),
    };
    let action =
        root.best().map_or_else(|| stop(problem, &reduced, root.class, root.stop), |b| does(b.to));
    let value = root.best().map_or(root.stop, |branch| branch.value.estimate).min(certified);
    let weighed = root.branches.iter().map(|b| (does(b.to), b.value.estimate)).collect();
    Decision {
        action,
        value,
        alternatives: alternatives(problem, belief, weighed, action),
        expected_questions: questions_left(&search, &reduced, 0, 1.0),
        bounds: Some((root.value.lower, certified)),
    }
}

/// Upper bound on the value. If the search leaves a gap, the plan is rolled out and improved, while
/// another thread searches the easier problem. Both do the same work however long it takes.
fn certify(
    search: &mut Search<'_>,
    reduced: &Reduced,
    problem: &DecisionProblem<'_>,
    effort: Effort,
) -> f64 {
    let is_solved = search.root().value.gap() <= effort.tolerance;
    let Some(Certify { plan_max, easier_max }) = effort.certify.filter(|_| !is_solved) else {
        return search.root().value.upper;
    };
    let beliefs_max = search.len() + plan_max;
    search.roll_out(beliefs_max);
    let enough = search.root().value.lower + effort.tolerance;
    let easier = || {
        let easier = Revealed::of(reduced, &problem.costs);
        easier.map_or(f64::INFINITY, |mut easier| easier.upper(easier_max, enough))
    };
    let upper = thread::scope(|scope| {
        let thread = thread::Builder::new().spawn_scoped(scope, easier);
        search.improve(beliefs_max);
        thread.map_or_else(|_| easier(), |it| it.join().unwrap_or_else(|e| resume_unwind(e)))
    });
    let Value { lower, upper: searched, .. } = search.root().value;
    searched.min(upper).max(lower)
}

/// Beliefs that are looked at with that much work, counted as [`Reduced::work`].
pub(super) fn affordable(reduced: &Reduced, work: usize) -> usize {
    work / reduced.work()
}

/// Dialogues less probable than this do not count towards the expected number of questions.
const UNLIKELY: f64 = 1e-3;

/// How many questions the plan asks from that belief on, repetitions after silence included. Beyond
/// the search, every answer is expected to carry all possible information.
fn questions_left(search: &Search<'_>, reduced: &Reduced, node: usize, reached: f64) -> f64 {
    let node = search.at(node);
    let Some(branch) = node.best() else { return 0.0 };
    if branch.answers.is_empty() {
        return match branch.to {
            Move::Ask(query) => reduced.channel(query).times_until_spent(node.entropy),
            Move::Announce(_) => 0.0,
        };
    }
    let likely = branch.answers.iter().map(|(p, next)| (p, next, reached * p));
    let after = likely
        .filter(|(.., reached)| *reached > UNLIKELY)
        .map(|(p, next, reached)| p * questions_left(search, reduced, *next, reached));
    branch.price.times + after.sum::<f64>()
}

#[cfg(test)]
mod tests {
    use vocabulary::{Actions, Costs, Params, Rng};

    use super::*;
    use crate::Model;
    use crate::testing::{bowls, perceived};

    /// A decision about objects in doubt took seconds: each of its beliefs is far more work.
    #[test]
    fn beliefs_about_values_in_doubt_count_as_more_work() {
        let affordable = |scene: &scene::Scene| {
            let model = Model::new(scene, Params::default());
            let problem = DecisionProblem::new(&model, Costs::SECONDS, Actions::default());
            affordable(&Reduced::new(&problem, &Belief::uniform(6)), 1_000_000)
        };
        let (seed, certain) = (5, affordable(&bowls()));
        let doubtful = affordable(&perceived(&mut Rng::new(seed), &bowls()));
        assert!(5 * doubtful < certain, "seed {seed}: {doubtful} beliefs, {certain} without doubt");
    }
}
