//! Solutions beside a fold: where the two postures of the roll become one and end.
//!
//! Towards a fold joints move with the root of the distance in s0 that is left, so what a tenth of a
//! radian of them holds may be a thousandth of s0 wide. Samples there are spread as squares.

use super::goal::Aim;
use super::posture::{Branch, Posture};
use super::slice::Slice;

/// Violation beside a fold above which no solution hides there, radians.
const NEAR_RAD: f64 = 0.3;

/// Halvings that find the fold, to a sixtieth of a cell.
const HALVINGS: usize = 6;

/// Samples between the fold and the next sample of the sweep.
const SAMPLES: usize = 10;

/// Returns a posture of `branch` that fits, between `within`, which has the branch, and the fold at
/// which it ends before `end` (s0, radians), if it does.
pub(crate) fn beside(aim: &Aim<'_>, branch: Branch, within: &Posture, end: f64) -> Option<Posture> {
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
