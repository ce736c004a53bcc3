//! Plans that do not exist, and the reasons.

use manipulation::{
    Cuboid, Limb, ObjectPose, PlanError, PlanSettings, check_reachable, plan_pick, plan_point,
    plan_return,
};

use super::support::tables::{Bench, settings};
use super::support::ur5e;
use super::{arms_with, marker, robot};

/// Why `object` cannot be picked from neutral arms.
fn refusal(object: &ObjectPose, others: &[Cuboid], settings: &PlanSettings) -> PlanError {
    plan_pick(robot(), object, None, &robot().neutral(), others, settings).unwrap_err()
}

#[test]
fn plan_errors_name_their_reason() {
    let far = ObjectPose { xyz_m: [1.7, 0.0, -0.13], ..marker() };
    let error = refusal(&far, &[], &settings());
    let PlanError::Unreachable { distance_m, .. } = error else { panic!("{error:?}") };
    assert!(distance_m > 0.3 && distance_m < 1.0, "{error}");
    assert!(error.to_string().contains("out of the"), "{error}");

    let lid = Cuboid::aligned([0.68, -0.15, -0.05], [0.4, 0.4, 0.02]);
    let error = refusal(&marker(), &[lid], &settings());
    assert!(matches!(error, PlanError::Blocked { .. }), "{error}");
    assert!(error.to_string().contains("other object"), "{error}");

    let away = PlanSettings { hand_over_xyz_m: [1.5, 0.3, 0.2], ..settings() };
    let error = refusal(&marker(), &[], &away);
    assert!(error.to_string().contains("hand over"), "{error}");
    assert!(check_reachable(robot(), &[marker()], 0, None, &away).is_err());
}

#[test]
fn postures_that_no_plan_may_start_in_are_refused() {
    let (left, mut outside) = (Limb::Left, robot().neutral());
    outside[left][1] = 2.0;
    let pick = plan_pick(robot(), &marker(), Some(left), &outside, &[], &settings());
    let point = plan_point(robot(), marker().xyz_m, Some(left), &outside, &[], &settings());
    let home = plan_return(robot(), left, &outside, &[], &settings());
    for plan in [pick, point, home] {
        assert!(matches!(plan, Err(PlanError::Start(_))), "{plan:?}");
    }
    let description = robot().description();
    let tuck = description.posture("right_arm", "tuck").unwrap();
    let joints = description.chain("right_gripper").unwrap();
    let tuck: Vec<f64> = joints.movable().map(|j| tuck.position(j.child - 1).unwrap()).collect();
    let tucked = arms_with(Limb::Right, tuck.try_into().unwrap());
    let error = plan_return(robot(), Limb::Right, &tucked, &[], &settings()).unwrap_err();
    assert!(error.to_string().contains("present posture"), "{error}");
}

#[test]
fn limb_that_a_robot_lacks_stands_for_its_only_one() {
    let (robot, settings) = (ur5e(), Bench::ur5e().settings);
    let block = ObjectPose { xyz_m: [0.55, 0.1, 0.02], size_m: [0.04; 3], ..marker() };
    let neutral = robot.neutral();
    for limb in [Limb::Left, Limb::Right, Limb::Only].map(Some) {
        let pick = plan_pick(&robot, &block, limb, &neutral, &[], &settings).unwrap();
        let point = plan_point(&robot, block.xyz_m, limb, &neutral, &[], &settings).unwrap();
        assert_eq!((pick.limb(), point.limb()), (Limb::Only, Limb::Only));
        assert_eq!(check_reachable(&robot, &[block], 0, limb, &settings), Ok(Limb::Only));
    }
}
