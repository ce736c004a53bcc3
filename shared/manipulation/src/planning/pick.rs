//! Fetching an object: approach, close, lift, hand over, release, return.

use super::choices::{Choice, Choices};
use super::deliver::{CORNER, deliver, fingers};
use super::error::{Furthest, PlanError};
use super::fetch::{ABOVE, Carry, GRASP, HOME};
use super::planning_scene::{PlanSettings, PlanningScene, Search};
use super::tilt::by_tilt;
use crate::collision::Cuboid;
use crate::kinematics::limb::{Joints, Limb};
use crate::planning::grasp::{Grasp, GraspError, ObjectPose};
use crate::robot::{Arm, Robot};
use crate::trajectory::{Phase, Stage, Timeline};

/// Choices that are tried; of one limb, where it is only asked whether it reaches.
const TRIES: usize = 64;

/// Complete plans among which the best is taken, and how many there may be while all of them
/// carry the elbow low over the table.
const COMPARED: usize = 5;
const COMPARED_LOW: usize = 10;

/// Choices for which ways are searched for at length.
const SEARCHED: usize = 8;

/// Plans a pick, from `arms` (both arms' postures) to neutral and checked along its whole length: with `limb`, or with the better one. `others` is
/// everything else that stands around; neither the arm nor what it holds touches any of it.
///
/// Limbs, grasps and postures are tried in the order of their cost (seconds, closeness to joint
/// limits, to everything around, and of the elbow to the table). Of the first complete plans the
/// shortest is taken, one with a high elbow before any with a low one.
///
/// # Errors
/// [`PlanError`] of the attempt that came furthest.
pub fn plan_pick(
    robot: &Robot,
    object: &ObjectPose,
    limb: Option<Limb>,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Timeline, PlanError> {
    let scenes = planning_scenes(robot, object, limb, arms, others, settings)?;
    by_tilt(object, &scenes, |grasps| {
        cheapest(grasps, &scenes, |choice, search| choice.plan(object, search))
    })
}

/// Returns the cheapest of the complete plans that `plan` makes of choices; see [`plan_pick`].
pub(crate) fn cheapest<'a>(
    grasps: impl Fn(&Arm) -> Result<Vec<Grasp>, GraspError>,
    scenes: &'a [PlanningScene<'a>],
    plan: impl Fn(&Choice<'a>, Search) -> Result<Timeline, (usize, PlanError)>,
) -> Result<Timeline, PlanError> {
    let mut furthest = Furthest::default();
    let mut choices = Choices::new(grasps, scenes, &mut furthest);
    let (mut best, mut found, mut lost) = (None::<(f64, Timeline)>, 0, Vec::new());
    for _ in 0..TRIES {
        let Some(choice) = choices.next(&mut furthest) else { break };
        match plan(&choice, Search::No) {
            Ok(plan) => {
                let low_s = choice.scene.plan_lowness_s(&plan);
                let cost_s = plan.duration_s() + low_s;
                if best.as_ref().is_none_or(|(least_s, _)| cost_s < *least_s) {
                    best = Some((cost_s, plan));
                }
                found += 1;
                let high = best.as_ref().is_some_and(|(s, plan)| *s <= plan.duration_s());
                if found >= COMPARED && high || found >= COMPARED_LOW {
                    break;
                }
            }
            Err((progress, error)) => {
                furthest.add(progress, error);
                choices.failed(&choice);
                if progress >= BEYOND_HOLD && lost.len() < SEARCHED {
                    lost.push(choice);
                }
            }
        }
    }
    if let Some((_, plan)) = best {
        return Ok(plan);
    }
    for choice in lost {
        match plan(&choice, Search::Yes) {
            Ok(plan) => return Ok(plan),
            Err((progress, error)) => furthest.add(progress, error),
        }
    }
    Err(furthest.report())
}

/// Progress from which on a longer search may help: the grasp itself and its lift are possible.
const BEYOND_HOLD: usize = 5;

/// Progress of a limb that touches something where it rests, beyond any other: no object is at fault.
const AT_REST: usize = 9;

/// The limb that can fetch object `i` from the neutral posture among the others: what a scene is checked for before
/// anything moves. Ways between are not searched.
///
/// # Errors
/// As [`fetching_limb`].
pub fn check_reachable(
    robot: &Robot,
    objects: &[ObjectPose],
    i: usize,
    limb: Option<Limb>,
    settings: &PlanSettings,
) -> Result<Limb, PlanError> {
    let mut others: Vec<Cuboid> = objects.iter().map(ObjectPose::cuboid).collect();
    others.remove(i);
    fetching_limb(robot, &objects[i], limb, &others, settings)
}

/// The limb that can fetch one object from the neutral posture among `others`; see
/// [`check_reachable`].
///
/// # Errors
/// [`PlanError`] of the attempt that came furthest.
pub fn fetching_limb(
    robot: &Robot,
    object: &ObjectPose,
    limb: Option<Limb>,
    others: &[Cuboid],
    settings: &PlanSettings,
) -> Result<Limb, PlanError> {
    let scenes = planning_scenes(robot, object, limb, &robot.neutral(), others, settings)?;
    by_tilt(object, &scenes, |grasps| fetching(object, &scenes, grasps))
}

fn fetching(
    object: &ObjectPose,
    scenes: &[PlanningScene<'_>],
    grasps: &dyn Fn(&Arm) -> Result<Vec<Grasp>, GraspError>,
) -> Result<Limb, PlanError> {
    let mut furthest = Furthest::default();
    for scene in scenes {
        if let Some(gap) = scene.blocked(&scene.q) {
            furthest.add(AT_REST, PlanError::Blocked { at: HOME, limb: scene.limb, gap });
            continue;
        }
        let mut choices = Choices::new(grasps, std::slice::from_ref(scene), &mut furthest);
        // As many as a plan would try.
        for _ in 0..TRIES {
            let Some(choice) = choices.next(&mut furthest) else { break };
            let carrying = choice.carrying(object);
            let fetched = choice.descent(&carrying).and_then(|_| {
                Carry::find(&carrying, &choice.above, Search::No).map_err(|error| (6, error))
            });
            match fetched {
                Ok(_) => return Ok(scene.limb),
                Err((progress, error)) => furthest.add(progress, error),
            }
            choices.failed(&choice);
        }
    }
    Err(furthest.report())
}

fn planning_scenes<'a>(
    robot: &'a Robot,
    object: &ObjectPose,
    limb: Option<Limb>,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &'a PlanSettings,
) -> Result<Vec<PlanningScene<'a>>, PlanError> {
    let mut limbs = robot.limbs_of(limb);
    // The arm on the object's own side first.
    limbs.sort_by(|a, b| (b.side() * object.xyz_m[1]).total_cmp(&(a.side() * object.xyz_m[1])));
    limbs
        .into_iter()
        .map(|limb| planning_scene(robot, object, limb, arms, others, settings))
        .collect()
}

pub(crate) fn planning_scene<'a>(
    robot: &'a Robot,
    object: &ObjectPose,
    limb: Limb,
    arms: &[Joints; 2],
    others: &[Cuboid],
    settings: &'a PlanSettings,
) -> Result<PlanningScene<'a>, PlanError> {
    let bottom = object.bottom_z_m();
    let scene = PlanningScene::new(robot, limb, arms, others, (object.xyz_m, bottom), settings)?;
    Ok(scene.with_board_under(&object.cuboid()))
}

impl Choice<'_> {
    fn plan(&self, object: &ObjectPose, search: Search) -> Result<Timeline, (usize, PlanError)> {
        let scene = self.scene;
        let carrying = self.carrying(object);
        let descent = self.descent(&carrying)?;
        let way = scene
            .way(&scene.q, &self.above, search)
            .ok_or_else(|| (5, scene.no_path(ABOVE, &scene.q, &self.above)))?;
        let width_m = scene.arm.gripper.closed_on(self.grasp.width_m);
        let lift: Vec<Joints> = descent.iter().rev().copied().collect();
        let at_grasp = lift[0];
        let in_gripper = object.in_gripper(&self.grasp.gripper, &scene.arm.gripper);
        let held = (object, &in_gripper, width_m);
        let delivery = deliver(scene, &carrying, lift, held, search);
        let delivery = delivery.map_err(|error| (6, error))?;
        // To above the grasp and straight down in one motion, with no stop between.
        let waypoints = [&way[..], &descent[CORNER.min(descent.len() - 1)..]].concat();
        let approach = scene.motion(GRASP, &waypoints).map_err(|error| (7, error))?;
        let open_m = scene.open_m();
        let mut stages = vec![
            Stage { phase: Phase::Approach, motion: approach, width_m: (open_m, open_m) },
            fingers(scene, Phase::Close, &at_grasp, (open_m, width_m)),
        ];
        stages.extend(delivery);
        Ok(Timeline::new(scene.limb, stages))
    }
}
