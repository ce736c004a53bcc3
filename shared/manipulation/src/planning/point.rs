//! Pointing at an object: the gripper's axis passes through it.

use std::f64::consts::PI;

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};

use super::error::{Furthest, PlanError};
use super::fetch::HOME;
use super::planning_scene::{PlanSettings, PlanningScene, Search};
use crate::collision::Cuboid;
use crate::kinematics::chain::positive;
use crate::kinematics::limb::{Joints, Limb};
use crate::robot::Robot;
use crate::trajectory::{Phase, Stage, Timeline, Trajectory};

/// Pitch of the gripper towards the object, radians from the horizontal, best first.
const ELEVATIONS: [f64; 4] = [0.9, 0.6, 1.2, PI / 2.0];

/// From which side, radians off the direction from the shoulder to the object.
const AZIMUTHS: [f64; 3] = [0.0, 0.5, -0.5];

/// Turns about the gripper's own axis; pointing leaves it free.
const ROLLS: usize = 6;

/// Postures tried to the end, soonest first.
const TRIES: usize = 24;

/// Complete plans among which the shortest is taken.
const COMPARED: usize = 5;

/// Largest depth of a target's support below its centre, metres.
const LOWER_M: f64 = 0.05;

const AIM: &str = "the place to point from";

/// Plans to point at `target_m` (metres, frame `base`) with the arms at `arms`: with `limb`, or
/// with the one that is there sooner. `others` are not touched; the object pointed at may be among
/// them.
///
/// # Errors
/// [`PlanError`] of the attempt that came furthest.
pub fn plan_point(
    robot: &Robot,
    target_m: [f64; 3],
    limb: Option<Limb>,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Timeline, PlanError> {
    let mut furthest = Furthest::default();
    let mut choices = Vec::new();
    let place = (target_m, target_m[2] - LOWER_M);
    let scenes: Vec<_> = robot
        .limbs_of(limb)
        .into_iter()
        .map(|side| PlanningScene::new(robot, side, arms, others, place, settings))
        .collect::<Result<_, PlanError>>()?;
    for scene in &scenes {
        for (rank, gripper) in looks(scene, &Vector3::from(target_m)) {
            match scene.chain.nearest(&gripper, &scene.q) {
                Ok(solution) => {
                    let cost_s = scene.cost_s(&scene.q, &solution.q);
                    choices.push((cost_s + 0.3 * rank, scene, solution.q));
                }
                Err(missed) => {
                    let (limb, distance_m) = (scene.limb, missed.position_error_m);
                    furthest.add(0, PlanError::Unreachable { at: AIM, limb, distance_m });
                }
            }
        }
    }
    choices.sort_by(|a, b| a.0.total_cmp(&b.0));
    choices.truncate(TRIES);
    for (cost_s, scene, q) in &mut choices {
        // What is blocked is refused, with its reason, when it is tried.
        *cost_s += scene.crowding_s(q).unwrap_or(0.0);
    }
    choices.sort_by(|a, b| a.0.total_cmp(&b.0));
    for search in [Search::No, Search::Yes] {
        let plans = choices.iter().filter_map(|(_, scene, q)| {
            let tried = point_from(scene, q, search)
                .map(|plan| (plan.duration_s() + scene.plan_lowness_s(&plan), plan));
            tried.map_err(|(progress, error)| furthest.add(progress, error)).ok()
        });
        let compared = if search == Search::No { COMPARED } else { 1 };
        let best = plans.take(compared).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, plan)) = best {
            return Ok(plan);
        }
    }
    Err(furthest.report())
}

fn point_from(
    scene: &PlanningScene<'_>,
    q: &Joints,
    search: Search,
) -> Result<Timeline, (usize, PlanError)> {
    let limb = scene.limb;
    if let Some(gap) = scene.blocked(q) {
        return Err((1, PlanError::Blocked { at: AIM, limb, gap }));
    }
    let way = scene.way(&scene.q, q, search).ok_or_else(|| (2, scene.no_path(AIM, &scene.q, q)))?;
    let back = scene
        .way(q, &scene.arm.neutral, search)
        .ok_or_else(|| (3, scene.no_path(HOME, q, &scene.arm.neutral)))?;
    let aim = scene.motion(AIM, &way).map_err(|error| (4, error))?;
    let home = scene.motion(HOME, &back).map_err(|error| (4, error))?;
    let still = Trajectory::hold(q, scene.settings.point_s, &scene.limits);
    let stage = |phase, motion| Stage { phase, motion, width_m: (0.0, 0.0) };
    let stages =
        vec![stage(Phase::Aim, aim), stage(Phase::Hold, still), stage(Phase::Return, home)];
    Ok(Timeline::new(limb, stages))
}

/// Poses of the gripper that point at `target`, each with its penalty.
fn looks(scene: &PlanningScene<'_>, target: &Vector3<f64>) -> Vec<(f64, Isometry3<f64>)> {
    let shoulder = scene.chain.shoulder();
    let towards = (target.y - shoulder.y).atan2(target.x - shoulder.x);
    let mut looks = Vec::new();
    for (i, elevation) in ELEVATIONS.into_iter().enumerate() {
        for (j, azimuth) in AZIMUTHS.into_iter().enumerate() {
            let (s, c) = (towards + azimuth).sin_cos();
            let (down, ahead) = elevation.sin_cos();
            let axis = Vector3::new(ahead * c, ahead * s, -down);
            for k in 0..ROLLS {
                let roll = 2.0 * PI * k as f64 / ROLLS as f64;
                let pose = looking(target, &axis, scene.settings.standoff_m, roll);
                looks.push(((i + j) as f64, pose));
            }
        }
    }
    looks
}

/// Returns the gripper `standoff_m` before `target`, z along `axis`, turned about it by `roll`.
fn looking(
    target: &Vector3<f64>,
    axis: &Vector3<f64>,
    standoff_m: f64,
    roll: f64,
) -> Isometry3<f64> {
    let side = if axis.z.abs() < 0.99 { Vector3::z() } else { Vector3::x() };
    let x = side.cross(axis).normalize();
    let upright = Rotation3::from_basis_unchecked(&[x, axis.cross(&x), *axis]);
    let rotation = UnitQuaternion::from_rotation_matrix(&upright)
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), roll);
    Isometry3::from_parts(Translation3::from(target - axis * standoff_m), positive(rotation))
}
