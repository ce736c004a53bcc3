//! The closer look at a target that no sample of the sweep hit: between two samples of s0, then by
//! refinement.

use super::IkSolution;
use super::crossing;
use super::goal::Aim;
use super::golden;
use super::posture::{Branch, Posture};
use super::refine::{Refined, refine};
use super::slice::Slice;
use super::solve::exact;

/// Closed forms spent between the neighbours of one sample; they narrow s0 to 5e-5 rad.
const LOOKS: usize = 16;

/// The most that the violation falls per radian of s0: what [`super::slice::WIDE_RAD`] rests on.
pub(crate) const STEEPEST: f64 = 17.0;

/// Local minima looked at between their neighbours. In two million random postures the tenth was
/// never the one.
const MINIMA: usize = 16;

/// Violation below which the stretched arm and the straight wrist may still hide a solution that
/// only refinement finds, radians.
const HOPEFUL_RAD: f64 = 0.002;

/// Refinement steps for a hopeful posture.
const STEPS_HOPEFUL: usize = 40;

/// Refinement steps towards the nearest posture when there is no hope of an exact one.
const STEPS_NEAREST: usize = 16;

/// What the sweep saw of postures that are not solutions.
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
    /// cross, then refines what came nearest.
    pub(crate) fn look_closer(mut self, aim: &Aim<'_>) -> Result<IkSolution, Refined> {
        let mut closer = Vec::with_capacity(MINIMA);
        for (branch, posture) in self.minima() {
            let found = least_violation(aim, self.cell_rad, branch, posture);
            if let Some(answer) = settled(aim, branch, &found) {
                return Ok(answer);
            }
            closer.push(found);
        }
        for pair in self.seen.windows(2) {
            let [left, right] = pair else { continue };
            if left.branch == right.branch && right.cell == left.cell + 1 {
                let found = crossing::between(aim, left.branch, &left.posture, &right.posture);
                if let Some(answer) = found.and_then(|found| settled(aim, left.branch, &found)) {
                    return Ok(answer);
                }
            }
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
        Err(best)
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

/// A roughly settled posture as an answer, if it is one.
fn settled(aim: &Aim<'_>, branch: Branch, found: &Posture) -> Option<IkSolution> {
    if found.violation > 0.0 {
        return None;
    }
    exact(aim, &Slice::new(aim, found.q[0]).posture(branch).unwrap_or(*found))
}

/// The nearest posture in a few steps: from the best one known, or from the middle of the limits
/// where the target lies beyond the arm's reach.
fn nearest(aim: &Aim<'_>, best: Option<&Posture>) -> Refined {
    refine(
        &aim.goal,
        &best.map_or_else(|| aim.goal.chain.limits().middle(), |posture| posture.q),
        STEPS_NEAREST,
    )
}

/// The least violation of a branch within one cell of s0 either side, or the first solution there.
fn least_violation(aim: &Aim<'_>, cell_rad: f64, branch: Branch, from: Posture) -> Posture {
    let (lower, upper) = aim.limits(0);
    let mut best = from;
    let range = ((from.q[0] - cell_rad).max(lower), (from.q[0] + cell_rad).min(upper));
    golden::narrow(range, LOOKS, STEEPEST, |s0| {
        let Some(posture) = Slice::roughly(aim, s0).posture(branch) else { return f64::INFINITY };
        if posture.violation < best.violation || posture.is_solution() {
            best = posture;
        }
        posture.violation
    });
    best
}
