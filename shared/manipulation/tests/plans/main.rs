//! Whole plans, carried out and checked: by a checker that shares no code with the planner, and
//! against what each plan is for.
#![allow(clippy::unwrap_used, reason = "a test ends at what it does not expect")]

mod errors;
mod put_back;
mod resume;
mod shipped;
mod support;
mod tables;

use manipulation::gripper::Gripper;
use manipulation::{Clearance, Cuboid, Joints, Limb, ObjectPose, Phase, Robot, Timeline};
use nalgebra::{Isometry3, Vector3};
use support::checker::broken_limit;
use support::tables::settings;

fn robot() -> &'static Robot {
    Robot::baxter()
}

fn marker() -> ObjectPose {
    ObjectPose {
        xyz_m: [0.68, -0.15, -0.148],
        yaw_rad: 0.3,
        size_m: [0.14, 0.014, 0.014],
        grasp_width_m: 0.014,
        mass_kg: None,
        wall_rad: 0.0,
        hollow: false,
    }
}

/// Both arms at rest but for one.
fn arms_with(limb: Limb, q: Joints) -> [Joints; 2] {
    let mut arms = robot().neutral();
    arms[limb] = q;
    arms
}

fn fingers(plan: &Timeline) -> &'static Gripper {
    &robot().arm(plan.limb()).gripper
}

fn gripper(plan: &Timeline, t_s: f64) -> Isometry3<f64> {
    robot().arm(plan.limb()).chain.forward(&plan.at(t_s).q)
}

/// Every limit, the margin within the robot, and no contact with what stands around; it ends at rest.
fn assert_sound(plan: &Timeline, others: &[Cuboid], what: &str) {
    let limb = plan.limb();
    let broken =
        broken_limit(plan, &robot().arm(limb).limits.at_speed_ratio(settings().speed_ratio));
    assert!(broken.is_none(), "{what}: {broken:?}");
    for k in 0..=(plan.duration_s() / 0.02).ceil() as usize {
        let now = plan.at(k as f64 * 0.02);
        assert!((0.0..=fingers(plan).open_m).contains(&now.width_m), "{what}: {now:?}");
        let clearance = Clearance::of(robot(), &arms_with(limb, now.q), others);
        assert!(clearance.robot().distance_m > 0.008, "{what}: {now:?} {clearance:?}");
        let around = clearance.surroundings[limb];
        assert!(others.is_empty() || around.distance_m > -1e-4, "{what}: {now:?} {around:?}");
    }
    let end = plan.at(1e9);
    assert_eq!(end.q, robot().arm(limb).neutral, "{what}");
    assert!(end.qd.iter().all(|v| v.abs() < 1e-6), "{what}");
}

/// The gripper is at a grasp when it closes, goes straight down before and up after, and lets go
/// where the person waits.
fn assert_fetches(plan: &Timeline, object: &ObjectPose, what: &str) {
    use Phase::{Approach, Close, HandOver, Lift, Raise, Release, Return};
    let phases: Vec<Phase> = plan.stages().iter().map(|stage| stage.phase).collect();
    assert_eq!(phases, [Approach, Close, Lift, HandOver, Release, Raise, Return], "{what}");
    let span = |phase| plan.span_s(phase).unwrap();
    let (closes_s, closed_s) = span(Close);
    let (lifts_s, lifted_s) = span(Lift);
    let at = gripper(plan, closes_s);
    let is_at = |grasp: &Isometry3<f64>| {
        let off = grasp.inverse() * at;
        off.translation.vector.norm() < 1e-5 && off.rotation.angle() < 1e-5
    };
    assert!(
        object.grasps(fingers(plan)).unwrap().iter().any(|grasp| is_at(&grasp.gripper)),
        "{what}: {at}"
    );
    assert!((plan.at(closes_s).width_m - fingers(plan).open_m).abs() < 1e-12, "{what}");
    assert!((plan.at(closed_s - 1e-9).width_m - object.grasp_width_m).abs() < 1e-6, "{what}");

    // From the grasp outwards in time, both ways: straight until 10 cm above it.
    for (start, step) in [(closes_s, -0.01), (lifts_s, 0.01)] {
        let mut t = start;
        loop {
            let from_grasp = gripper(plan, t).translation.vector - at.translation.vector;
            if from_grasp.z > 0.10 {
                break;
            }
            assert!(from_grasp.xy().norm() < 1e-3, "{what}: {from_grasp:?} at {t}");
            assert!((0.0..lifted_s).contains(&t), "{what}: never rose");
            t += step;
        }
    }

    assert_eq!(span(HandOver).1, span(Release).0, "{what}");
    assert_hands_over(plan, what);
    assert!((plan.at(1e9).width_m - fingers(plan).open_m).abs() < 1e-12, "{what}");
}

/// What is held is upright where the person waits, or straight above.
fn assert_hands_over(plan: &Timeline, what: &str) {
    let let_go = gripper(plan, plan.span_s(Phase::Release).unwrap().0);
    let tip = let_go.translation.vector;
    assert!(settings().is_hand_over(plan.limb(), &tip, 1e-5), "{what}: {tip:?}");
    let tilt = let_go.rotation * Vector3::z() + Vector3::z();
    assert!(tilt.norm() < 1e-5, "{what}: {tilt:?}");
}
