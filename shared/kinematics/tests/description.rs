//! What this crate holds of Baxter in numbers equals the robot's description.

#![allow(clippy::unwrap_used, reason = "tests")]

use kinematics::{ArmShape, JOINTS, Limb, baxter, links};
use nalgebra::{Isometry3, Point3};
use robot::{Robot, Shape};

/// Postures spread over the limits: the fractions of a golden-ratio sequence.
fn postures() -> impl Iterator<Item = [f64; 7]> {
    (0..200).map(|round| {
        std::array::from_fn(|i| {
            let (lower, upper) = baxter::POSITION_LIMITS_RAD[i];
            let step = f64::from(round * 7) + i as f64;
            lower + (upper - lower) * (step * 0.618_033_988_749_895).fract()
        })
    })
}

/// Every link of the robot at a posture of one arm and an opening of the fingers.
fn described(limb: Limb, q: &[f64; 7], finger_m: f64) -> Vec<Isometry3<f64>> {
    let names = limb.joint_names();
    Robot::baxter().poses(|joint| match names.iter().position(|name| *name == joint.name) {
        Some(i) => q[i],
        None if joint.name.ends_with("finger_joint") => finger_m,
        None => 0.0,
    })
}

#[test]
fn limits_and_postures_are_described() {
    let robot = Robot::baxter();
    for limb in Limb::BOTH {
        let named = |name: &str, i: usize| {
            let joint = robot.joint(&limb.joint_name(i)).unwrap();
            let posture = robot.posture(&format!("{limb}_arm"), name).unwrap();
            posture.position(joint.child - 1).unwrap()
        };
        for i in 0..JOINTS.len() {
            let limits = robot.joint(&limb.joint_name(i)).unwrap().limits.unwrap();
            assert_eq!((limits.lower, limits.upper), baxter::POSITION_LIMITS_RAD[i]);
            assert_eq!(limits.velocity, baxter::VELOCITY_LIMITS_RAD_S[i]);
            assert_eq!(limits.acceleration, Some(baxter::ACCELERATION_LIMITS_RAD_S2[i]));
            assert_eq!(named("neutral", i), baxter::NEUTRAL[i]);
            assert_eq!(named("untuck", i), baxter::untuck(limb)[i]);
            assert_eq!(named("tuck", i), baxter::tuck(limb)[i]);
        }
    }
    let finger = robot.joint("l_gripper_l_finger_joint").unwrap().limits.unwrap();
    assert_eq!(finger.upper, baxter::FINGER_TRAVEL_M);
}

#[test]
fn every_link_is_where_it_is_described() {
    let robot = Robot::baxter();
    for q in postures() {
        for limb in Limb::BOTH {
            let poses = described(limb, &q, 0.01);
            for (name, pose) in links::links(limb, &q, 0.01) {
                let expected = poses[robot.link_index(&name).unwrap()];
                let apart = (pose.translation.vector - expected.translation.vector).amax();
                let turned = (pose.rotation.coords - expected.rotation.coords).amax();
                assert!(apart.max(turned) < 1e-12, "{name}: {apart:e} {turned:e}");
            }
        }
    }
}

#[test]
fn capsules_are_described() {
    let robot = Robot::baxter();
    for q in postures().take(20) {
        for limb in Limb::BOTH {
            let poses = described(limb, &q, 0.0);
            let mut capsules = ArmShape::at(limb, &q).capsules().to_vec().into_iter();
            let arm = robot.chain(&format!("{limb}_hand")).unwrap();
            for link in arm.links().filter(|link| link.name.starts_with(limb.name())) {
                let pose = poses[robot.link_index(&link.name).unwrap()];
                for body in &link.collision {
                    let Shape::Capsule { radius, length } = body.shape else { panic!("{body:?}") };
                    let capsule = capsules.next().unwrap();
                    assert_eq!(capsule.radius, radius, "{}", link.name);
                    for (found, z) in [(capsule.a, -0.5 * length), (capsule.b, 0.5 * length)] {
                        let expected = pose * body.origin * Point3::new(0.0, 0.0, z);
                        assert!((found - expected.coords).amax() < 1e-9, "{}", link.name);
                    }
                }
            }
            assert_eq!(capsules.next(), None);
        }
    }
}
