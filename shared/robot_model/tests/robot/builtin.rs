//! The built-in robot against its other description and the collected facts.

use nalgebra::{Point3, Translation3, Vector3};
use robot_model::{Body, JointKind, Robot, Shape};

use crate::samples::{Random, difference, facts, fixture, numbers};

#[test]
fn built_in_frames_match_the_reference_description() {
    let ours = Robot::baxter();
    let other = Robot::parse(&fixture("baxter/baxter.urdf"), None).unwrap();
    assert_eq!(ours.links().len(), other.links().len());
    let seed = 1;
    let mut random = Random::seeded(seed);
    for round in 0..200 {
        let q: Vec<f64> = ours
            .joints()
            .iter()
            .map(|joint| joint.limits.map_or(0.0, |l| random.between(l.lower, l.upper)))
            .collect();
        let at = |name: &str| q[ours.joints().iter().position(|j| j.name == name).unwrap()];
        let expected = other.poses(|joint| at(&joint.name));
        for (link, pose) in ours.links().iter().zip(ours.poses(|joint| at(&joint.name))) {
            let mut same = expected[other.link_index(&link.name).unwrap()];
            // The reference has the fingers in slot 2, 9.5 mm further out than slot 1.
            for (finger, further_in) in
                [("_gripper_l_finger", -0.0095), ("_gripper_r_finger", 0.0095)]
            {
                if link.name.contains(finger) {
                    same *= Translation3::new(0.0, further_in, 0.0);
                }
            }
            let worst = difference(&pose, &same);
            assert!(worst < 1e-14, "seed {seed}, round {round}, {}: {worst:e}", link.name);
            assert!(pose.rotation.w >= 0.0);
        }
    }
}

#[test]
fn built_in_arm_capsules_match_the_data_sheet() {
    let robot = Robot::baxter();
    let facts = facts();
    let mut seen = 0;
    for limb in ["left", "right"] {
        let mut next = std::collections::HashMap::new();
        for fact in facts["capsule"].as_array().unwrap() {
            let link = format!("{limb}_{}", fact["link"].as_str().unwrap());
            let index: &mut usize = next.entry(link.clone()).or_default();
            let body = &robot.link(&link).unwrap().collision[*index];
            *index += 1;
            seen += 1;
            let Shape::Capsule { radius, length } = body.shape else { panic!("{link}: {body:?}") };
            assert_eq!(radius, fact["radius"].as_float().unwrap(), "{link}");
            for (end, sign) in [("a", -0.5), ("b", 0.5)] {
                let found = body.origin * Point3::new(0.0, 0.0, sign * length);
                let expected = Vector3::from_vec(numbers(&fact[end]));
                let worst = (found.coords - expected).amax();
                assert!(worst < 1e-9, "{link} {end}: {worst:e}");
            }
        }
        for (link, count) in next {
            assert_eq!(robot.link(&link).unwrap().collision.len(), count, "{link}");
        }
    }
    assert_eq!(seen, 30);
}

#[test]
fn built_in_trunk_and_head_shapes_match_the_data_sheet() {
    let robot = Robot::baxter();
    let facts = facts();
    let links = facts["link"].as_array().unwrap();
    for name in ["torso", "pedestal", "collision_head_link_1", "collision_head_link_2"] {
        let fact = links.iter().find(|link| link["name"].as_str() == Some(name)).unwrap();
        let shapes = fact["collision"].as_array().unwrap();
        let bodies = &robot.link(name).unwrap().collision;
        assert_eq!(bodies.len(), shapes.len(), "{name}");
        for (body, fact) in bodies.iter().zip(shapes) {
            assert_eq!(body.origin.translation.vector.as_slice(), numbers(&fact["xyz"]), "{name}");
            match &body.shape {
                Shape::Box { size } => assert_eq!(size.as_slice(), numbers(&fact["size"])),
                Shape::Sphere { radius } => assert_eq!(Some(*radius), fact["radius"].as_float()),
                other => panic!("{name}: {other:?}"),
            }
        }
    }
    let poses = robot.poses(|_| 0.0);
    for (name, y) in [("collision_head_link_1", -0.04), ("collision_head_link_2", 0.04)] {
        let index = robot.link_index(name).unwrap();
        let ball = poses[index] * robot.links()[index].collision[0].origin;
        assert!((ball.translation.vector - Vector3::new(0.04, y, 0.75)).amax() < 1e-15);
    }
    let shapes: usize = robot.links().iter().map(|link| link.collision.len()).sum();
    assert_eq!(shapes, 30 + 7 + 2, "nothing else is in the way");
}

/// Checked pairs are the reference pairs, except for two pairs of capsules that always touch: a
/// description permits contact of whole links.
#[test]
fn permitted_contacts_are_those_without_a_reference_pair() {
    let robot = Robot::baxter();
    let pairs: serde_json::Value =
        serde_json::from_str(&fixture("baxter/clearance_pairs.json")).unwrap();
    let mut listed: Vec<(String, String)> = Vec::new();
    for pair in pairs["pairs"].as_array().unwrap() {
        let [a, b] = [0, 1].map(|i| pair[i].as_str().unwrap().split('#').next().unwrap());
        listed.push((a.to_owned(), b.to_owned()));
    }
    let name = |index: usize| match robot.links()[index].name.as_str() {
        head if head.starts_with("collision_head") => "head".to_owned(),
        other => other.to_owned(),
    };
    let solid: Vec<usize> = (0..robot.links().len())
        .filter(|&index| !robot.links()[index].collision.is_empty())
        .collect();
    for &a in &solid {
        for &b in solid.iter().filter(|&&b| b > a) {
            let (one, two) = (name(a), name(b));
            let looked_for =
                listed.iter().any(|(x, y)| (x, y) == (&one, &two) || (x, y) == (&two, &one));
            assert_eq!(robot.may_touch().contains(&(a, b)), !looked_for, "{one} {two}");
        }
    }
}

#[test]
fn built_in_postures_match_the_data_sheet() {
    let robot = Robot::baxter();
    let facts = facts();
    for limb in ["left", "right"] {
        for name in ["neutral", "untuck", "tuck"] {
            let key = if name == "neutral" { name.to_owned() } else { format!("{limb}_{name}") };
            let posture = robot.posture(&format!("{limb}_arm"), name).unwrap();
            let arm = robot.chain(&format!("{limb}_gripper")).unwrap();
            let found: Vec<f64> =
                arm.movable().map(|joint| posture.position(joint.child - 1).unwrap()).collect();
            assert_eq!(found, numbers(&facts["poses"][&key]), "{limb} {name}");
        }
    }
    assert_eq!(robot.postures().len(), 6);
    assert_eq!(robot.posture("left_arm", "asleep"), None);
}

#[test]
fn arms_begin_at_the_base_and_have_seven_joints() {
    let robot = Robot::baxter();
    assert_eq!((robot.name(), robot.root().name.as_str()), ("baxter", "base"));
    for limb in ["left", "right"] {
        let arm = robot.chain(&format!("{limb}_gripper")).unwrap();
        let names: Vec<&str> = arm.movable().map(|joint| joint.name.as_str()).collect();
        let expected = ["s0", "s1", "e0", "e1", "w0", "w1", "w2"].map(|j| format!("{limb}_{j}"));
        assert_eq!(names, expected);
        assert_eq!(arm.links().next().unwrap().name, "base");
        assert_eq!(arm.tip().name, format!("{limb}_gripper"));
        assert!(arm.joints().all(|j| matches!(j.kind, JointKind::Fixed | JointKind::Revolute)));
    }
    let error = robot.chain("tail").unwrap_err();
    assert_eq!(error.to_string(), "robot \"baxter\" has no link \"tail\"");
}

#[test]
fn fingers_follow_each_other() {
    let robot = Robot::baxter();
    let gap = |position: f64| {
        let poses = robot.poses(|joint| match joint.kind {
            JointKind::Prismatic => position,
            _ => 0.0,
        });
        let at = |name| poses[robot.link_index(name).unwrap()];
        (at("l_gripper_r_finger_tip").inverse() * at("l_gripper_l_finger_tip")).translation.y
    };
    assert!((gap(0.02) - gap(0.0) - 0.04).abs() < 1e-15);
    // A follower's chain is moved by the joint that it follows.
    let finger = robot.chain("r_gripper_r_finger_tip").unwrap();
    let last = finger.movable().last().unwrap();
    assert_eq!(last.name, "r_gripper_l_finger_joint");
    let tip = |travel: f64| {
        finger.forward(&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, travel]).translation.vector
    };
    let arm = robot.chain("right_gripper").unwrap().forward(&[0.0; 7]);
    let expected = arm.rotation * Vector3::new(0.0, -0.02, 0.0);
    assert!((tip(0.02) - tip(0.0) - expected).amax() < 1e-12);
}

#[test]
fn every_visual_has_a_colour() {
    let robot = Robot::baxter();
    let visual: Vec<&Body> = robot.links().iter().flat_map(|link| &link.visual).collect();
    assert!(visual.len() > 50);
    assert!(visual.iter().all(|body| body.colour.is_some()));
    assert!(visual.iter().all(|body| !matches!(body.shape, Shape::Mesh { .. })));
    let mass: f64 = robot.links().iter().filter_map(|l| Some(l.inertial.as_ref()?.mass)).sum();
    assert!((130.0..150.0).contains(&mass), "{mass} kg");
}
