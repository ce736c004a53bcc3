use nalgebra::Isometry3;

use super::*;
use crate::kinematics::chain::Geometry;
use crate::kinematics::inverse::{TOLERANCE_M, TOLERANCE_RAD};
use crate::samples::{Random, difference, fixture, neutral, robot};

fn described(urdf: &str) -> Description {
    Description::parse(urdf, None).unwrap_or_else(|faults| panic!("{faults}"))
}

/// Another arm of Baxter's family, and one that is of none.
fn others() -> [Chain; 2] {
    let iiwa = include_str!("../../../../tests/fixtures/robots/seven_joints.urdf");
    let askew = iiwa.replace(r#"<origin xyz="0 0 0.2045""#, r#"<origin xyz="0.05 0.03 0.2045""#);
    assert_ne!(askew, iiwa, "the fixture has changed");
    [iiwa, &askew].map(|urdf| Chain::from_description(&described(urdf), "flange").unwrap())
}

fn is_closed_form(chain: &Chain) -> bool {
    matches!(chain.geometry(), Geometry::Alternating(_))
}

#[test]
fn robot_limits_and_postures_match_the_data_sheet() {
    let facts: toml::Table = fixture("baxter_facts.toml").parse().unwrap();
    let joints = facts["joint"].as_array().unwrap();
    for limb in Limb::BOTH {
        let arm = robot().arm(limb);
        assert_eq!(arm.joint_names, limb.joint_names());
        for (i, name) in arm.joint_names.iter().enumerate() {
            let fact = joints.iter().find(|j| j["name"].as_str() == Some(name)).unwrap();
            let of = |key: &str| fact[key].as_float().unwrap();
            assert_eq!((of("lower"), of("upper")), arm.limits.position.0[i], "{name}");
            assert_eq!(of("velocity"), arm.limits.velocity[i], "{name}");
        }
        assert_eq!((arm.limits.acceleration, arm.limits.jerk), ([2.0; 7], [20.0; 7]));
        assert_eq!(arm.neutral, neutral());
        assert_eq!(arm.via_postures.len(), 2, "neutral and untuck; the tuck is in the trunk");
        assert!(is_closed_form(&arm.chain));
    }
}

#[test]
fn chain_agrees_with_its_description() {
    let mut random = Random::seeded(51);
    for limb in Limb::BOTH {
        let arm = robot().arm(limb);
        let described = robot().description().chain(&format!("{limb}_gripper")).unwrap();
        for _ in 0..200 {
            let q = random.posture();
            assert!(difference(&arm.chain.forward(&q), &described.forward(&q)) < 1e-10);
        }
    }
}

#[test]
fn limb_family_is_recognised() {
    let [family, askew] = others();
    assert!(is_closed_form(&family) && !is_closed_form(&askew));
}

#[test]
fn limbs_of_other_robots_are_solved() {
    let seed = 52;
    let mut random = Random::seeded(seed);
    for (chain, count) in others().into_iter().zip([400, 60]) {
        for _ in 0..count {
            let q = chain.limits().at(&std::array::from_fn(|_| random.unit()));
            let target = chain.forward(&q);
            let found =
                chain.inverse(&target, None).unwrap_or_else(|e| panic!("{seed} {q:?}: {e}"));
            assert_reaches(&chain, &target, &found.q);
            let near = chain.inverse(&target, Some(&q)).unwrap();
            assert_reaches(&chain, &target, &near.q);
            let away: f64 = near.q.iter().zip(&q).map(|(a, b)| (a - b).powi(2)).sum();
            assert!(away.sqrt() < 1e-3, "{seed} {q:?}");
        }
        let all = chain.solutions(&chain.forward(&[0.3; 7]));
        assert!(all.len() > 3 && all.iter().all(|q| chain.limits().within(q)));
        let far = Isometry3::translation(5.0, 0.0, 0.0);
        assert!(chain.inverse(&far, None).is_err() && chain.solutions(&far).is_empty());
        assert!(chain.inverse(&Isometry3::translation(f64::NAN, 0.0, 0.0), None).is_err());
    }
}

fn assert_reaches(chain: &Chain, target: &Isometry3<f64>, q: &Joints) {
    let reached = chain.forward(q);
    assert!(chain.limits().within(q));
    assert!((reached.translation.vector - target.translation.vector).norm() <= TOLERANCE_M);
    assert!(reached.rotation.angle_to(&target.rotation) <= TOLERANCE_RAD + 3e-8);
}

#[test]
fn jacobians_of_other_robots_agree_with_finite_differences() {
    let mut random = Random::seeded(53);
    for chain in others() {
        let q = chain.limits().at(&std::array::from_fn(|_| random.unit()));
        let jacobian = chain.tool_and_jacobian(&q).1;
        for j in 0..7 {
            let moved = |by: f64| {
                let mut q = q;
                q[j] += by;
                chain.forward(&q)
            };
            let (before, after) = (moved(-1e-6), moved(1e-6));
            let linear = (after.translation.vector - before.translation.vector) / 2e-6;
            let turn = (after.rotation * before.rotation.inverse()).scaled_axis() / 2e-6;
            for i in 0..3 {
                assert!((jacobian[(i, j)] - linear[i]).abs() < 1e-8);
                assert!((jacobian[(i + 3, j)] - turn[i]).abs() < 1e-8);
            }
        }
    }
}

#[test]
fn robot_names_what_a_description_lacks() {
    let iiwa = described(include_str!("../../../../tests/fixtures/robots/seven_joints.urdf"));
    let error = Robot::from_description(&iiwa).unwrap_err().to_string();
    assert!(error.contains("found 0") && error.contains("arm_gripper"), "{error}");
    let one_sided = robot_model::BAXTER_URDF.replace("\"right_gripper\"", "\"right_hook\"");
    let error = Robot::from_description(&described(&one_sided)).unwrap_err().to_string();
    assert!(error.contains("right_gripper") && error.contains("five to seven"), "{error}");
    let error = Chain::from_description(&iiwa, iiwa.root().name.as_str()).unwrap_err().to_string();
    assert!(error.contains("0 moving joints"), "{error}");
    let unposed = described(robot_model::BAXTER_URDF);
    let error = Robot::from_description(&unposed).unwrap_err().to_string();
    assert!(error.contains("neutral") && error.contains("<group_state"), "{error}");
    let meshed = robot_model::BAXTER_URDF.replace(
        r#"<capsule radius="0.1466" length="0.175646263837"/>"#,
        r#"<mesh filename="shoulder.stl"/>"#,
    );
    let meshed = Description::parse(&meshed, Some(robot_model::BAXTER_SRDF)).unwrap();
    let error = Robot::from_description(&meshed).unwrap_err().to_string();
    assert!(error.contains("shoulder.stl") && error.contains("capsules"), "{error}");
}

#[test]
fn robot_encloses_unsupported_shapes() {
    let boxed = robot_model::BAXTER_URDF.replace(
        r#"<capsule radius="0.1466" length="0.175646263837"/>"#,
        r#"<box size="0.06 0.08 0.3"/>"#,
    );
    let boxed = Description::parse(&boxed, Some(robot_model::BAXTER_SRDF)).unwrap();
    let boxed = Robot::from_description(&boxed).unwrap();
    let capsule = boxed.arm(Limb::Left).enclosures[0].capsule;
    assert!((capsule.radius - 0.05).abs() < 1e-12);
    assert!(((capsule.a - capsule.b).norm() - 0.3).abs() < 1e-9);
}

#[test]
fn a_tool_may_point_anywhere() {
    let mut random = Random::seeded(54);
    let range = Chain::from_description(robot().description(), "left_hand_range").unwrap();
    let described = robot().description().chain("left_hand_range").unwrap();
    assert!(is_closed_form(&range));
    for _ in 0..100 {
        let q = random.posture();
        let target = range.forward(&q);
        assert!(difference(&target, &described.forward(&q)) < 1e-9);
        assert_reaches(&range, &target, &range.inverse(&target, None).unwrap().q);
    }
}

fn shipped(urdf: &str) -> Result<Robot, String> {
    let description = Description::parse(urdf, Some(robot_model::BAXTER_SRDF)).unwrap();
    Robot::from_description(&description).map_err(|error| error.to_string())
}

#[test]
fn robot_that_needs_minutes_for_a_motion_is_refused() {
    for slow in ["0", "0.001", "1e-300"] {
        let urdf = robot_model::BAXTER_URDF.replacen(
            "velocity=\"1.5\"",
            &format!("velocity=\"{slow}\""),
            1,
        );
        let error = shipped(&urdf).unwrap_err();
        assert!(error.contains("joint \"left_s0\" has velocity=0"), "{error}");
        assert!(error.contains("0.05 or more, in radians"), "{error}");
    }
}

#[test]
fn robot_of_too_many_shapes_is_refused() {
    let shape = r#"<collision><geometry><sphere radius="0.01"/></geometry></collision>"#;
    for (link, of) in [("left_upper_shoulder", "limb \"left\""), ("torso", "the body")] {
        let head = format!("<link name=\"{link}\">");
        assert!(robot_model::BAXTER_URDF.contains(&head), "{link}");
        let many = format!("{head}{}", shape.repeat(600));
        let error = shipped(&robot_model::BAXTER_URDF.replace(&head, &many)).unwrap_err();
        assert!(error.contains(&format!("collision shapes of {of}, found")), "{error}");
    }
}

#[test]
fn robot_says_what_it_takes_for_granted() {
    assert!(robot().assumptions().is_empty(), "{:?}", robot().assumptions());
    let bare = without_shapes(robot_model::BAXTER_URDF);
    let assumed = shipped(&bare).unwrap().assumptions().join("\n");
    for said in ["limb left has no collision shapes", "limb right has no collision shapes"] {
        assert!(assumed.contains(said), "{assumed}");
    }
}

/// The text without its elements `<collision>`.
fn without_shapes(urdf: &str) -> String {
    let mut parts = urdf.split("<collision>");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        text + part.split_once("</collision>").map_or("", |(_, rest)| rest)
    })
}
