//! Inverse kinematics of any chain: damped least squares from many postures in turn.

use super::goal::Goal;
use super::refine::{Refined, drift, refine};
use super::{IkSolution, Unreachable};
use crate::kinematics::limb::{Joints, distance};

/// Postures to set out from before a target counts as out of reach.
const STARTS_MAX: usize = 400;

/// Postures to set out from when the nearest solution, or all of them, are wanted.
const STARTS: usize = 80;

/// Steps from each.
const STEPS: usize = 40;

/// Rounds of drifting towards the seed.
const DRIFTS: usize = 20;

/// Solutions nearer to each other than this are one, radians.
const SAME_RAD: f64 = 0.05;

/// Returns the first solution found, or the posture that came nearest.
pub(crate) fn first(goal: &Goal<'_>) -> Result<IkSolution, Refined> {
    let middle = goal.chain.limits().middle();
    let mut nearest = Refined::at(goal, middle);
    if !goal.is_finite() {
        return Err(nearest);
    }
    for start in starts(goal).take(STARTS_MAX) {
        let refined = refine(goal, &start, STEPS);
        if let Some(answer) = IkSolution::accept(goal, &refined) {
            return Ok(answer);
        }
        if refined.error() < nearest.error() {
            nearest = refined;
        }
    }
    Err(nearest)
}

/// Returns the solution nearest to `seed` among those found from it and from many other postures.
pub(crate) fn nearest(goal: &Goal<'_>, seed: &Joints) -> Result<IkSolution, Unreachable> {
    if !goal.is_finite() || seed.iter().any(|q| !q.is_finite()) {
        return first(goal).map_err(Unreachable::from);
    }
    let best = std::iter::once(*seed)
        .chain(starts(goal).take(STARTS))
        .filter_map(|start| {
            let refined = refine(goal, &start, STEPS);
            IkSolution::accept(goal, &refined)?;
            IkSolution::accept(goal, &drift(goal, refined, seed, DRIFTS))
        })
        .min_by(|a, b| distance(&a.q, seed).total_cmp(&distance(&b.q, seed)));
    best.map_or_else(|| first(goal).map_err(Unreachable::from), Ok)
}

/// Solutions that differ, as many as are found.
pub(crate) fn all(goal: &Goal<'_>) -> Vec<Joints> {
    let mut found: Vec<Joints> = Vec::new();
    if !goal.is_finite() {
        return found;
    }
    for start in starts(goal).take(STARTS) {
        let answer = IkSolution::accept(goal, &refine(goal, &start, STEPS));
        let new = answer.filter(|a| found.iter().all(|q| distance(q, &a.q) > SAME_RAD));
        found.extend(new.map(|answer| answer.q));
    }
    if found.is_empty() {
        found.extend(first(goal).ok().map(|answer| answer.q));
    }
    found
}

/// Returns the middle of the limits, then postures that fill them evenly: Roberts's additive
/// sequence in seven dimensions, the same every time.
fn starts<'a>(goal: &'a Goal<'_>) -> impl Iterator<Item = Joints> + 'a {
    (0..).map(|k| {
        let share = STRIDES.map(|stride| (0.5 + stride * f64::from(k)).fract());
        goal.chain.limits().at(&share)
    })
}

/// Powers of 1/φ₇, where φ₇ is the positive root of x⁸ = x + 1.
const STRIDES: [f64; 7] = {
    let root = 1.0 / 1.096_981_557_798_560_3;
    let mut strides = [root; 7];
    let mut i = 1;
    while i < 7 {
        strides[i] = strides[i - 1] * root;
        i += 1;
    }
    strides
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strides_are_those_of_seven_dimensions() {
        let phi = 1.0 / STRIDES[0];
        assert!((phi.powi(8) - phi - 1.0).abs() < 1e-12);
    }
}
