//! Grasps of arms with five joints: straight down, or tilted in the plane in which the arm reaches out.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_6};

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::error::PlanError;
use super::fetch::GRASP;
use super::grasp::{Grasp, GraspError, ObjectPose};
use super::planning_scene::PlanningScene;
use crate::kinematics::chain::Five;
use crate::kinematics::inverse::TOLERANCE_M;
use crate::robot::Arm;

/// Tilts that are tried if the gripper cannot come from straight above, radians: 15, 30 and 45 degrees.
const TILTS_RAD: [f64; 3] = [FRAC_PI_4 / 3.0, FRAC_PI_6, FRAC_PI_4];

/// Most that the fingers may be turned against the sides of an object, radians.
const ASKEW_RAD: f64 = 0.12;

/// Half of the breadth of a fingertip, whose lower edge a tilt lowers, metres.
const HALF_TIP_M: f64 = 0.008;

/// Returns what `attempt` makes of the grasps from straight above, or else of those of the least tilt with which it
/// succeeds.
///
/// # Errors
/// The error from straight above; or if the gripper cannot come from there nor tilted, how far off it would be.
pub(super) fn by_tilt<T>(
    object: &ObjectPose,
    scenes: &[PlanningScene<'_>],
    mut attempt: impl FnMut(&dyn Fn(&Arm) -> Result<Vec<Grasp>, GraspError>) -> Result<T, PlanError>,
) -> Result<T, PlanError> {
    let first = attempt(&|arm| object.grasps(&arm.gripper));
    let Err(error) = first else { return first };
    let mut five = scenes.iter().filter(|scene| scene.chain.five().is_some()).peekable();
    if five.peek().is_none() || matches!(error, PlanError::Grasp(_) | PlanError::Start(_)) {
        return Err(error);
    }
    let mut is_tried = false;
    for tilt_rad in TILTS_RAD {
        if scenes
            .iter()
            .all(|scene| tilted(object, scene.arm, tilt_rad).is_ok_and(|all| all.is_empty()))
        {
            continue;
        }
        is_tried = true;
        if let Ok(found) = attempt(&|arm| tilted(object, arm, tilt_rad)) {
            return Ok(found);
        }
    }
    let off = |scene: &PlanningScene<'_>| {
        let grasps = object.grasps(&scene.arm.gripper).ok()?;
        let missed = scene.chain.inverse(&grasps.first()?.gripper, None).err()?;
        let off_deg = missed.rotation_error_rad.to_degrees();
        let is_near = missed.position_error_m <= TOLERANCE_M;
        is_near.then_some(PlanError::Approach { at: GRASP, limb: scene.limb, off_deg })
    };
    Err(five
        .find_map(off)
        .filter(|_| !is_tried || matches!(error, PlanError::Unreachable { .. }))
        .unwrap_or(error))
}

/// Returns a gripper tilted as far as objects are gripped tilted, turned so that the arm can hold it; each with a
/// number of its own above π. What is held may be tilted where it is handed over: such an arm hardly lifts its hand upright.
pub(super) fn tilted_at(arm: &Five, upright: &Isometry3<f64>) -> Vec<(f64, Isometry3<f64>)> {
    let place = upright.translation.vector;
    // The furthest first: it leaves the most room to withdraw.
    let sides = TILTS_RAD.into_iter().rev().flat_map(|tilt| [tilt, -tilt]);
    let turned = sides
        .map(|side| upright.rotation * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), side));
    let all = turned.flat_map(|rotation| {
        let yaws = arm.yaws(&place, &rotation, &Vector3::zeros()).unwrap_or_default();
        yaws.into_iter()
            .map(move |yaw| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw) * rotation)
    });
    let posed = all.map(|rotation| Isometry3::from_parts(place.into(), rotation));
    posed.enumerate().map(|(k, pose)| (4.0 + k as f64, pose)).collect()
}

/// Returns the grasps from above tilted in the arm's plane, the fingers along the sides of the object or nearly so.
fn tilted(object: &ObjectPose, arm: &Arm, tilt_rad: f64) -> Result<Vec<Grasp>, GraspError> {
    let Some(five) = arm.chain.five() else { return Ok(Vec::new()) };
    let middle = Vector3::y() * arm.gripper.aside_m(object.grasp_width_m);
    let mut all = Vec::new();
    for Grasp { gripper, width_m } in object.grasps(&arm.gripper)? {
        let at = gripper * nalgebra::Point3::from(middle);
        let at = at.coords + Vector3::z() * (HALF_TIP_M * tilt_rad.sin());
        for side in [tilt_rad, -tilt_rad] {
            let turned =
                gripper.rotation * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), side);
            for yaw in five
                .yaws(&at, &turned, &middle)
                .into_iter()
                .flatten()
                .filter(|yaw| yaw.abs() <= ASKEW_RAD)
            {
                let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw) * turned;
                let gripper =
                    Isometry3::from_parts(at.into(), rotation) * Translation3::from(-middle);
                all.push(Grasp { gripper, width_m });
            }
        }
    }
    Ok(all)
}
