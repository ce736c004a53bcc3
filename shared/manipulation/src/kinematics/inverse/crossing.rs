//! Solutions between two samples of s0 that a local minimum of the violation does not betray.
//!
//! The violation is the greatest of several joints'. Where one joint's falls along s0 and
//! another's rises, they cross, and what fits lies about the crossing; the samples either side may
//! be monotone all the same, because a third joint bends the curve further on.

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
pub(crate) fn between(
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
