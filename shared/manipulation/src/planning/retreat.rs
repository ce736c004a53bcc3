//! Retreat of a limb from a posture in which no plan can start: outside its joint limits, or in
//! collision. A person may have moved it there by hand, or the robot was stopped there.

use super::deliver::BELOW_TIP_M;
use super::error::PlanError;
use super::planning_scene::{PlanSettings, PlanningScene};
use crate::collision::{Cuboid, Gap};
use crate::kinematics::limb::{Joints, Limb};
use crate::kinematics::limits::PositionLimits;
use crate::robot::Robot;
use crate::trajectory::{Trajectory, refuse_outside};

/// Furthest that a joint may stand outside its limits for the limb to return by itself, radians.
/// Further out, the limits or the sensor are in doubt.
pub const OUTSIDE_MAX_RAD: f64 = 0.5;

/// Share of the plan's speed.
const SPEED: f64 = 0.3;

/// Step of the retreat, radians of joint distance, and how many there may be.
const STEP_RAD: f64 = 0.01;
const STEPS_MAX: usize = 80;

/// Change of a joint that tells the direction of growing distance, radians.
const PROBE_RAD: f64 = 1e-4;

/// Distance to collision that ends a retreat, metres.
const CLEAR_M: f64 = 0.005;

/// Rounding of the corners, radians of joint distance.
const BLEND_RAD: f64 = 0.005;

/// Plans the shortest slow motion after which a plan can start: back to the nearest posture within
/// the joint limits, then away from what `limb` collides with, so that the distance from it grows
/// all along. `None` if a plan can start from `arms` as they are.
///
/// # Errors
/// [`PlanError::Start`] for a joint further outside its limits than [`OUTSIDE_MAX_RAD`], and
/// [`PlanError::Stuck`] where the distance cannot grow: a person must move the limb.
pub fn plan_retreat(
    robot: &Robot,
    limb: Limb,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Option<Trajectory>, PlanError> {
    let arm = robot.arm(limb);
    let limb = arm.limb;
    let (from, limits) = (arms[limb], arm.chain.limits());
    refuse_outside(&widened(limits, |_, bound| bound, OUTSIDE_MAX_RAD), &from)?;
    let within = limits.clamp(&from);
    let mut arms = *arms;
    arms[limb] = within;
    let settings = &PlanSettings { margin_m: 0.0, ..*settings };
    let at = arm.chain.forward(&within).translation;
    let place = ([at.x, at.y, at.z], at.z - BELOW_TIP_M);
    let scene = PlanningScene::new(robot, limb, &arms, others, place, settings)?;
    let mut waypoints = vec![from];
    if within != from {
        waypoints.push(within);
    }
    if scene.blocked(&within).is_some() {
        waypoints.extend(away(&scene, within)?);
    }
    if waypoints.len() == 1 {
        return Ok(None);
    }
    let mut slow = scene.limits.at_speed_ratio(SPEED);
    slow.position = widened(&slow.position, |j, bound: f64| bound + (from[j] - within[j]), 0.0);
    Ok(Some(Trajectory::through(&waypoints, BLEND_RAD, &slow)?))
}

/// Returns postures from `q` on, each further from every collision than the one before.
fn away(scene: &PlanningScene<'_>, mut q: Joints) -> Result<Vec<Joints>, PlanError> {
    let limits = scene.chain.limits();
    let mut gap = scene.nearest(&q, CLEAR_M);
    let mut waypoints = Vec::new();
    while gap.distance_m < CLEAR_M {
        let stuck = PlanError::Stuck { limb: scene.limb, gap };
        let slope: Joints = std::array::from_fn(|j| {
            let mut beside = q;
            beside[j] += PROBE_RAD;
            (scene.nearest(&beside, f64::INFINITY).distance_m - gap.distance_m) / PROBE_RAD
        });
        let length = slope.iter().map(|s| s * s).sum::<f64>().sqrt();
        if waypoints.len() == STEPS_MAX || length < 1e-9 {
            return Err(stuck);
        }
        q = limits.clamp(&std::array::from_fn(|j| q[j] + slope[j] * (STEP_RAD / length)));
        let next = scene.nearest(&q, CLEAR_M);
        if next.distance_m <= gap.distance_m {
            return Err(stuck);
        }
        waypoints.push(q);
        gap = next;
    }
    Ok(waypoints)
}

impl PlanningScene<'_> {
    /// Returns the smallest gap at `q`, if it is below `within_m`.
    fn nearest(&self, q: &Joints, within_m: f64) -> Gap {
        let arm = self.look(q).arm;
        let within = arm.to_itself(within_m).min(arm.to_trunk(within_m));
        let within = self.other_gap(&arm, within_m).min(within);
        self.surroundings.iter().fold(within, |gap, (name, cuboid)| {
            gap.min(arm.to_cuboid(name, cuboid, gap.distance_m))
        })
    }
}

/// Returns the limits, each of their bounds moved by `to` and then out by `by_rad`; never inwards.
fn widened(limits: &PositionLimits, to: impl Fn(usize, f64) -> f64, by_rad: f64) -> PositionLimits {
    PositionLimits(std::array::from_fn(|j| {
        let (lower, upper) = limits.0[j];
        (to(j, lower).min(lower) - by_rad, to(j, upper).max(upper) + by_rad)
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn retreat(q: Joints) -> Result<Option<Trajectory>, PlanError> {
        let robot = Robot::baxter();
        let arms = [q, robot.arm(Limb::Right).neutral];
        plan_retreat(robot, Limb::Left, &arms, &[], &PlanSettings::default())
    }

    #[test]
    fn limb_that_a_plan_can_start_from_stays() {
        assert_eq!(retreat(Robot::baxter().arm(Limb::Left).neutral), Ok(None));
    }

    #[test]
    fn joint_outside_its_limits_returns_to_the_limit() {
        let robot = Robot::baxter();
        let limits = robot.arm(Limb::Left).chain.limits();
        let mut q = robot.arm(Limb::Left).neutral;
        q[5] = limits.0[5].1 + 0.1;
        let motion = retreat(q).unwrap().unwrap();
        assert_eq!(motion.sample(0.0).0, q);
        assert_eq!(motion.end(), limits.clamp(&q));
        q[5] = limits.0[5].1 + 0.6;
        assert!(matches!(retreat(q), Err(PlanError::Start(_))));
    }

    #[test]
    fn limb_in_collision_moves_away_and_never_deeper() {
        let robot = Robot::baxter();
        let settings = PlanSettings { margin_m: 0.0, ..PlanSettings::default() };
        let neutral = robot.arm(Limb::Left).neutral;
        let right = robot.arm(Limb::Right).neutral;
        let mut found = 0;
        for k in 0..200 {
            // From rest down towards the table and in towards the trunk.
            let (down, inwards) = (f64::from(k % 20) * 0.03, f64::from(k / 20) * 0.1);
            let mut q = neutral;
            q[1] += down;
            q[0] += inwards;
            let arms = [q, right];
            // As for every return: what the gripper has reached down to is no table.
            let at = robot.arm(Limb::Left).chain.forward(&q).translation;
            let place = ([at.x, at.y, at.z], at.z - BELOW_TIP_M);
            let scene =
                PlanningScene::new(robot, Limb::Left, &arms, &[], place, &settings).unwrap();
            let first = scene.nearest(&q, f64::INFINITY).distance_m;
            if !(-0.05..0.0).contains(&first) {
                continue;
            }
            found += 1;
            let motion = retreat(q).unwrap().unwrap();
            let (mut last, mut t_s) = (first, 0.0);
            while t_s < motion.duration_s() {
                let now = scene.nearest(&motion.sample(t_s).0, f64::INFINITY).distance_m;
                assert!(now > last - 1e-4, "{k}: {last} m, then {now} m");
                (last, t_s) = (now, t_s + 0.02);
            }
            assert!(scene.clear(&motion.end()));
        }
        assert!(found > 5, "{found} postures in collision");
    }
}
