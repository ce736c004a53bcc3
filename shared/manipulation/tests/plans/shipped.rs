//! The scenes that ship: every object is fetched and pointed at, every bowl at every place.

use manipulation::{
    Cuboid, Limb, ObjectPose, Phase, Timeline, check_reachable, plan_pick, plan_point,
};
use nalgebra::Vector3;

use super::support::checker::Checker;
use super::support::scenes;
use super::support::tables::{all_but, settings};
use super::{assert_fetches, assert_sound, gripper, robot};

#[test]
fn objects_of_the_shipped_scenes_are_fetched_and_pointed_at() {
    let (robot, neutral) = (robot(), robot().neutral());
    for scene in ["bowls", "markers", "tools"] {
        let (names, poses): (Vec<String>, Vec<ObjectPose>) =
            scenes::read(scene).into_iter().unzip();
        let all: Vec<Cuboid> = poses.iter().map(ObjectPose::cuboid).collect();
        for (i, (name, pose)) in names.iter().zip(&poses).enumerate() {
            let what = format!("{scene}: {name}");
            let reachable = check_reachable(robot, &poses, i, None, &settings());
            assert!(reachable.is_ok(), "{what}: {reachable:?}");
            let others = all_but(&poses, i);
            let pick = plan_pick(robot, pose, None, &neutral, &others, &settings())
                .unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_fetches(&pick, pose, &what);
            let point = plan_point(robot, pose.xyz_m, None, &neutral, &all, &settings())
                .unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_sound(&point, &all, &what);
            assert_aims(&point, pose, &what);
            assert!(pick.duration_s() < 14.0 && point.duration_s() < 8.0, "{what}");
            // The joints' own axes; the housings reach 8 cm round them.
            let elbow_m = lowest_elbow_m(&pick).min(lowest_elbow_m(&point));
            assert!(elbow_m > settings().table_z_m + 0.15, "{what}: {elbow_m}");
        }
    }
}

/// The gripper's axis passes through the object's centre, at the distance that is set.
fn assert_aims(plan: &Timeline, object: &ObjectPose, what: &str) {
    let (hold, end) = plan.span_s(Phase::Hold).unwrap();
    assert!((end - hold - settings().point_s).abs() < 1e-12, "{what}");
    let gripper = gripper(plan, hold);
    let to_object = Vector3::from(object.xyz_m) - gripper.translation.vector;
    let axis = gripper.rotation * Vector3::z();
    assert!((to_object.norm() - settings().standoff_m).abs() < 1e-5, "{what}");
    assert!(axis.cross(&to_object).norm() < 1e-5 && axis.dot(&to_object) > 0.0, "{what}");
}

/// Links that make up the elbow and the forearm up to the wrist.
const ELBOW: [&str; 3] = ["lower_elbow", "upper_forearm", "lower_forearm"];

/// Returns the least height of those links during a plan, by the description's own forward
/// kinematics, metres.
fn lowest_elbow_m(plan: &Timeline) -> f64 {
    let (limb, description) = (plan.limb(), robot().description());
    let names = &robot().arm(limb).joint_names;
    let links = ELBOW.map(|link| description.link_index(&format!("{limb}_{link}")).unwrap());
    let lowest = |k: usize| {
        let q = plan.at(k as f64 * 0.02).q;
        let place = |name: &str| names.iter().position(|own| own == name);
        let poses = description.poses(|joint| place(&joint.name).map_or(0.0, |i| q[i]));
        links.map(|link| poses[link].translation.z).into_iter().fold(f64::INFINITY, f64::min)
    };
    (0..=(plan.duration_s() / 0.02).ceil() as usize).map(lowest).fold(f64::INFINITY, f64::min)
}

#[test]
fn every_bowl_is_picked_and_handed_over_at_every_place() {
    let checker = Checker::new(robot());
    let (names, poses): (Vec<String>, Vec<ObjectPose>) = scenes::read("bowls").into_iter().unzip();
    let places = scenes::attribute("bowls", "location");
    for (i, name) in names.iter().enumerate() {
        for k in 0..poses.len() {
            let objects = scenes::swapped(&poses, i, k);
            let others = all_but(&objects, i);
            let what = format!("{name} at {}'s place ({})", names[k], places[k]);
            let neutral = robot().neutral();
            let plan = plan_pick(robot(), &objects[i], None, &neutral, &others, &settings())
                .unwrap_or_else(|error| panic!("{what}: {error}"));
            println!("{what}: {} arm, {:.2} s", plan.limb(), plan.duration_s());
            assert_sound(&plan, &others, &what);
            assert_fetches(&plan, &objects[i], &what);
            // The rack is below the table's top, so the checker's table is lower there.
            let table_z_m = settings().table_z_m.min(objects[i].bottom_z_m());
            let touched = checker.violation(&plan, &objects[i], &others, table_z_m);
            assert!(touched.is_none(), "{what}: {touched:?}");
            assert!(plan.duration_s() < 16.0, "{what}: {}", plan.duration_s());
        }
    }
}

#[test]
fn each_object_is_reported_with_its_limb_or_error() {
    use manipulation::PlanError;
    let mut objects: Vec<ObjectPose> =
        scenes::read("bowls").into_iter().map(|(_, pose)| pose).collect();
    objects.push(ObjectPose { xyz_m: [1.6, 0.0, -0.13], ..objects[1] });
    objects.push(ObjectPose { grasp_width_m: 0.06, ..super::marker() });
    let check = |i| check_reachable(robot(), &objects, i, None, &settings());
    let checked: Vec<_> = (0..objects.len()).map(check).collect();
    for (object, found) in objects.iter().zip(&checked[..6]) {
        let near = if object.xyz_m[1] > 0.0 { Limb::Left } else { Limb::Right };
        assert!(object.xyz_m[1].abs() < 0.3 || *found == Ok(near), "{object:?} {found:?}");
    }
    assert!(matches!(checked[6], Err(PlanError::Unreachable { .. })), "{:?}", checked[6]);
    assert!(matches!(checked[7], Err(PlanError::Grasp(_))), "{:?}", checked[7]);
}
