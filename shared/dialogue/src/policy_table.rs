//! Decisions that were worked out once and may be kept, in memory and on disk.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use vocabulary::{Action, Actions, Announce};

use crate::stable_hash::StableHash128;
use crate::{Decision, DecisionProblem};

/// The decisions of one problem, by belief.
///
/// It serves one problem at a time and forgets the others': a robot has one scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PolicyTable {
    problem: u64,
    decisions: BTreeMap<u128, Decision>,
}

/// Most decisions that are kept. A dialogue needs a handful, the whole policy of the six bowls
/// under a hundred.
const DECISIONS_MAX: usize = 20_000;

impl PolicyTable {
    /// Number of decisions in the table.
    pub fn len(&self) -> usize {
        self.decisions.len()
    }

    /// Whether the table is empty.
    pub fn is_empty(&self) -> bool {
        self.decisions.is_empty()
    }

    /// Whether everything in it could be decided in that problem: a table from elsewhere is used
    /// only then.
    pub fn fits(&self, problem: &DecisionProblem<'_>) -> bool {
        let possible = |decision: &Decision| {
            let known = match decision.action {
                Action::Wait => true,
                Action::Ask(question) => problem.model.contains(question),
                Action::Pick(object) => object.index() < problem.model.hypotheses(),
            };
            known && problem.actions.allow(decision.action)
        };
        self.problem == problem.key() && self.decisions.values().all(possible)
    }

    /// The decision at the beliefs of that key ([`Belief::key`](crate::Belief::key)).
    pub(crate) fn get(&self, problem: u64, belief: &[i64]) -> Option<&Decision> {
        self.decisions.get(&short(belief)).filter(|_| self.problem == problem)
    }

    pub(crate) fn insert(&mut self, problem: u64, belief: &[i64], decision: Decision) {
        if self.problem != problem || self.decisions.len() >= DECISIONS_MAX {
            self.decisions.clear();
            self.problem = problem;
        }
        self.decisions.insert(short(belief), decision);
    }
}

fn short(belief: &[i64]) -> u128 {
    belief
        .iter()
        .fold(StableHash128::default(), |hash, units| hash.add(units.cast_unsigned()))
        .wide()
}

impl DecisionProblem<'_> {
    /// Identifies the problem, and the way in which tables of it are computed, in files that
    /// outlive the program.
    pub fn key(&self) -> u64 {
        /// To be raised with every change of how decisions are found.
        const EDITION: u64 = 2;
        let costs = &self.costs;
        let amounts = [
            (costs.wait_s, costs.attribute_s),
            (costs.which_s, costs.point_s),
            (costs.correct, costs.wrong),
            (costs.discount, 0.0),
        ];
        let mut hash = StableHash128::default().add(EDITION);
        for (a, b) in amounts {
            hash = hash.add(a.to_bits()).add(b.to_bits());
        }
        let Actions { mode, attribute, which, choice } = self.actions;
        hash = hash.add(mode as u64).add(u64::from(attribute)).add(u64::from(which));
        if choice {
            hash = hash.add(costs.choice_s.to_bits()).add(costs.option_s.to_bits());
        }
        self.model.identify(&mut |part| hash = hash.add(part));
        if let Some(durations) = self.durations {
            durations.identify(&mut |part| hash = hash.add(part));
        }
        if !self.announce.is_final() {
            let Announce { heard, cost_s } = self.announce;
            hash = hash.add(heard.to_bits()).add(cost_s.to_bits());
        }
        self.concessions.identify(&mut |part| hash = hash.add(part));
        hash.narrow()
    }
}
