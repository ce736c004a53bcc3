//! Closer search for a target that no sample of the sweep hit: between two samples of s0, then by
//! refinement.

use super::IkSolution;
use super::goal::Aim;
use super::hidden;
use super::line_search;
use super::posture::{Branch, Posture};
use super::refine::{Refined, refine};
use super::slice::{NARROW_RAD, Slice};
use super::solve::exact;

/// Closed forms spent between the neighbours of one sample; they narrow s0 to 5e-5 rad.
const LOOKS: usize = 16;

/// The most that the violation falls per radian of s0: what [`super::slice::WIDE_RAD`] rests on.
pub(crate) const STEEPEST: f64 = 17.0;

/// Local minima refined between their neighbours. In two million random postures the tenth was
/// never the one.
const MINIMA: usize = 16;

/// Violation below which the stretched arm and the straight wrist may still hide a solution that
/// only refinement finds, radians.
const HOPEFUL_RAD: f64 = 0.002;

/// |w1| below which a wrist is all but straight, radians.
const STRAIGHT_RAD: f64 = 0.1;

/// Refinement steps for a hopeful posture.
const STEPS_HOPEFUL: usize = 40;

/// Refinement steps towards the nearest posture when no exact one exists.
const STEPS_NEAREST: usize = 16;

/// Result of a closer search without a solution.
pub(crate) struct Missed {
    pub(crate) nearest: Refined,
    /// Positions of s0 where the wrist of a posture that nearly fits is all but straight, radians.
    pub(crate) straight: Vec<f64>,
}

/// Postures of the sweep that are not solutions.
pub(crate) struct Nearly {
    /// Width of a cell, radians.
    cell_rad: f64,
    seen: Vec<Seen>,
}

struct Seen {
    cell: u32,
    branch: Branch,
    posture: Posture,
}

impl Nearly {
    pub(crate) fn new(aim: &Aim<'_>, cells: u32) -> Self {
        let (lower, upper) = aim.limits(0);
        Self { cell_rad: (upper - lower) / f64::from(cells), seen: Vec::with_capacity(32) }
    }

    #[inline]
    pub(crate) fn add(&mut self, cell: u32, branch: Branch, posture: Posture) {
        self.seen.push(Seen { cell, branch, posture });
    }

    /// Follows every local minimum of the violation along s0, looks where two joints' violations
    /// cross and beside folds, then refines what came nearest.
    pub(crate) fn look_closer(mut self, aim: &Aim<'_>) -> Result<IkSolution, Missed> {
        let mut closer = Vec::with_capacity(MINIMA);
        for (branch, posture) in self.minima() {
            let found = least_violation(aim, self.cell_rad, branch, posture);
            if let Some(answer) = settled(aim, branch, &found) {
                return Ok(answer);
            }
            closer.push(found);
        }
        if let Some(answer) = self.hidden(aim) {
            return Ok(answer);
        }
        closer.sort_by(|a, b| a.violation.total_cmp(&b.violation));
        let mut best = nearest(aim, closer.first());
        for posture in closer.iter().take_while(|p| p.violation < HOPEFUL_RAD) {
            let refined = refine(&aim.goal, &posture.q, STEPS_HOPEFUL);
            if let Some(answer) = IkSolution::accept(&aim.goal, &refined) {
                return Ok(answer);
            }
            if refined.error() < best.error() {
                best = refined;
            }
        }
        let straight = self.straight(aim);
        Err(Missed { nearest: best, straight })
    }

    /// Returns a solution where two joints' violations cross between neighbouring samples, or
    /// beside a fold at which a branch ends between them.
    fn hidden(&self, aim: &Aim<'_>) -> Option<IkSolution> {
        let beside = |a: &Seen, b: &&Seen| b.branch == a.branch && b.cell.abs_diff(a.cell) == 1;
        (0..self.seen.len()).find_map(|i| {
            let seen = &self.seen[i];
            let before = i.checked_sub(1).map(|i| &self.seen[i]).filter(|b| beside(seen, b));
            let after = self.seen.get(i + 1).filter(|b| beside(seen, b));
            let crossed = after
                .and_then(|b| hidden::at_crossing(aim, seen.branch, &seen.posture, &b.posture));
            let fold = |neighbour: Option<&Seen>, side: f64| {
                let goes_on = neighbour.is_some_and(|b| b.posture.lack == 0.0);
                let end = seen.posture.q[0] + side * self.cell_rad;
                (seen.posture.lack == 0.0 && !goes_on)
                    .then(|| hidden::beside_fold(aim, seen.branch, &seen.posture, end))
                    .flatten()
            };
            let found = crossed.or_else(|| fold(before, -1.0)).or_else(|| fold(after, 1.0))?;
            settled(aim, seen.branch, &found)
        })
    }

    /// Positions of s0 at which a posture nearly fits whose wrist is all but straight, so that its
    /// fixed point is not the only one; the nearest fit first.
    fn straight(&self, aim: &Aim<'_>) -> Vec<f64> {
        let is_straight = |p: &Posture| (p.q[5] + aim.arm.zero[5]).abs() < STRAIGHT_RAD;
        let postures = self.seen.iter().map(|seen| &seen.posture);
        let mut straight: Vec<_> =
            postures.filter(|p| p.violation < NARROW_RAD && is_straight(p)).collect();
        straight.sort_by(|a, b| a.violation.total_cmp(&b.violation));
        straight.into_iter().map(|posture| posture.q[0]).collect()
    }

    /// Samples whose two neighbours of the same branch violate more (or have no posture at all),
    /// least violation first.
    fn minima(&mut self) -> Vec<(Branch, Posture)> {
        self.seen.sort_unstable_by_key(|seen| (seen.branch.index(), seen.cell));
        let better = |a: &Seen, b: Option<&Seen>| {
            !b.is_some_and(|b| {
                b.branch == a.branch
                    && b.cell.abs_diff(a.cell) == 1
                    && b.posture.violation < a.posture.violation
            })
        };
        let mut minima: Vec<_> = (0..self.seen.len())
            .filter(|&i| {
                let before = i.checked_sub(1).map(|i| &self.seen[i]);
                better(&self.seen[i], before) && better(&self.seen[i], self.seen.get(i + 1))
            })
            .map(|i| (self.seen[i].branch, self.seen[i].posture))
            .collect();
        minima.sort_by(|a, b| a.1.violation.total_cmp(&b.1.violation));
        minima.truncate(MINIMA);
        minima
    }
}

/// Returns a roughly settled posture as an answer, if it is one.
fn settled(aim: &Aim<'_>, branch: Branch, found: &Posture) -> Option<IkSolution> {
    if found.violation > 0.0 {
        return None;
    }
    exact(aim, &Slice::new(aim, found.q[0]).posture(branch).unwrap_or(*found))
}

/// Returns the nearest posture in a few steps: from the best one known, or from the middle of the
/// limits where the target lies beyond the arm's reach.
fn nearest(aim: &Aim<'_>, best: Option<&Posture>) -> Refined {
    refine(
        &aim.goal,
        &best.map_or_else(|| aim.goal.chain.limits().middle(), |posture| posture.q),
        STEPS_NEAREST,
    )
}

/// Returns the least violation of a branch within one cell of s0 either side, or the first solution
/// there.
fn least_violation(aim: &Aim<'_>, cell_rad: f64, branch: Branch, from: Posture) -> Posture {
    let (lower, upper) = aim.limits(0);
    let mut best = from;
    let range = ((from.q[0] - cell_rad).max(lower), (from.q[0] + cell_rad).min(upper));
    line_search::narrow(range, LOOKS, STEEPEST, |s0| {
        let Some(posture) = Slice::roughly(aim, s0).posture(branch) else { return f64::INFINITY };
        if posture.violation < best.violation || posture.is_solution() {
            best = posture;
        }
        posture.violation
    });
    best
}
