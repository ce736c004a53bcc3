//! Plans that put back what was handed over.

use manipulation::{ObjectPose, Phase, Timeline, plan_pick, plan_put_back, plan_put_down};
use nalgebra::Isometry3;

use super::support::scenes;
use super::support::tables::{all_but, settings};
use super::{arms_with, assert_sound, gripper, robot};

/// Returns the pick of an object, and the object in its gripper.
fn picked(object: &ObjectPose, others: &[manipulation::Cuboid]) -> (Timeline, Isometry3<f64>) {
    let neutral = robot().neutral();
    let pick = plan_pick(robot(), object, None, &neutral, others, &settings()).unwrap();
    let (from, _) = pick.span_s(Phase::Lift).unwrap();
    let in_gripper = gripper(&pick, from).inverse() * object.isometry();
    (pick, in_gripper)
}

/// The gripper is where it was handed over as it closes, and lets go where the object stood, after
/// straight down and before straight up.
fn assert_puts_back(plan: &Timeline, object: &ObjectPose, in_gripper: &Isometry3<f64>, what: &str) {
    let (let_go_s, opened_s) = plan.span_s(Phase::Release).unwrap();
    let off = object.isometry().inverse() * gripper(plan, let_go_s) * in_gripper;
    assert!(off.translation.vector.norm() < 1e-4, "{what}: {off}");
    assert!(off.rotation.angle() < 1e-4, "{what}: {off}");
    let low = gripper(plan, let_go_s).translation;
    for (start, step) in [(let_go_s, -0.01), (opened_s, 0.01)] {
        let mut t = start;
        while (gripper(plan, t).translation.z - low.z) < 0.1 && t > 0.0 {
            let beside = (gripper(plan, t).translation.vector - low.vector).xy().norm();
            assert!(beside < 0.002, "{what}: {beside} m beside at {t}");
            t += step;
        }
    }
}

#[test]
fn shipped_objects_go_back_to_their_places() {
    use Phase::{CarryBack, Close, Lower, Raise, Release, Return, Take};

    for scene in ["bowls", "markers"] {
        let objects: Vec<_> = scenes::read(scene).into_iter().map(|(_, pose)| pose).collect();
        for (i, object) in objects.iter().enumerate() {
            let others = all_but(&objects, i);
            let (pick, in_gripper) = picked(object, &others);
            let limb = pick.limb();
            let (_, over) = pick.span_s(Phase::Release).unwrap();
            for arms in [robot().neutral(), arms_with(limb, pick.at(over).q)] {
                let what = format!("{scene} {i} from {arms:?}");
                let plan =
                    plan_put_back(robot(), object, &in_gripper, limb, &arms, &others, &settings())
                        .unwrap_or_else(|error| panic!("{what}: {error}"));
                let phases: Vec<Phase> = plan.stages().iter().map(|stage| stage.phase).collect();
                let expected = [Take, Take, Close, CarryBack, Lower, Release, Raise, Return];
                assert_eq!(phases, expected, "{what}");
                let (closes, _) = plan.span_s(Phase::Close).unwrap();
                let tip = gripper(&plan, closes).translation.vector;
                assert!(settings().is_hand_over(limb, &tip, 1e-3), "{what}");
                assert_sound(&plan, &others, &what);
                assert_puts_back(&plan, object, &in_gripper, &what);
            }
        }
    }
}

#[test]
fn held_object_is_put_down_from_every_moment_of_its_way_back() {
    let bowls: Vec<_> = scenes::read("bowls").into_iter().map(|(_, pose)| pose).collect();
    for (i, bowl) in bowls.iter().enumerate().skip(1).take(3) {
        let others = all_but(&bowls, i);
        let (pick, in_gripper) = picked(bowl, &others);
        let (limb, neutral) = (pick.limb(), robot().neutral());
        let whole = plan_put_back(robot(), bowl, &in_gripper, limb, &neutral, &others, &settings())
            .unwrap();
        let (from, _) = whole.span_s(Phase::CarryBack).unwrap();
        let (_, to) = whole.span_s(Phase::Lower).unwrap();
        for k in 0..=16 {
            let t = from + (to - from) * f64::from(k) / 16.0;
            let what = format!("bowl {i} at {t}");
            let arms = arms_with(limb, whole.halted_at(t).end());
            let rest = plan_put_down(robot(), bowl, &in_gripper, limb, &arms, &others, &settings())
                .unwrap_or_else(|error| panic!("{what}: {error}"));
            assert_eq!(rest.at(0.0).q, arms[limb], "{what}");
            assert_sound(&rest, &others, &what);
            assert_puts_back(&rest, bowl, &in_gripper, &what);
        }
    }
}
