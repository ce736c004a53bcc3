//! Check that a scene's objects can be fetched.

use super::choices::Choices;
use super::error::{Furthest, PlanError};
use super::fetch::Carry;
use super::pick::planning_scenes;
use super::planning_scene::{PlanSettings, Search};
use crate::collision::Cuboid;
use crate::kinematics::limb::Limb;
use crate::planning::grasp::ObjectPose;
use crate::robot::Robot;

/// For each object, the limb that can fetch it from the neutral posture among the others, or why
/// none can: what a scene is checked for before anything moves. Ways between are not searched.
pub fn check_reachable(
    robot: &Robot,
    objects: &[ObjectPose],
    limb: Option<Limb>,
    settings: &PlanSettings,
) -> Vec<Result<Limb, PlanError>> {
    let cuboids: Vec<Cuboid> = objects.iter().map(ObjectPose::cuboid).collect();
    let check = |i: usize| {
        let mut others = cuboids.clone();
        others.remove(i);
        let scenes =
            planning_scenes(robot, &objects[i], limb, &robot.neutral(), &others, settings)?;
        let mut furthest = Furthest::default();
        for scene in &scenes {
            let mut choices =
                Choices::new(&objects[i], std::slice::from_ref(scene), &mut furthest)?;
            while let Some(choice) = choices.next(&mut furthest) {
                let carrying = choice.carrying(&objects[i]);
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
    };
    (0..objects.len()).map(check).collect()
}
