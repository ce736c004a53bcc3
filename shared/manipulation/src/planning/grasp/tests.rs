use super::*;
use crate::kinematics::limb::Limb;
use crate::robot::Robot;
use crate::samples::Random;

fn paddles() -> Gripper {
    Robot::baxter().arm(Limb::Left).gripper
}

const BOWL: ObjectPose = ObjectPose {
    xyz_m: [0.7, 0.2, -0.12],
    yaw_rad: 0.0,
    size_m: [0.18, 0.18, 0.07],
    grasp_width_m: 0.006,
    mass_kg: None,
    wall_rad: 0.0,
    hollow: true,
};

const MARKER: ObjectPose = ObjectPose {
    xyz_m: [0.68, -0.15, -0.148],
    yaw_rad: 0.3,
    size_m: [0.14, 0.014, 0.014],
    grasp_width_m: 0.014,
    mass_kg: None,
    wall_rad: 0.0,
    hollow: false,
};

fn axes(grasp: &Grasp) -> (Vector3<f64>, Vector3<f64>) {
    (grasp.gripper.rotation * Vector3::y(), grasp.gripper.rotation * Vector3::z())
}

#[test]
fn a_bowl_is_held_at_its_rim() {
    let grasps = BOWL.grasps(&paddles()).unwrap();
    assert_eq!(grasps.len(), 24);
    for grasp in &grasps {
        let (fingers, down) = axes(grasp);
        assert!((down + Vector3::z()).norm() < 1e-9);
        let out = grasp.gripper.translation.vector - Vector3::from(BOWL.xyz_m);
        let radial = Vector3::new(out.x, out.y, 0.0);
        assert!((radial.norm() - 0.087).abs() < 1e-9, "on the wall's middle");
        assert!((fingers.dot(&radial.normalize()).abs() - 1.0).abs() < 1e-9, "across the wall");
        assert!((grasp.gripper.translation.z - (BOWL.top_z_m() - DEPTH_M)).abs() < 1e-12);
    }
}

#[test]
fn a_marker_is_held_across_its_middle() {
    let grasps = MARKER.grasps(&paddles()).unwrap();
    assert_eq!(grasps.len(), 2);
    for grasp in &grasps {
        let (fingers, _) = axes(grasp);
        let along = Vector3::new(0.3f64.cos(), 0.3f64.sin(), 0.0);
        assert!(fingers.dot(&along).abs() < 1e-9);
        let at = grasp.gripper.translation.vector;
        assert!((at - Vector3::from(MARKER.xyz_m)).norm() < 1e-12);
    }
}

#[test]
fn fingertips_stay_above_what_the_object_stands_on() {
    let mut random = Random::seeded(61);
    for _ in 0..200 {
        let object = ObjectPose {
            xyz_m: std::array::from_fn(|_| random.between(-0.5, 0.9)),
            yaw_rad: random.between(-3.0, 3.0),
            size_m: std::array::from_fn(|_| random.between(0.002, 0.3)),
            grasp_width_m: random.between(0.002, 0.0375),
            mass_kg: None,
            wall_rad: 0.0,
            hollow: true,
        };
        for grasp in object.grasps(&paddles()).unwrap() {
            let z = grasp.gripper.translation.z;
            assert!(
                z >= object.bottom_z_m() + paddles().beyond_m + TIP_CLEAR_M - 1e-12,
                "{object:?}"
            );
            let raised = grasp.raised(0.2).translation.vector;
            assert!((raised.z - z - 0.2).abs() < 1e-12);
        }
    }
}

#[test]
fn a_long_box_is_held_at_the_middles_of_its_sides() {
    let object = ObjectPose { size_m: [0.3, 0.1, 0.05], yaw_rad: 1.0, ..BOWL };
    let grasps = object.grasps(&paddles()).unwrap();
    assert_eq!(grasps.len(), 8);
    let mut radii: Vec<f64> = grasps
        .iter()
        .map(|grasp| (grasp.gripper.translation.vector - Vector3::from(object.xyz_m)).xy().norm())
        .collect();
    radii.sort_by(f64::total_cmp);
    assert!((radii[0] - 0.047).abs() < 1e-9 && (radii[7] - 0.147).abs() < 1e-9, "{radii:?}");
}

#[test]
fn grasp_rejects_what_cannot_be_held() {
    let wide = ObjectPose { grasp_width_m: 0.05, ..BOWL };
    let error = wide.grasps(&paddles()).unwrap_err();
    assert_eq!(error, GraspError::TooWide { width_m: 0.05, open_m: paddles().open_m });
    assert!(error.to_string().contains("50 mm") && error.to_string().contains("38 mm"));
    let wrench = ObjectPose { size_m: [0.24, 0.036, 0.012], grasp_width_m: 0.016, ..MARKER };
    assert!(wrench.grasps(&paddles()).is_ok());
    let half_round = Robot::baxter().arm(Limb::Right).gripper;
    let error = wrench.grasps(&half_round).unwrap_err();
    assert_eq!(error, GraspError::NoRim { extent_m: 0.036, open_m: half_round.open_m });
    assert!(error.to_string().contains("36 mm wide between the fingers, which open 34 mm"));
    assert!(ObjectPose { hollow: true, ..wrench }.grasps(&half_round).is_ok());
    let slot_2 = Gripper { stop_m: 0.0153, open_m: 0.057, ..paddles() };
    let error = BOWL.grasps(&slot_2).unwrap_err();
    assert!(matches!(error, GraspError::TooThin { width_m: 0.006, .. }));
    assert!(error.to_string().contains("6.0 mm but holds 17.4 mm"), "{error}");
    for (object, what) in [
        (ObjectPose { xyz_m: [f64::NAN, 0.0, 0.0], ..BOWL }, "xyz"),
        (ObjectPose { yaw_rad: f64::INFINITY, ..BOWL }, "yaw"),
        (ObjectPose { size_m: [0.1, 0.0, 0.1], ..BOWL }, "size"),
        (ObjectPose { grasp_width_m: -0.001, ..BOWL }, "grasp_width"),
    ] {
        assert!(object.grasps(&paddles()).unwrap_err().to_string().contains(what));
    }
}

#[test]
fn a_sloped_wall_is_gripped_along_its_slope() {
    let sloped = ObjectPose { wall_rad: 0.3, ..BOWL };
    for grasp in &sloped.grasps(&paddles()).unwrap() {
        let (fingers, down) = axes(grasp);
        let at = grasp.gripper.translation.vector;
        let out = (at - Vector3::from(BOWL.xyz_m)).xy().normalize();
        // The wall's middle at any height, by its slope from the rim.
        let wall = |z: f64| {
            let below = BOWL.top_z_m() - z;
            let radius = 0.09 - 0.003 / 0.3f64.cos() - below * 0.3f64.tan();
            Vector3::new(BOWL.xyz_m[0] + out.x * radius, BOWL.xyz_m[1] + out.y * radius, z)
        };
        assert!((wall(at.z) - at).norm() < 1e-9);
        let along = (wall(at.z - 0.01) - at).normalize();
        assert!((along - down).norm() < 1e-9 && fingers.dot(&along).abs() < 1e-9);
        // The fingers come along the wall as well.
        let raised = grasp.raised(0.1).translation.vector - at;
        assert!((raised.z - 0.1).abs() < 1e-12 && (raised.normalize() + down).norm() < 1e-9);
    }
}

#[test]
fn an_object_is_refused_if_the_fingers_cannot_carry_its_weight() {
    let weighing = |mass_kg| ObjectPose { mass_kg: Some(mass_kg), ..BOWL };
    // Measured in a physics engine at 20 N: 0.5 kg is held, 0.7 kg falls.
    assert!(weighing(0.5).grasps(&paddles()).is_ok());
    let error = weighing(0.7).grasps(&paddles()).unwrap_err().to_string();
    assert!(error.contains("weighs 0.70 kg") && error.contains("20 N hold 0.55 kg"), "{error}");
    let weak = Gripper { force_n: 10.5, ..paddles() };
    assert!(weighing(0.3).grasps(&weak).is_err(), "the SDK's holding force");
    assert!(ObjectPose { mass_kg: Some(0.3), ..MARKER }.grasps(&weak).is_ok());
}
