//! Robots with one limb and six joints: the shipped UR5e, and an industrial arm with a spherical wrist.
#![allow(clippy::unwrap_used, reason = "a test ends at what it does not expect")]

use manipulation::{ArmShape, Chain, Joints, Limb, Robot, TOLERANCE_M, TOLERANCE_RAD};
use robot_model::Robot as Description;

#[path = "../src/random.rs"]
#[allow(dead_code, reason = "a part is needed")]
mod random;
use random::Random;

const SPHERICAL: &str = include_str!("../../../tests/fixtures/robots/spherical_wrist.urdf");
const UNUSUAL: &str = include_str!("../../../tests/fixtures/robots/unusual_six.urdf");

fn ur5e() -> Robot {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../config/robots/");
    let read = |name: &str| std::fs::read_to_string(format!("{folder}{name}")).unwrap();
    let description = Description::parse(&read("ur5e.urdf"), Some(&read("ur5e.srdf"))).unwrap();
    Robot::from_description(&description).unwrap()
}

fn chain(urdf: &str) -> Chain {
    Chain::from_description(&Description::parse(urdf, None).unwrap(), "flange").unwrap()
}

fn distance(a: &Joints, b: &Joints) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

fn random_posture(chain: &Chain, random: &mut Random) -> Joints {
    let share = std::array::from_fn(|_| random.unit());
    chain.limits().at(&share)
}

/// Every target is the pose of a posture within the limits, so each has a solution.
fn solves_all(chain: &Chain, count: u32) {
    let mut random = Random::seeded(7);
    for k in 0..count {
        let q = random_posture(chain, &mut random);
        let target = chain.forward(&q);
        let first = chain.inverse(&target, None).unwrap_or_else(|error| panic!("{k}: {error}"));
        assert!(first.position_error_m <= TOLERANCE_M && first.rotation_error_rad <= TOLERANCE_RAD);
        assert!(chain.limits().within(&first.q) && first.q[6] == 0.0);
        let seed = random_posture(chain, &mut random);
        let nearest = chain.nearest(&target, &seed).unwrap();
        let known = distance(&q, &seed);
        assert!(distance(&nearest.q, &seed) <= known + 1e-6, "{k}: nearer was {q:?}");
        let all = chain.solutions(&target);
        assert!(all.iter().any(|own| distance(own, &q) < 1e-3), "{k}: {q:?} is missing");
        for own in &all {
            let pose = chain.forward(own);
            assert!((pose.translation.vector - target.translation.vector).norm() <= TOLERANCE_M);
            assert!(pose.rotation.angle_to(&target.rotation) <= 1e-5);
        }
    }
}

#[test]
fn arm_with_three_parallel_axes_finds_every_posture() {
    solves_all(&ur5e().arm(Limb::Only).chain, 2000);
}

#[test]
fn arm_with_a_spherical_wrist_finds_every_posture() {
    solves_all(&chain(SPHERICAL), 2000);
}

/// Calibrated descriptions deviate from the ideal family by tenths of a millimetre.
#[test]
fn calibrated_arm_is_solved_as_well() {
    let text = SPHERICAL.replace("xyz=\"0 0 0.72\"", "xyz=\"0.0004 -0.0003 0.7204\"");
    assert_ne!(text, SPHERICAL);
    let text = text.replace("rpy=\"0 0 0\"", "rpy=\"0.001 -0.0008 0.0005\"");
    let chain = chain(&text);
    let mut random = Random::seeded(11);
    for k in 0..500 {
        let target = chain.forward(&random_posture(&chain, &mut random));
        let found = chain.inverse(&target, None).unwrap_or_else(|error| panic!("{k}: {error}"));
        assert!(found.position_error_m <= TOLERANCE_M, "{k}");
    }
}

#[test]
fn arm_of_no_family_is_solved_by_refinement() {
    let chain = chain(UNUSUAL);
    let mut random = Random::seeded(3);
    for k in 0..200 {
        let target = chain.forward(&random_posture(&chain, &mut random));
        let found = chain.inverse(&target, None).unwrap_or_else(|error| panic!("{k}: {error}"));
        assert!(found.position_error_m <= TOLERANCE_M && found.q[6] == 0.0, "{k}");
    }
}

#[test]
fn singular_postures_are_solved() {
    let robot = ur5e();
    for chain in [&robot.arm(Limb::Only).chain, &chain(SPHERICAL)] {
        for k in 0..64u32 {
            let mut q: Joints = std::array::from_fn(|j| 0.3 + 0.2 * j as f64);
            q[6] = 0.0;
            // Straight wrist, straight elbow, both.
            q[4] = if k & 1 == 0 { 0.0 } else { q[4] };
            q[2] = if k & 2 == 0 { 0.0 } else { q[2] };
            q[0] = f64::from(k) * 0.045;
            let target = chain.forward(&q);
            let found = chain.inverse(&target, None).unwrap_or_else(|error| panic!("{k}: {error}"));
            assert!(found.position_error_m <= TOLERANCE_M, "{k}");
        }
    }
}

#[test]
fn pose_out_of_reach_is_refused_with_the_nearest_posture() {
    let robot = ur5e();
    let chain = &robot.arm(Limb::Only).chain;
    let target = nalgebra::Isometry3::translation(1.6, 0.2, 0.3);
    let error = chain.inverse(&target, None).unwrap_err();
    assert!(chain.limits().within(&error.nearest) && error.position_error_m > 0.3, "{error}");
}

/// The home pose of the manufacturer's Denavit-Hartenberg parameters.
#[test]
fn shipped_arm_has_the_published_dimensions() {
    let robot = ur5e();
    let arm = robot.arm(Limb::Only);
    assert_eq!((robot.limbs(), arm.name.as_str()), (&[Limb::Only][..], "arm"));
    let flange = robot.description().chain("arm_hand").unwrap().forward(&[0.0; 6]);
    let [x, y, z]: [f64; 3] = flange.translation.vector.into();
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    assert!(near(x, 0.425 + 0.3922) && near(y, 0.1333 + 0.0996) && near(z, 0.1625 - 0.0997));
    assert_eq!(arm.joint_names.len(), 6);
    assert!((arm.gripper.open_m - 0.05).abs() < 1e-9 && arm.gripper.closed_m() == 0.0);
    assert!(arm.via_postures.len() == 4, "{:?}", arm.via_postures);
}

/// Its second joint moves the upper arm, which reaches the pedestal where it hangs over the edge.
#[test]
fn upper_arm_must_not_touch_the_pedestal() {
    let robot = ur5e();
    let arm = robot.arm(Limb::Only);
    let hanging = [0.0, 0.9, -1.9, 0.0, 0.0, 0.0, 0.0];
    let gap = ArmShape::at(arm, &hanging).to_trunk(0.0);
    assert_eq!((gap.link, gap.other), ("upper", "base"), "{gap:?}");
    assert!(!ArmShape::at(arm, &arm.neutral).to_trunk(0.01).is_some());
}
