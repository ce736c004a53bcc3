//! `optimal`: the search of `lookahead` run until the value is certified, and remembered.

use crate::planning::{Certify, Effort, Reduced};
use crate::{Belief, Decision, DecisionProblem, Planner, PolicyTable, Step, evaluate};

use super::Entry;
use super::searched::{affordable, searched};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "optimal",
    about: "Solves the problem and stores its policy; for small scenes.",
    make: || Box::new(Optimal::default()),
};

/// Solves the problem from every belief that is decided about, and remembers the decision.
///
/// It uses one representative of all beliefs that differ by rounding alone ([`Belief::key`]), so
/// that remembered results equal recomputed ones: decisions do not depend on earlier ones, nor on a
/// table from disk. If a scene is too large to be solved, the bounds of the decision say how far
/// from optimal it can be.
#[derive(Debug)]
pub struct Optimal {
    /// Most beliefs to look at for one decision.
    pub beliefs_max: usize,
    /// Gap between the bounds at which the value counts as known, as a share of the stake of a
    /// pick.
    pub tolerance: f64,
    /// Limit on further beliefs to examine for a better plan if that gap is not reached.
    pub plan_max: usize,
    /// There too: most beliefs of an easier problem to look at for an upper bound.
    pub easier_max: usize,
    table: PolicyTable,
}

impl Default for Optimal {
    fn default() -> Self {
        Self {
            beliefs_max: 50_000,
            tolerance: 2e-6,
            plan_max: 30_000,
            easier_max: 100_000,
            table: PolicyTable::default(),
        }
    }
}

/// Limit on the work of the search for one decision, and again for a better plan, in classes times
/// attributes: under two seconds of one core each, mostly for scenes of 20 objects and more.
const WORK_MAX: usize = 150_000_000;
/// Fewest beliefs that are looked at, however large the scene.
const BELIEFS_MIN: usize = 200;
/// A scene whose first belief is solved with that much work is small: its policy has a hundred
/// beliefs or so, most of them solved sooner.
const SMALL_WORK_MAX: usize = 2_000_000;
/// Dialogues less probable than this are not solved ahead.
const UNLIKELY: f64 = 1e-4;

/// The belief that is looked at in place of all with that key.
fn stands_for(belief: &Belief, key: &[i64]) -> Belief {
    Belief::from_key(key).unwrap_or_else(|_| belief.clone())
}

impl Optimal {
    fn solve(&self, problem: &DecisionProblem<'_>, belief: &Belief) -> Decision {
        let stake = problem.costs.correct + problem.costs.wrong;
        searched(problem, belief, |reduced: &Reduced| {
            let affordable = affordable(reduced, WORK_MAX).max(BELIEFS_MIN);
            let plan_max = self.plan_max.min(affordable);
            Effort {
                beliefs_max: self.beliefs_max.min(affordable),
                tolerance: self.tolerance * stake,
                certify: Some(Certify { plan_max, easier_max: self.easier_max }),
            }
        })
    }
}

impl Planner for Optimal {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, _: Step) -> Decision {
        let (problem_key, key) = (problem.key(), belief.key());
        // Concessions, perceptions, and what was asked often are of one interaction; the table is for
        // recurring beliefs.
        let recurs = problem.spent.is_empty();
        if let Some(known) = self.table.get(problem_key, &key).filter(|_| recurs) {
            return known.clone();
        }
        let decision = self.solve(problem, &stands_for(belief, &key));
        if recurs && problem.concessions.is_empty() && !problem.model.is_of_interaction() {
            self.table.insert(problem_key, &key, decision.clone());
        }
        decision
    }

    /// Follows the policy from a belief through every dialogue that is at all likely, if the scene
    /// is small.
    fn prepare(&mut self, problem: &DecisionProblem<'_>, belief: &Belief) {
        let stake = problem.costs.correct + problem.costs.wrong;
        let tolerance = self.tolerance * stake;
        let quick = |reduced: &Reduced| Effort {
            beliefs_max: affordable(reduced, SMALL_WORK_MAX).max(1),
            tolerance,
            certify: None,
        };
        let bounds = searched(problem, &stands_for(belief, &belief.key()), quick).bounds;
        if bounds.is_some_and(|(lower, upper)| upper - lower <= tolerance) {
            evaluate(self, problem, belief, UNLIKELY);
        }
    }

    fn table(&self) -> Option<&PolicyTable> {
        Some(&self.table)
    }

    fn adopt(&mut self, table: PolicyTable) {
        self.table = table;
    }
}
