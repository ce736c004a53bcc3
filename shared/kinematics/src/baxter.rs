//! The robot's numbers.
//!
//! Numbers from baxter_common 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015 Rethink Robotics.
//!
//! Lengths in metres, angles in radians. The chain of one arm, exactly, for any tool length `t`
//! past the hand:
//! `M · Tr(.055695,0,.011038) · Rz(s0) · Tr(.069,0,.27035) · Ry(s1+π/2) · Tr(0,0,.102) · Rz(e0) ·
//! Tr(.069,0,.26242) · Ry(e1) · Tr(0,0,.10359) · Rz(w0) · Tr(.010,0,.2707) · Ry(w1) ·
//! Tr(0,0,.115975) · Rz(w2) · Tr(0,0,.11355+t)` with `M = Tr(.024645, ±.219645, .118588) ·
//! Rz(±0.7854)`. The axis pairs s1/e0, e1/w0 and w1/w2 intersect; w0 misses the wrist point by
//! 10 mm, so the wrist is not spherical.

#![expect(clippy::approx_constant, reason = "the description rounds π/2 and π/4 and is followed")]

use std::sync::LazyLock;

use nalgebra::Vector3;

use crate::chain::{Axis, ZeroPosture};
use crate::limb::{Joints, Limb};
use crate::limits::{MotionLimits, PositionLimits};
use crate::robot::{Body, Parts, Robot};
use crate::shape::{Capsule, Cuboid};

/// Position of the left arm mount in `base`; the right one is mirrored.
pub const MOUNT_XYZ_M: [f64; 3] = [0.024645, 0.219645, 0.118588];
/// Yaw of the left arm mount. The description says 0.7854, not π/4: 2 µm apart at the hand.
pub const MOUNT_YAW_RAD: f64 = 0.7854;
/// Arm mount to the first joint's axis, in the mount's x and z.
pub const MOUNT_TO_S0_M: [f64; 2] = [0.055695, 0.011038];
/// First axis to the shoulder point (s1 and e0 axes), in x and z.
pub const S0_TO_S1_M: [f64; 2] = [0.069, 0.27035];
/// Shoulder point to the origin of e0's frame, along the upper arm.
pub const S1_TO_E0_M: f64 = 0.102;
/// Elbow point to the origin of w0's frame, along the forearm.
pub const E1_TO_W0_M: f64 = 0.10359;
/// Wrist point to the origin of w2's frame, along the last axis.
pub const W1_TO_W2_M: f64 = 0.115975;
/// Shoulder point to the elbow point (e1 and w0 axes), in x and z.
pub const SHOULDER_TO_ELBOW_M: [f64; 2] = [0.069, S1_TO_E0_M + 0.26242];
/// Elbow point to the wrist point (w1 and w2 axes), in x and z.
pub const ELBOW_TO_WRIST_M: [f64; 2] = [0.010, E1_TO_W0_M + 0.2707];
/// Wrist point to the hand along the last axis.
pub const WRIST_TO_HAND_M: f64 = W1_TO_W2_M + 0.11355;

/// Joint position limits of the robot description.
pub const POSITION_LIMITS_RAD: [(f64, f64); 7] = [
    (-1.70167993878, 1.70167993878),
    (-2.147, 1.047),
    (-3.05417993878, 3.05417993878),
    (-0.05, 2.618),
    (-3.059, 3.059),
    (-1.57079632679, 2.094),
    (-3.059, 3.059),
];

/// Joint velocity limits of the robot description, rad/s.
pub const VELOCITY_LIMITS_RAD_S: Joints = [1.5, 1.5, 1.5, 1.5, 4.0, 4.0, 4.0];

/// Joint acceleration limits, rad/s²: MoveIt's configuration, the only source that states any.
pub const ACCELERATION_LIMITS_RAD_S2: Joints = [2.0; 7];

/// Deceleration of a motion stop, rad/s²: every joint from its greatest velocity to rest in 0.1 s.
///
/// Above [`ACCELERATION_LIMITS_RAD_S2`] on purpose. Those are a planner's comfortable values; a
/// stop that kept them would take 0.75 s from full speed, and a person who says "stop" is owed
/// better.
pub const STOP_DECELERATION_RAD_S2: Joints = [15.0, 15.0, 15.0, 15.0, 40.0, 40.0, 40.0];

/// The SDK's default speed ratio.
pub const DEFAULT_SPEED_RATIO: f64 = 0.3;

/// Rate of joint commands and joint states, Hz.
pub const COMMAND_RATE_HZ: f64 = 100.0;

/// Height of the floor in `base`.
pub const FLOOR_Z_M: f64 = -0.9242;

/// `<limb>_hand` to `<limb>_gripper` along z, by what is mounted. All four share one frame name.
pub mod tool {
    /// Electric gripper with the extended narrow fingers: the official default.
    pub const ELECTRIC_EXTENDED_M: f64 = 0.1577;
    /// Electric gripper with standard fingers.
    pub const ELECTRIC_STANDARD_M: f64 = 0.1200;
    /// The frame of the description without a gripper.
    pub const PLAIN_M: f64 = 0.025;
    /// The hand itself.
    pub const NONE_M: f64 = 0.0;
}

/// Travel of one finger, metres; the gripper's stroke is twice that.
pub const FINGER_TRAVEL_M: f64 = 0.020833;

/// Arms half bent in front of the trunk: where the SDK's `move_to_neutral` goes.
pub const NEUTRAL: Joints = [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0];

const LEFT_UNTUCK: Joints = [-0.08, -1.0, -1.19, 1.94, 0.67, 1.03, -0.50];
const LEFT_TUCK: Joints = [-1.0, -2.07, 3.0, 2.55, 0.0, 0.01, 0.0];

/// The limb's posture after untucking.
pub fn untuck(limb: Limb) -> Joints {
    mirrored(limb, LEFT_UNTUCK)
}

/// The limb folded for transport. The enclosing capsules overlap the trunk here; the real robot
/// switches its own collision avoidance off to get there.
pub fn tuck(limb: Limb) -> Joints {
    mirrored(limb, LEFT_TUCK)
}

fn mirrored(limb: Limb, left: Joints) -> Joints {
    match limb {
        Limb::Left => left,
        Limb::Right => Limb::mirror(&left),
    }
}

/// A capsule that moves with a link.
struct Enclosure {
    /// 0 upper shoulder to 6 wrist; the hand moves with the wrist.
    link: usize,
    name: &'static str,
    radius: f64,
    /// The ends of the axis in the description's link frame.
    a: [f64; 3],
    b: [f64; 3],
}

#[rustfmt::skip]
const fn enclosure(
    link: usize,
    name: &'static str,
    radius: f64,
    a: [f64; 3],
    b: [f64; 3],
) -> Enclosure {
    Enclosure { link, name, radius, a, b }
}

/// The arm's capsules, shoulder first.
#[rustfmt::skip]
const CAPSULES: [Enclosure; 15] = [
    enclosure(0, "upper_shoulder", 0.1466, [0.0213, -0.0001, 0.1436], [0.0719, 0.0, 0.3118]),
    enclosure(1, "lower_shoulder", 0.0792, [0.0006, 0.0001, -0.0644], [0.1082, 0.0002, -0.0094]),
    enclosure(1, "lower_shoulder", 0.0771, [0.1013, 0.0, 0.0307], [-0.0019, 0.0001, 0.0649]),
    enclosure(2, "upper_elbow", 0.0931, [0.0001, 0.0, 0.0701], [-0.0051, -0.0005, 0.1802]),
    enclosure(2, "upper_elbow", 0.0880, [-0.0246, 0.0002, 0.2403], [0.0516, 0.0003, 0.2539]),
    enclosure(3, "lower_elbow", 0.0739, [0.0002, 0.0007, -0.0599], [0.0614, -0.0018, -0.0333]),
    enclosure(3, "lower_elbow", 0.0733, [0.0, 0.0, 0.0598], [0.0707, 0.0, 0.0007]),
    enclosure(4, "upper_forearm", 0.0786, [-0.0115, -0.0001, 0.1602], [0.0, -0.0002, 0.023]),
    enclosure(4, "upper_forearm", 0.0555, [0.0017, -0.0089, 0.2574], [0.011, -0.0072, 0.272]),
    enclosure(5, "lower_forearm", 0.0752, [0.0035, -0.001, -0.0321], [0.0013, -0.0009, 0.0322]),
    enclosure(5, "lower_forearm", 0.0841, [0.107, -0.0006, 0.0002], [0.0806, -0.0005, 0.0015]),
    enclosure(6, "wrist", 0.0579, [-0.0001, 0.0, 0.067], [0.0175, -0.0007, 0.0958]),
    enclosure(6, "hand", 0.045, [0.0, 0.0, -0.03], [0.0, 0.0, 0.0]),
    enclosure(6, "hand", 0.060, [0.0, 0.0, 0.015], [0.0, 0.0, 0.075]),
    enclosure(6, "hand", 0.045, [0.0, 0.0, 0.075], [0.0, 0.0, 0.115]),
];

/// Torso and pedestal as boxes in `base`.
const TRUNK: [(&str, Cuboid); 7] = [
    ("torso", Cuboid::aligned([-0.008, 0.0, -0.0315], [0.38, 0.41, 0.06])),
    ("torso", Cuboid::aligned([-0.009, 0.0, 0.1185], [0.418, 0.672, 0.24])),
    ("torso", Cuboid::aligned([-0.0475, 0.0, 0.4185], [0.341, 0.452, 0.36])),
    ("torso", Cuboid::aligned([-0.1115, 0.0, 0.6285], [0.145, 0.112, 0.06])),
    ("torso", Cuboid::aligned([-0.006, 0.0, 0.767], [0.296, 0.164, 0.217])),
    ("pedestal", Cuboid::aligned([-0.0425, 0.0, -0.7672], [0.919, 0.832, 0.314])),
    ("pedestal", Cuboid::aligned([0.0, 0.0, -0.3359], [0.324, 0.322, 0.5487])),
];

/// The head, wherever it looks, as two balls in `base`.
const HEAD: [[f64; 3]; 2] = [[0.04, -0.04, 0.75], [0.04, 0.04, 0.75]];
const HEAD_RADIUS_M: f64 = 0.22;

/// The built-in robot.
pub fn robot() -> &'static Robot {
    static ROBOT: LazyLock<Robot> = LazyLock::new(|| {
        let cuboids = TRUNK.to_vec();
        let head = HEAD.map(|at| {
            let at = Vector3::from(at);
            ("head", Capsule { a: at, b: at, radius: HEAD_RADIUS_M })
        });
        Robot::new(parts(Limb::Left), parts(Limb::Right), Body { cuboids, capsules: head.into() })
    });
    &ROBOT
}

pub(crate) fn parts(limb: Limb) -> Parts {
    let links = crate::links::links(limb, &[0.0; 7], 0.0);
    let at = |name: &str| {
        let name = format!("{limb}_{name}");
        links.iter().find(|(link, _)| *link == name).map(|(_, pose)| *pose).unwrap_or_default()
    };
    let moved = MOVED.map(at);
    let posture = ZeroPosture {
        axes: moved.map(|pose| Axis {
            point: pose.translation.vector,
            direction: pose.rotation * Vector3::z(),
        }),
        tool: at("gripper"),
    };
    let capsules = CAPSULES.iter().map(|c| {
        let pose = if c.name == "hand" { at("hand") } else { moved[c.link] };
        let end = |p: [f64; 3]| (pose * nalgebra::Point3::from(p)).coords;
        (c.link, c.name, Capsule { a: end(c.a), b: end(c.b), radius: c.radius })
    });
    Parts {
        posture,
        limits: MotionLimits::new(
            PositionLimits(POSITION_LIMITS_RAD),
            VELOCITY_LIMITS_RAD_S,
            ACCELERATION_LIMITS_RAD_S2,
            [20.0; 7],
        ),
        neutral: NEUTRAL,
        stations: vec![NEUTRAL, untuck(limb)],
        capsules: capsules.collect(),
        may_touch: Vec::new(),
    }
}

const MOVED: [&str; 7] = [
    "upper_shoulder",
    "lower_shoulder",
    "upper_elbow",
    "lower_elbow",
    "upper_forearm",
    "lower_forearm",
    "wrist",
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::fixture;

    fn facts() -> toml::Table {
        fixture("baxter_facts.toml").parse().unwrap()
    }

    fn numbers<const N: usize>(value: &toml::Value) -> [f64; N] {
        let all: Vec<f64> = value.clone().try_into().unwrap();
        all.try_into().unwrap()
    }

    #[test]
    fn limits_and_poses_are_the_facts() {
        let facts = facts();
        let joints = facts["joint"].as_array().unwrap();
        for (i, joint) in crate::JOINTS.iter().enumerate() {
            for limb in Limb::BOTH {
                let name = format!("{limb}_{joint}");
                let fact = joints.iter().find(|j| j["name"].as_str() == Some(&name)).unwrap();
                let of = |key: &str| fact[key].as_float().unwrap();
                assert_eq!((of("lower"), of("upper")), POSITION_LIMITS_RAD[i], "{name}");
                assert_eq!(of("velocity"), VELOCITY_LIMITS_RAD_S[i], "{name}");
            }
        }
        assert_eq!(numbers(&facts["acceleration_limits"]["moveit"]), ACCELERATION_LIMITS_RAD_S2);
        let poses = &facts["poses"];
        assert_eq!(numbers(&poses["neutral"]), NEUTRAL);
        assert_eq!(numbers(&poses["left_untuck"]), untuck(Limb::Left));
        assert_eq!(numbers(&poses["right_untuck"]), untuck(Limb::Right));
        assert_eq!(numbers(&poses["left_tuck"]), tuck(Limb::Left));
        assert_eq!(numbers(&poses["right_tuck"]), tuck(Limb::Right));
    }

    #[test]
    fn lengths_are_the_facts() {
        let facts = facts();
        let chain = &facts["chain"];
        let of = |key: &str| chain[key].as_float().unwrap();
        let a: [f64; 7] = numbers(&chain["a"]);
        assert_eq!(
            [S0_TO_S1_M[0], SHOULDER_TO_ELBOW_M[0], ELBOW_TO_WRIST_M[0]],
            [a[0], a[2], a[4]]
        );
        assert_eq!(S0_TO_S1_M[1], of("d_s0_s1"));
        assert!((SHOULDER_TO_ELBOW_M[1] - of("d_shoulder_elbow")).abs() < 1e-15);
        assert!((ELBOW_TO_WRIST_M[1] - of("d_elbow_wrist")).abs() < 1e-15);
        assert!((WRIST_TO_HAND_M - of("d_wrist_hand")).abs() < 1e-15);
        assert_eq!(MOUNT_YAW_RAD, of("mount_yaw_left"));
        let tools = &facts["tool_frames"];
        let tool_of = |key: &str| tools[key].as_float().unwrap();
        assert_eq!(tool::ELECTRIC_EXTENDED_M, tool_of("electric_extended_gripper"));
        assert_eq!(tool::ELECTRIC_STANDARD_M, tool_of("electric_standard_gripper"));
        assert_eq!(tool::PLAIN_M, tool_of("plain_urdf_gripper"));
        let travel = facts["electric_gripper"]["travel_per_finger"].as_float().unwrap();
        assert_eq!(FINGER_TRAVEL_M, travel);
        assert_eq!(
            DEFAULT_SPEED_RATIO,
            facts["velocity_limits"]["sdk_default_speed_ratio"].as_float().unwrap()
        );
        assert_eq!(COMMAND_RATE_HZ, facts["sdk"]["command_rate_hz"].as_float().unwrap());
        assert_eq!(FLOOR_Z_M, facts["workspace"]["floor_z"].as_float().unwrap());
    }
}
