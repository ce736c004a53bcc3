//! Approaches of an arm with five joints, and the nearest to one that it cannot take.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::Isometry3;

use super::closed::turned;
use super::goal::Goal;
use super::refine::{Refined, refine};
use crate::kinematics::chain::{Chain, Closed, Five, Frame, Geometry};
use crate::kinematics::limb::Joints;

/// Greatest angle between an answer's and the target's orientation: descriptions round their angles, and five joints
/// cannot make up for it, radians.
pub(super) const TOLERANCE_RAD: f64 = 1e-4;

/// Elevations and rolls from which the nearest approach is looked for, and the steps to which it is narrowed, radians.
const ELEVATIONS: usize = 61;
const ROLLS: usize = 9;
const NARROW_RAD: f64 = 1e-5;

/// Neighbours that are looked at.
const AROUND: usize = 16;

/// Refinement steps towards a position out of reach.
const STEPS: usize = 40;

impl Chain {
    /// Postures of an arm with five joints, pan, three parallel ones and roll, that take the tip to a point (metres,
    /// frame `base`) with its approach, the axis of the last joint, at an elevation above the horizon and that joint at
    /// `roll` (radians). Empty for other arms.
    pub fn reach(&self, at_m: [f64; 3], elevation: f64, roll: f64) -> Vec<Joints> {
        let Some(arm) = self.five() else { return Vec::new() };
        let goal = Goal::new(self, &Isometry3::translation(at_m[0], at_m[1], at_m[2]));
        reach(&goal, arm, elevation, roll).collect()
    }

    /// The closed form of five joints.
    pub(crate) fn five(&self) -> Option<&Five> {
        match self.geometry() {
            Geometry::General(arm) => match arm.closed()? {
                Closed::Five(arm) => Some(arm),
                Closed::Six(_) => None,
            },
            Geometry::Alternating(_) => None,
        }
    }
}

fn reach<'a>(
    goal: &'a Goal<'_>,
    arm: &Five,
    elevation: f64,
    roll: f64,
) -> impl Iterator<Item = Joints> + use<'a> {
    let middle = goal.chain.limits().middle();
    let found =
        arm.reach(&goal.tool.origin, elevation, roll).into_iter().filter(|found| found.reaches);
    found.filter_map(move |found| turned(goal, &found, &middle))
}

/// An approach that is taken: its angle to the wanted one, the posture, and elevation and roll, radians.
type Taken = (f64, Joints, [f64; 2]);

/// Returns the posture at the goal's position whose approach is nearest to the goal's, with the angle between the two;
/// or if the position is out of reach, one that comes near. The search is for an error alone: what can be reached has been
/// found before.
pub(super) fn nearest_approach(goal: &Goal<'_>, arm: &Five) -> Refined {
    let approach_of = |frame: &Frame| arm.approach_of(&frame.isometry().rotation);
    let (wanted, (low, high)) = (approach_of(&goal.tool), goal.chain.limits().0[4]);
    let look = |[elevation, roll]: [f64; 2]| {
        let at = [elevation.clamp(-FRAC_PI_2, FRAC_PI_2), roll.clamp(low, high)];
        let off = |q: &Joints| approach_of(&goal.chain.tool_frame(q)).angle(&wanted);
        let all = reach(goal, arm, at[0], at[1]).map(|q| (off(&q), q, at));
        all.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    let least = |all: &mut dyn Iterator<Item = Taken>| all.min_by(|a, b| a.0.total_cmp(&b.0));
    let share = |k: usize, count: usize| k as f64 / (count - 1) as f64;
    let found = (0..ROLLS).filter_map(|j| {
        let roll = low + (high - low) * share(j, ROLLS);
        let at = |i: usize| look([PI * (share(i, ELEVATIONS) - 0.5), roll]);
        let mut best = least(&mut (0..ELEVATIONS).filter_map(at))?;
        let mut step = [PI / ELEVATIONS as f64, (high - low) / ROLLS as f64];
        while step[0] > NARROW_RAD {
            let [e, r] = best.2;
            // All round, since along a joint's limit elevation and roll change together.
            let around = (0..AROUND).map(|k| (TAU * k as f64 / AROUND as f64).sin_cos());
            let mut around = around.filter_map(|(s, c)| look([e + step[0] * s, r + step[1] * c]));
            match least(&mut around) {
                Some(better) if better.0 < best.0 - 1e-9 => best = better,
                _ => step = step.map(|step| 0.5 * step),
            }
        }
        Some(best)
    });
    match least(&mut found.into_iter()) {
        None => refine(goal, &goal.chain.limits().middle(), STEPS),
        Some((off, q, _)) => {
            let position_error_m = goal.errors(&q).0;
            Refined { q, position_error_m, rotation_error_rad: off }
        }
    }
}
