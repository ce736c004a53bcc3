//! Inverse kinematics of arms with five or six joints that have a closed form: every branch, at every
//! whole turn that the limits allow.

use std::f64::consts::TAU;

use super::goal::Goal;
use super::refine::{Refined, refine};
use super::{IkSolution, Unreachable, five, restarts};
use crate::kinematics::chain::{Closed, Found};
use crate::kinematics::limb::{Joints, distance};

/// Number of joints; of five, the sixth stands at zero.
const JOINTS: usize = 6;

/// Refinement steps of a posture that the closed form found, and of one that only comes near.
const POLISH: usize = 8;
const STEPS: usize = 40;

/// Error twist below which a target may be in reach though no branch is, metres and radians: with
/// the wrist straight its joints turn against each other, and limits may leave room elsewhere; an arm
/// that deviates from its family reaches a little further here and there.
const NEAR_MISS: f64 = 2e-2;

/// Excess of a joint over its limits that rounding explains, radians.
const ROUNDING_RAD: f64 = 1e-9;

/// Returns a posture that reaches the goal, or the one that comes nearest.
pub(crate) fn first(goal: &Goal<'_>, arm: &Closed) -> Result<IkSolution, Refined> {
    let middle = goal.chain.limits().middle();
    if !goal.is_finite() {
        return Err(Refined::at(goal, middle));
    }
    let found = arm.postures(&goal.tool.isometry(), middle[JOINTS - 1]);
    let reached = found.iter().filter(|found| found.reaches);
    let answer =
        reached.filter_map(|found| turned(goal, found, &middle)).find_map(|q| exact(goal, &q));
    answer.map_or_else(|| near(goal, arm, &found), Ok)
}

/// Returns the posture that reaches the goal at the least joint distance from `seed`.
pub(crate) fn nearest(
    goal: &Goal<'_>,
    arm: &Closed,
    seed: &Joints,
) -> Result<IkSolution, Unreachable> {
    if !goal.is_finite() || seed.iter().any(|q| !q.is_finite()) {
        return first(goal, arm).map_err(Unreachable::from);
    }
    let is_five = matches!(arm, Closed::Five(_));
    let found = arm.postures(&goal.tool.isometry(), seed[JOINTS - 1]);
    let best = found
        .iter()
        .filter(|found| found.reaches)
        .filter_map(|found| turned(goal, found, seed))
        .filter_map(|q| exact(goal, &q))
        .chain(if is_five { None } else { IkSolution::accept(goal, &refine(goal, seed, POLISH)) })
        .min_by(|a, b| distance(&a.q, seed).total_cmp(&distance(&b.q, seed)));
    match best {
        Some(best) => Ok(best),
        // A plan asks many times; where the position is reached, its error is not used.
        None if is_five => Err(refine(goal, seed, POLISH).into()),
        None => near(goal, arm, &found).map_err(Unreachable::from),
    }
}

/// Returns every posture that reaches the goal, also those that differ by whole turns.
pub(crate) fn all(goal: &Goal<'_>, arm: &Closed) -> Vec<Joints> {
    if !goal.is_finite() {
        return Vec::new();
    }
    let middle = goal.chain.limits().middle();
    let found = arm.postures(&goal.tool.isometry(), middle[JOINTS - 1]);
    let exact = found
        .iter()
        .filter(|found| found.reaches)
        .filter_map(|found| turned(goal, found, &middle))
        .filter_map(|q| exact(goal, &q));
    let mut all: Vec<Joints> = exact.flat_map(|answer| at_all_turns(goal, &answer.q)).collect();
    if all.is_empty() && matches!(arm, Closed::Six(_)) {
        all.extend(near(goal, arm, &found).ok().map(|answer| answer.q));
    }
    all
}

/// Returns the posture with each joint at the whole turn nearest to `seed` that lies within its
/// limits; none where a joint has no such turn.
pub(super) fn turned(goal: &Goal<'_>, found: &Found, seed: &Joints) -> Option<Joints> {
    let mut q = found.q;
    for j in 0..JOINTS {
        let options = turns(goal, j, q[j]);
        q[j] = options.min_by(|a, b| (a - seed[j]).abs().total_cmp(&(b - seed[j]).abs()))?;
    }
    Some(q)
}

/// Returns the angles of a joint that differ from `q` by whole turns and lie within its limits.
fn turns(goal: &Goal<'_>, j: usize, q: f64) -> impl Iterator<Item = f64> + use<> {
    let (lower, upper) = goal.chain.limits().0[j];
    let least = ((lower - q - ROUNDING_RAD) / TAU).ceil() as i32;
    let most = ((upper - q + ROUNDING_RAD) / TAU).floor() as i32;
    (least..=most).map(move |turns| (q + TAU * f64::from(turns)).clamp(lower, upper))
}

fn at_all_turns(goal: &Goal<'_>, q: &Joints) -> Vec<Joints> {
    let mut all = vec![*q];
    for j in 0..JOINTS {
        let options: Vec<f64> = turns(goal, j, q[j]).collect();
        let with = |posture: Joints| {
            let option = move |own: &f64| {
                let mut posture = posture;
                posture[j] = *own;
                posture
            };
            options.iter().map(option).collect::<Vec<_>>()
        };
        all = all.into_iter().flat_map(with).collect();
    }
    all
}

/// Returns the posture as an answer, refined where the arm deviates from its family.
fn exact(goal: &Goal<'_>, q: &Joints) -> Option<IkSolution> {
    let refined = || (goal.chain.joints() > 5).then(|| refine(goal, q, POLISH));
    IkSolution::accept(goal, &Refined::at(goal, *q))
        .or_else(|| IkSolution::accept(goal, &refined()?))
}

/// Returns a solution refined from postures that nearly fit, or the nearest.
fn near(goal: &Goal<'_>, arm: &Closed, found: &[Found]) -> Result<IkSolution, Refined> {
    let is_complete = match arm {
        Closed::Five(arm) => return Err(five::nearest_approach(goal, arm)),
        Closed::Six(arm) => found.iter().all(|found| arm.is_isolated(&found.q)),
    };
    let limits = goal.chain.limits();
    let mut best = refine(goal, &limits.middle(), STEPS);
    for found in found {
        let refined = refine(goal, &limits.clamp(&found.q), STEPS);
        if refined.error() < best.error() {
            best = refined;
        }
        if let Some(answer) = IkSolution::accept(goal, &best) {
            return Ok(answer);
        }
    }
    match IkSolution::accept(goal, &best) {
        Some(answer) => Ok(answer),
        None if !is_complete && best.error() < NEAR_MISS => restarts::first(goal),
        None => Err(best),
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Isometry3, Translation3, UnitQuaternion};
    use robot_model::Robot as Description;

    use super::*;
    use crate::kinematics::chain::{Chain, Geometry};
    use crate::samples::Random;

    const UR5E: &str = include_str!("../../../../../config/robots/ur5e.urdf");
    const SPHERICAL: &str =
        include_str!("../../../../../tests/fixtures/robots/spherical_wrist.urdf");

    fn chain(urdf: &str, tip: &str) -> Chain {
        Chain::from_description(&Description::parse(urdf, None).unwrap(), tip).unwrap()
    }

    /// What the closed form rejects without a search, a search does not reach either: poses a little
    /// beyond the reach or the limits.
    #[test]
    fn narrow_rejections_are_right() {
        let seed = 5;
        let mut random = Random::seeded(seed);
        for chain in [chain(UR5E, "arm_gripper"), chain(SPHERICAL, "flange")] {
            let Geometry::General(general) = chain.geometry() else { panic!("six joints") };
            let arm = general.closed().expect("a family");
            let (mut narrow, mut tried) = (0, 0);
            while narrow < 40 {
                tried += 1;
                assert!(tried < 20_000, "seed {seed}: {narrow} narrow misses");
                let aside = |random: &mut Random| [(); 3].map(|()| random.between(-0.01, 0.01));
                let q = chain.limits().at(&std::array::from_fn(|_| random.unit()));
                let q = if tried % 2 == 0 { stretched(q) } else { q };
                let shift = Translation3::from(aside(&mut random));
                let turn = UnitQuaternion::from_scaled_axis(aside(&mut random).into());
                let target =
                    shift * chain.forward(&q) * Isometry3::from_parts([0.0; 3].into(), turn);
                let goal = Goal::new(&chain, &target);
                let Err(nearest) = first(&goal, arm) else { continue };
                if nearest.error() < NEAR_MISS {
                    narrow += 1;
                    let searched = restarts::first(&goal);
                    assert!(searched.is_err(), "seed {seed}: {q:?} {searched:?}");
                }
            }
        }
    }

    fn stretched(mut q: Joints) -> Joints {
        q[2] = 0.0;
        q
    }
}
