//! `lookahead`: best-first search from the belief, with certified bounds.

use crate::planning::{Bound, Effort, Reduced, Search};
use crate::{Action, Belief, Decision, DecisionProblem, Planner, Step};

use super::{alternatives, stop};

/// The default planner. It searches the beliefs that questions lead to (`planning`), until the
/// value of the best policy is known or a number of beliefs has been looked at.
///
/// Small scenes are solved: the six bowls take about 150 beliefs. With thousands of objects it
/// looks a few questions ahead along the most promising plans and expects the entropy that is left
/// to cost its price. The effort is counted in beliefs, never in time, and nothing is kept between
/// decisions: the same belief is always decided alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Lookahead {
    /// Most beliefs to look at for one decision.
    pub beliefs_max: usize,
    /// Gap between the bounds at which the value counts as known, as a share of what is at stake
    /// in a pick.
    pub tolerance: f64,
}

impl Default for Lookahead {
    fn default() -> Self {
        Self { beliefs_max: 2_000, tolerance: 3e-6 }
    }
}

/// How much work one decision may be on large scenes, in classes looked at times attributes: about
/// 4 ms of one core.
const WORK_MAX: usize = 600_000;
/// Fewest beliefs that are looked at, however large the scene.
const BELIEFS_MIN: usize = 24;

impl Lookahead {
    fn effort(&self, problem: &DecisionProblem<'_>, reduced: &Reduced) -> Effort {
        let work = reduced.classes() * (reduced.columns.len() + 2);
        let affordable = (WORK_MAX / work).max(BELIEFS_MIN);
        Effort {
            beliefs_max: self.beliefs_max.min(affordable),
            tolerance: self.tolerance * (problem.costs.correct + problem.costs.wrong),
        }
    }
}

impl Planner for Lookahead {
    fn name(&self) -> &'static str {
        "lookahead"
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, _: Step) -> Decision {
        let reduced = Reduced::new(problem, belief);
        let bound = Bound::new(&reduced, &problem.costs);
        let mut search = Search::new(&reduced, &bound);
        search.run(self.effort(problem, &reduced));
        let root = search.root();
        let asks = |query| Action::Ask(reduced.question(query));
        let action = root
            .best()
            .map_or_else(|| stop(problem, &reduced, root.class, root.stop), |b| asks(b.query));
        let value = root.best().map_or(root.stop, |branch| branch.value.estimate);
        let asked = root.branches.iter().map(|b| (asks(b.query), b.value.estimate)).collect();
        Decision {
            action,
            value,
            alternatives: alternatives(problem, belief, asked, action),
            expected_questions: questions_left(&search, &reduced, 0, 1.0),
            bounds: Some((root.value.lower, root.value.upper)),
        }
    }
}

/// Dialogues less probable than this do not count towards the expected number of questions.
const UNLIKELY: f64 = 1e-3;

/// How many questions the plan asks from that belief on, repetitions after silence included. Where
/// the search has not looked further, every answer is expected to carry all it can.
fn questions_left(search: &Search<'_>, reduced: &Reduced, node: usize, reached: f64) -> f64 {
    let node = search.at(node);
    let Some(branch) = node.best() else { return 0.0 };
    let channel = reduced.channel(branch.query);
    if branch.answers.is_empty() {
        return channel.times_until_spent(node.entropy);
    }
    let likely = branch.answers.iter().map(|(p, next)| (p, next, reached * p));
    let after = likely
        .filter(|(.., reached)| *reached > UNLIKELY)
        .map(|(p, next, reached)| p * questions_left(search, reduced, *next, reached));
    channel.price.times + after.sum::<f64>()
}
