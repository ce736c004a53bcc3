//! Robots other than the built-in one.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;
use robot_model::{JointKind, Robot, SerialChain, Shape};

use crate::samples::{Random, fixture};

fn seven() -> Robot {
    Robot::parse(&fixture("robots/seven_joints.urdf"), None).unwrap()
}

fn tip(arm: &SerialChain<'_>, q: &[f64]) -> Vector3<f64> {
    arm.forward(q).translation.vector
}

#[test]
fn an_arm_of_known_dimensions_is_where_its_data_sheet_says() {
    let robot = seven();
    let arm = robot.chain("flange").unwrap();
    assert_eq!(arm.movable().count(), 7);
    let up = tip(&arm, &[0.0; 7]);
    assert!((up - Vector3::new(0.0, 0.0, 0.36 + 0.42 + 0.40 + 0.126)).amax() < 1e-15, "{up}");
    // The elbow turns the forearm towards −x.
    let bent = tip(&arm, &[0.0, 0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0]);
    assert!((bent - Vector3::new(-0.526, 0.0, 0.78)).amax() < 1e-15, "{bent}");
    let across = tip(&arm, &[FRAC_PI_2, 0.0, 0.0, FRAC_PI_2, 0.0, 0.0, 0.0]);
    assert!((across - Vector3::new(0.0, -0.526, 0.78)).amax() < 1e-15, "{across}");
    // The last three axes meet: they turn the wrist without moving it.
    let wrist = robot.chain("link_6").unwrap();
    let mut random = Random::seeded(2);
    for _ in 0..50 {
        let mut q: Vec<f64> = (0..6).map(|_| random.between(-2.0, 2.0)).collect();
        let before = tip(&wrist, &q);
        q[4] += 0.7;
        q[5] -= 0.4;
        assert!((tip(&wrist, &q) - before).amax() < 1e-15);
    }
}

#[test]
fn meshes_are_kept_by_name_and_newer_limits_are_read() {
    let robot = seven();
    let Shape::Mesh { file } = &robot.link("link_3").unwrap().visual[0].shape else {
        panic!("no mesh")
    };
    assert_eq!(file, "package://seven_joints/link_3.stl");
    let last = robot.joint("a7").unwrap().limits.unwrap();
    assert_eq!((last.acceleration, last.jerk), (Some(10.0), Some(200.0)));
    assert_eq!(robot.joint("a6").unwrap().limits.unwrap().jerk, None);
    let colour = robot.link("link_1").unwrap().visual[0].colour;
    assert_eq!(colour, Some([1.0, 0.42, 0.1, 1.0]));
    assert_eq!(robot.link("link_0").unwrap().visual[0].colour, None);
}

#[test]
fn continuous_and_chained_mimic_joints_are_supported() {
    let text = r#"<robot name="cart">
        <joint name="last" type="prismatic"><parent link="b"/><child link="c"/><axis xyz="0 0 2"/>
          <limit upper="1" velocity="1" effort="0"/><mimic joint="middle" multiplier="2" offset="1"/></joint>
        <link name="c"/><link name="b"/><link name="a"/>
        <joint name="wheel" type="continuous"><parent link="root"/><child link="a"/></joint>
        <joint name="middle" type="continuous"><parent link="a"/><child link="b"/>
          <mimic joint="wheel" multiplier="-3" offset="0.5"/></joint>
        <link name="root"/><gazebo><plugin name="x"/></gazebo><transmission name="t"/>
      </robot>"#;
    let robot = Robot::parse(text, None).unwrap();
    let names: Vec<&str> = robot.links().iter().map(|link| link.name.as_str()).collect();
    assert_eq!(names, ["root", "a", "b", "c"]);
    for (i, joint) in robot.joints().iter().enumerate() {
        assert_eq!(joint.child, i + 1);
        assert!(joint.parent < joint.child);
        assert_eq!(robot.carrier(joint.child), Some(joint));
    }
    let wheel = robot.joint("wheel").unwrap();
    assert_eq!((wheel.kind, wheel.limits), (JointKind::Continuous, None));
    assert_eq!(wheel.axis.into_inner(), Vector3::x());
    let asked = std::cell::RefCell::new(Vec::new());
    let poses = robot.poses(|joint| {
        asked.borrow_mut().push(joint.name.clone());
        0.25
    });
    assert!(asked.borrow().iter().all(|name| name == "wheel"));
    // middle = −3 × 0.25 + 0.5 = −0.25 undoes the wheel; last = 2 × −0.25 + 1 = 0.5 up.
    assert!((poses[3].translation.vector - Vector3::new(0.0, 0.0, 0.5)).amax() < 1e-15);
    assert!(poses[3].rotation.angle() < 1e-15);
    let chain = robot.chain("c").unwrap();
    assert_eq!(chain.movable().count(), 1);
    assert!((chain.forward(&[0.25]).inverse() * poses[3]).translation.vector.amax() < 1e-15);
}
