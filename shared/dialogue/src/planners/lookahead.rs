//! `lookahead`: best-first search from the belief, with certified bounds.

use crate::planning::{Effort, Reduced};
use crate::{Belief, Decision, DecisionProblem, Planner, Step};

use super::Entry;
use super::searched::{affordable, searched};

/// The registry's entry.
pub(super) const ENTRY: Entry = Entry {
    name: "lookahead",
    about: "Searches ahead until the best plan is certified or the effort is used up; the default.",
    make: || Box::new(Lookahead::default()),
};

/// The default planner. It searches the beliefs that questions lead to (`planning`), until the
/// value of the best policy is known or a number of beliefs has been looked at.
///
/// Small scenes are solved: the six bowls take about 150 beliefs, 20 objects some ten thousand.
/// With thousands of objects it looks a few questions ahead along the most promising plans and
/// expects the entropy that is left to cost its price. The effort is counted in beliefs, never in
/// time, and nothing is kept between decisions: the same belief is always decided alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Lookahead {
    /// Most beliefs to look at for one decision.
    pub beliefs_max: usize,
    /// Gap between the bounds at which the value counts as known, as a share of the stake of a
    /// pick.
    pub tolerance: f64,
}

impl Default for Lookahead {
    fn default() -> Self {
        Self { beliefs_max: 20_000, tolerance: 3e-6 }
    }
}

/// How much work one decision may be on large scenes, in classes looked at times attributes: about
/// 4 ms of one core.
const WORK_MAX: usize = 600_000;
/// The same with few classes, for which more work still finds the best policy: a tenth of a second
/// at the most doubtful beliefs of 20 objects, and far less once something was answered.
const WORK_MAX_FEW: usize = 2_400_000;
/// Up to how many classes are few.
const FEW: usize = 32;
/// Fewest beliefs that are looked at, however large the scene.
const BELIEFS_MIN: usize = 24;

fn work(reduced: &Reduced) -> usize {
    let work = if reduced.classes() <= FEW { WORK_MAX_FEW } else { WORK_MAX };
    affordable(reduced, work).max(BELIEFS_MIN)
}

impl Planner for Lookahead {
    fn name(&self) -> &'static str {
        ENTRY.name
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, _: Step) -> Decision {
        let stake = problem.costs.correct + problem.costs.wrong;
        searched(problem, belief, |reduced: &Reduced| Effort {
            beliefs_max: self.beliefs_max.min(work(reduced)),
            tolerance: self.tolerance * stake,
            certify: None,
        })
    }
}
