//! The second half of a pick: lift, hand over, release, withdraw, return; and the way home alone.

use nalgebra::{Isometry3, Translation3};

use super::error::PlanError;
use super::fetch::{ABOVE, Carry, HAND_OVER, HOME, WITHDRAWAL};
use super::pick::planning_scene;
use super::planning_scene::{PlanSettings, PlanningScene, Search};
use crate::collision::Cuboid;
use crate::gripper;
use crate::kinematics::chain::{Chain, LineError};
use crate::kinematics::limb::{Joints, Limb};
use crate::planning::grasp::ObjectPose;
use crate::robot::Robot;
use crate::trajectory::{Phase, Stage, Timeline, Trajectory};

/// Waypoints of a straight line left out at its upper end, so that the corner there has room: 3 cm.
pub(crate) const CORNER: usize = 6;

/// Seconds that the fingers rest after they closed or opened.
const SETTLE_S: f64 = 0.2;

/// Distance by which the fingers withdraw beyond the top of what they have handed over, metres: clear
/// of it and of the hand that holds it. Further up the motion may turn away.
const WITHDRAWN_M: f64 = 0.06;

/// Shares of that distance that are tried, the longest first: the arm may be near the end of its reach.
const WITHDRAWN_SHARES: [f64; 3] = [1.0, 0.75, 0.5];

/// Rounding of the corners of a withdrawal from where the arm stands, radians of joint distance.
const BLEND_RAD: f64 = 0.15;

/// A gripper whose tip is this far beside an object has nothing of it between its fingers, metres.
const BESIDE_M: f64 = 0.03;

/// The enclosing capsules end this far below the fingertips, and a little, metres.
pub(crate) const BELOW_TIP_M: f64 = 0.005;

/// Plans the rest of a pick for an arm that already holds `object`, given as it stood, at
/// `object_in_gripper`: lift it if the gripper is still over its place, hand over, release, withdraw,
/// return.
///
/// # Errors
/// [`PlanError`] if the hand over cannot be reached from here.
pub fn plan_delivery(
    robot: &Robot,
    object: &ObjectPose,
    object_in_gripper: &Isometry3<f64>,
    limb: Limb,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Timeline, PlanError> {
    let scene = planning_scene(robot, object, limb, arms, others, settings)?;
    let carrying = scene.carrying(object, object_in_gripper);
    let held = scene.chain.forward(&scene.q);
    let above = Translation3::new(0.0, 0.0, still_to_lift_m(object, &held, settings)) * held;
    let lift = scene.chain.line(&scene.q, &above).map_err(|line| PlanError::Line {
        at: ABOVE,
        limb,
        line,
    })?;
    let width_m = scene.arm.gripper.closed_on(object.grasp_width_m);
    let held = (object, object_in_gripper, width_m);
    let stages = deliver(&scene, &carrying, lift, held, Search::Yes)?;
    Ok(Timeline::new(scene.limb, stages))
}

/// Returns the rise left before the gripper may leave the object's place, metres; 0 elsewhere.
pub(crate) fn still_to_lift_m(
    object: &ObjectPose,
    held: &Isometry3<f64>,
    settings: &PlanSettings,
) -> f64 {
    let [x, y, _] = object.xyz_m;
    let beside = (held.translation.x - x).hypot(held.translation.y - y);
    if beside > object.size_m[0].hypot(object.size_m[1]) {
        return 0.0;
    }
    (object.top_z_m() + settings.hover_m - held.translation.z).max(0.0)
}

/// Plans the way back to the neutral posture from wherever the arm is, fingers open. `others` is
/// everything that stands around except what the fingers are at.
///
/// # Errors
/// [`PlanError`] if every way is blocked.
pub fn plan_return(
    robot: &Robot,
    limb: Limb,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Timeline, PlanError> {
    let chain = &robot.arm(limb).chain;
    let at = chain.forward(&arms[limb]).translation;
    // Whatever the arm is over now it has reached down to without touching.
    let place = ([at.x, at.y, at.z], at.z - BELOW_TIP_M);
    let scene = PlanningScene::new(robot, limb, arms, others, place, settings)?;
    let way = home(&scene, &scene.q, Search::Yes)?;
    // An arm that was stopped beside something gets away from it slowly rather than not at all.
    let motion = scene.motion(HOME, &way).or_else(|_| scene.creeping(HOME, &way))?;
    let width_m = (scene.open_m(), scene.open_m());
    let stage = Stage { phase: Phase::Return, motion, width_m };
    Ok(Timeline::new(scene.limb, vec![stage]))
}

/// Plans to withdraw an open gripper from an object that a person may be holding out between its
/// fingers, given by its pose in the gripper: back along the fingers until their tips are clear of it.
/// `None` where they are, or the limb cannot go that way.
pub fn plan_withdrawal(
    robot: &Robot,
    object: &ObjectPose,
    object_in_gripper: &Isometry3<f64>,
    (limb, q): (Limb, &Joints),
    settings: &PlanSettings,
) -> Option<Trajectory> {
    let (arm, tip) = (robot.arm(limb), object_in_gripper.inverse().translation);
    let [x, y, _] = object.size_m;
    let depth_m = depth_m(object, object_in_gripper);
    if tip.x.hypot(tip.y) > 0.5 * x.hypot(y) + BESIDE_M || depth_m < -0.5 * WITHDRAWN_M {
        return None;
    }
    let line = withdrawal(&arm.chain, q, depth_m).ok()?;
    Trajectory::through(&line, BLEND_RAD, &arm.limits.at_speed_ratio(settings.speed_ratio)).ok()
}

/// Returns how far below the top of the object the fingertips are.
fn depth_m(object: &ObjectPose, in_gripper: &Isometry3<f64>) -> f64 {
    let tip = in_gripper.inverse().translation;
    0.5 * object.size_m[2] - tip.z
}

/// Returns the straight joint path back along the fingers, from `depth_m` below the top of an object.
fn withdrawal(chain: &Chain, from: &Joints, depth_m: f64) -> Result<Vec<Joints>, LineError> {
    let gripper = chain.forward(from);
    let back = |share: f64| {
        let back_m = depth_m + share * WITHDRAWN_M;
        chain.line(from, &(gripper * Translation3::new(0.0, 0.0, -back_m)))
    };
    let [longest, shorter @ ..] = WITHDRAWN_SHARES;
    back(longest).or_else(|error| shorter.into_iter().find_map(|it| back(it).ok()).ok_or(error))
}

/// Lift, hand over, release, withdraw and return, from the low end of `lift`: `carrying` the object,
/// and without it from the hand over on, with the user holding it there. It is given with its pose in
/// the gripper and the width between the fingers that hold it.
pub(crate) fn deliver(
    scene: &PlanningScene<'_>,
    carrying: &PlanningScene<'_>,
    lift: Vec<Joints>,
    (object, in_gripper, width_m): (&ObjectPose, &Isometry3<f64>, f64),
    search: Search,
) -> Result<Vec<Stage>, PlanError> {
    let above = lift[lift.len() - 1];
    let carry = Carry::find(carrying, &above, search)?;
    let mut waypoints = lift[..lift.len().saturating_sub(CORNER).max(1)].to_vec();
    waypoints.push(above);
    waypoints.extend(carry.waypoints.iter().skip(if carry.straight { CORNER } else { 1 }));
    waypoints.push(*carry.end());
    let whole = carrying.motion(HAND_OVER, &waypoints)?;
    let (lift, hand_over) = whole.split(whole.time_nearest(&above));
    let open_m = scene.open_m();
    let (withdraw, home) = withdraw(scene, carry.end(), (object, in_gripper), search)?;
    let closed = (width_m, width_m);
    Ok(vec![
        Stage { phase: Phase::Lift, motion: lift, width_m: closed },
        Stage { phase: Phase::HandOver, motion: hand_over, width_m: closed },
        fingers(scene, Phase::Release, carry.end(), (width_m, open_m)),
        Stage { phase: Phase::Raise, motion: withdraw, width_m: (open_m, open_m) },
        Stage { phase: Phase::Return, motion: home, width_m: (open_m, open_m) },
    ])
}

/// Back along the fingers, and from there to the neutral posture without a stop between.
fn withdraw(
    scene: &PlanningScene<'_>,
    from: &Joints,
    (object, in_gripper): (&ObjectPose, &Isometry3<f64>),
    search: Search,
) -> Result<(Trajectory, Trajectory), PlanError> {
    let limb = scene.limb;
    let with_user = object.cuboid_at(&(scene.chain.forward(from) * in_gripper));
    let around_it = scene.with_obstacle(("object that was handed over", with_user));
    let back = withdrawal(scene.chain, from, depth_m(object, in_gripper));
    let back = back.map_err(|line| PlanError::Line { at: WITHDRAWAL, limb, line })?;
    let top = back[back.len() - 1];
    let mut waypoints = back[..back.len().saturating_sub(CORNER).max(1)].to_vec();
    waypoints.extend(home(&around_it, &top, search)?);
    let whole = scene.motion(HOME, &waypoints)?;
    let (withdraw, home) = whole.split(whole.time_nearest(&top));
    match around_it.blocked_during(&home) {
        None => Ok((withdraw, home)),
        Some(gap) => Err(PlanError::Blocked { at: HOME, limb, gap }),
    }
}

/// Returns the joint path to the neutral posture; straight up first if the direct one is blocked.
pub(crate) fn home(
    scene: &PlanningScene<'_>,
    from: &Joints,
    search: Search,
) -> Result<Vec<Joints>, PlanError> {
    if let Some(way) = scene.way(from, &scene.arm.neutral, Search::No) {
        return Ok(way);
    }
    let pose = scene.chain.forward(from);
    let raised = Translation3::new(0.0, 0.0, scene.settings.hover_m) * pose;
    let mut up = scene.chain.line(from, &raised).unwrap_or_else(|_| vec![*from]);
    let (top, neutral) = (up[up.len() - 1], &scene.arm.neutral);
    let rest = scene.way(&top, neutral, search);
    let rest = rest.ok_or_else(|| scene.no_path(HOME, &top, neutral))?;
    up.extend(rest.into_iter().skip(1));
    Ok(up)
}

pub(crate) fn fingers(
    scene: &PlanningScene<'_>,
    phase: Phase,
    q: &Joints,
    (from_m, to_m): (f64, f64),
) -> Stage {
    let seconds = gripper::seconds_between(from_m, to_m) + SETTLE_S;
    Stage { phase, motion: Trajectory::hold(q, seconds, &scene.limits), width_m: (from_m, to_m) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_raised_gripper_needs_no_lift() {
        let object = ObjectPose {
            xyz_m: [0.68, -0.15, -0.148],
            yaw_rad: 0.3,
            size_m: [0.14, 0.014, 0.014],
            grasp_width_m: 0.014,
            mass_kg: None,
            wall_rad: 0.0,
            hollow: false,
        };
        let settings = PlanSettings::default();
        let far = Isometry3::translation(0.2, 0.6, 0.3);
        assert_eq!(still_to_lift_m(&object, &far, &settings), 0.0);
        let lift = still_to_lift_m(&object, &object.isometry(), &settings);
        assert!((lift - settings.hover_m - 0.007).abs() < 1e-9);
    }
}
