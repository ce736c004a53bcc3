//! Solutions between two samples of s0 that a local minimum of the violation does not betray.
//!
//! The violation is the greatest of several joints'. Where one joint's falls along s0 and
//! another's rises, they cross, and what fits lies about the crossing; the samples either side may
//! be monotone all the same, because a third joint bends the curve further on.
//!
//! At a fold the two postures of the roll become one and end. Towards it joints move with the root
//! of the distance in s0 that is left, so what a tenth of a radian of them holds may be a
//! thousandth of s0 wide. Samples there are spread as squares.

use super::closer::STEEPEST;
use super::goal::Aim;
use super::posture::{Branch, Posture};
use super::slice::Slice;
use crate::kinematics::limb::Joints;
use crate::kinematics::limits::PositionLimits;

/// Closed forms spent on a crossing; they narrow s0 to 4e-4 rad.
const LOOKS: usize = 7;

/// Returns a posture of `branch` between `left` and `right` that fits, if the joint that is
/// furthest outside its limits is not the same at both.
pub(crate) fn at_crossing(
    aim: &Aim<'_>,
    branch: Branch,
    left: &Posture,
    right: &Posture,
) -> Option<Posture> {
    let limits = aim.goal.chain.limits();
    let falling = furthest(limits, &left.q);
    if falling == furthest(limits, &right.q) {
        return None;
    }
    let (mut from, mut to) = (left.q[0], right.q[0]);
    for _ in 0..LOOKS {
        let middle = 0.5 * (from + to);
        let posture = Slice::roughly(aim, middle).posture(branch)?;
        if posture.is_solution() {
            return Some(posture);
        }
        if posture.violation > STEEPEST * 0.5 * (to - from) {
            break;
        }
        if furthest(limits, &posture.q) == falling { from = middle } else { to = middle }
    }
    None
}

/// Returns the joint that is furthest outside its limits or nearest to one, and whether at the
/// upper.
fn furthest(limits: &PositionLimits, q: &Joints) -> (usize, bool) {
    let mut furthest = (0, false);
    let mut most = f64::NEG_INFINITY;
    for (i, (lower, upper)) in limits.0.iter().enumerate().skip(1) {
        for (beyond, is_upper) in [(lower - q[i], false), (q[i] - upper, true)] {
            if beyond > most {
                (most, furthest) = (beyond, (i, is_upper));
            }
        }
    }
    furthest
}

/// Violation beside a fold above which no solution hides there, radians.
const NEAR_RAD: f64 = 0.3;

/// Halvings that find the fold, to a sixtieth of a cell.
const HALVINGS: usize = 6;

/// Samples between the fold and the next sample of the sweep.
const SAMPLES: usize = 10;

/// Returns a posture of `branch` that fits, between `within`, which has the branch, and the fold at
/// which it ends before `end` (s0, radians), if it does.
pub(crate) fn beside_fold(
    aim: &Aim<'_>,
    branch: Branch,
    within: &Posture,
    end: f64,
) -> Option<Posture> {
    let at = |s0: f64| Slice::roughly(aim, s0).posture(branch);
    let is_beyond = |posture: &Option<Posture>| posture.is_none_or(|posture| posture.lack > 0.0);
    if within.violation > NEAR_RAD || !is_beyond(&at(end)) {
        return None;
    }
    let (mut fold, mut near) = (end, within.q[0]);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (fold + near);
        let posture = at(middle);
        if let Some(solution) = posture.filter(Posture::is_solution) {
            return Some(solution);
        }
        if is_beyond(&posture) { fold = middle } else { near = middle }
    }
    let room = within.q[0] - fold;
    (1..SAMPLES).find_map(|k| {
        let share = k as f64 / SAMPLES as f64;
        at(fold + room * share * share).filter(Posture::is_solution)
    })
}
