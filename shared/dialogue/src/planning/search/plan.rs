//! Better plans if the search cannot close the bounds, by policy iteration on a plan's beliefs.
//!
//! The plan takes at each belief the question estimated to be best. Rolled out, a question's
//! estimate is the plan's result, and that of a question never followed is still a guess one step
//! ahead, often too low by more than their difference. So at the beliefs that the plan is likely to
//! lead to, the questions that look best are all followed and the plan is rolled out after each;
//! the best becomes the plan. That is repeated while it gains anything, then with more questions.

use super::{DEPTH_MAX, Lead, Search};

/// Dialogues less probable than this are not rolled out: together they are worth some hundredths.
const UNLIKELY: f64 = 3e-6;
/// How often a plan is rolled out: two or three times in practice.
const ROLL_OUTS_MAX: usize = 8;
/// Beliefs that are reached less probably keep the question that is estimated to be best.
const RARE: f64 = 1e-3;
/// How many questions are compared at a belief, at first and at last.
const COMPARED: std::ops::RangeInclusive<usize> = 2..=8;
/// Least gain for another repetition, as a share of the gap between the bounds.
const GAIN_MIN: f64 = 1e-4;
/// Beliefs passed for each one that may be examined: known ones are quick, but on many paths.
const PASSED: usize = 200;

/// How much work is left.
#[derive(Clone, Copy)]
struct Work {
    /// Most beliefs to look at in all.
    beliefs_max: usize,
    /// Most beliefs to pass.
    passes: usize,
}

impl Work {
    fn new(beliefs_max: usize) -> Self {
        Self { beliefs_max, passes: beliefs_max.saturating_mul(PASSED) }
    }
}

/// The plan as far as it is followed: a belief, and how probably the plan leads there, discounted.
#[derive(Clone, Copy)]
struct Reached {
    node: usize,
    probability: f64,
    depth: usize,
}

const ROOT: Reached = Reached { node: 0, probability: 1.0, depth: 0 };

impl Search<'_> {
    /// Follows the plan that looks best through every dialogue that is at all likely, so that the
    /// lower bound is the plan's value, and repeats while that makes a better plan look best. Looks
    /// at `beliefs_max` beliefs in all at most.
    pub(crate) fn roll_out(&mut self, beliefs_max: usize) {
        let mut work = Work::new(beliefs_max);
        for _ in 0..ROLL_OUTS_MAX {
            let before = self.root().value.lower;
            self.roll_out_from(ROOT, &mut work);
            if self.root().value.lower <= before {
                break;
            }
        }
    }

    /// Looks for a better plan than the one rolled out, at `beliefs_max` beliefs at most.
    pub(crate) fn improve(&mut self, beliefs_max: usize) {
        let mut work = Work::new(beliefs_max);
        for compared in COMPARED {
            loop {
                let before = self.root().value;
                self.improve_from(ROOT, compared, &mut work);
                if self.root().value.lower - before.lower <= GAIN_MIN * before.gap() {
                    break;
                }
            }
        }
    }

    fn roll_out_from(&mut self, at: Reached, work: &mut Work) {
        if at.probability < UNLIKELY || self.is_end(at, work) {
            return;
        }
        if let Some(branch) = self.planned(at.node) {
            self.take(at, branch, work, Self::roll_out_from);
        }
    }

    fn improve_from(&mut self, at: Reached, compared: usize, work: &mut Work) {
        if at.probability < RARE || self.is_end(at, work) || self.planned(at.node).is_none() {
            return;
        }
        for branch in self.nodes[at.node].most_promising(compared) {
            self.take(at, branch, work, Self::roll_out_from);
        }
        if let Some(branch) = self.planned(at.node) {
            self.take(at, branch, work, |search, next, work| {
                search.improve_from(next, compared, work);
            });
        }
    }

    fn is_end(&self, at: Reached, work: &mut Work) -> bool {
        work.passes = work.passes.saturating_sub(1);
        at.depth >= DEPTH_MAX || self.nodes.len() >= work.beliefs_max || work.passes == 0
    }

    /// The move of the plan; `None` if it stops.
    fn planned(&self, node: usize) -> Option<usize> {
        let node = &self.nodes[node];
        let leading = node.leading(Lead::Expectation)?;
        (node.branches[leading].value.estimate > node.stop).then_some(leading)
    }

    /// Makes a move, continues after each answer, and takes the move's value from there.
    fn take(
        &mut self,
        at: Reached,
        branch: usize,
        work: &mut Work,
        go_on: impl Fn(&mut Self, Reached, &mut Work),
    ) {
        if self.nodes[at.node].branches[branch].answers.is_empty() {
            self.follow(at.node, branch);
        }
        let discount = self.nodes[at.node].branches[branch].price.discount;
        for answer in 0..self.nodes[at.node].branches[branch].answers.len() {
            let (probability, node) = self.nodes[at.node].branches[branch].answers[answer];
            let probability = at.probability * probability * discount;
            go_on(self, Reached { node, probability, depth: at.depth + 1 }, work);
        }
        self.back_up(at.node, branch);
    }
}

impl super::Node {
    /// The moves of the greatest estimates that may improve on the achieved value.
    fn most_promising(&self, count: usize) -> Vec<usize> {
        let can_be_better = |branch: &usize| self.branches[*branch].value.upper > self.value.lower;
        let mut moves: Vec<usize> = (0..self.branches.len()).filter(can_be_better).collect();
        let estimate = |branch: &usize| self.branches[*branch].value.estimate;
        moves.sort_by(|a, b| estimate(b).total_cmp(&estimate(a)));
        moves.truncate(count);
        moves
    }
}
