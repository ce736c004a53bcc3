//! The message types of a Baxter's interface that the bridge speaks.
//!
//! Names, fields, constants and checksums are facts of std_msgs, geometry_msgs, sensor_msgs,
//! trajectory_msgs and of baxter_common 1.2.0 (BSD-3-Clause, Copyright (c) 2013-2015 Rethink Robotics).
//! The messages of detectors are in a file of their own.

use ros::message;
use ros::wire::{Message, RosDuration, RosTime};

mod detectors;

pub use detectors::*;
pub use ros::geometry::{BoundingBox3D, Point, Pose, PoseWithCovariance, Quaternion, Vector3};

message! {
    /// Stamp and frame of a message.
    Header = "std_msgs/Header" "2176decaecbce78abc3b96ef049fabed" {
        seq: u32,
        stamp: RosTime,
        frame_id: String,
    }
}
message! {
    /// A number.
    Float64 = "std_msgs/Float64" "fdb28210bfa9d7c91146260178d9a584" { data: f64 }
}
message! {
    /// Velocity, m/s and rad/s.
    Twist = "geometry_msgs/Twist" "9f195f881246fdfa2798d1d3eebca84a" {
        linear: Vector3,
        angular: Vector3,
    }
}
message! {
    /// Force and torque, N and Nm.
    Wrench = "geometry_msgs/Wrench" "4f539cf138b23283b520fd271b567936" {
        force: Vector3,
        torque: Vector3,
    }
}
message! {
    /// Measured joints.
    JointState = "sensor_msgs/JointState" "3066dcd76a6cfaef579bd0f34173e9fd" {
        header: Header,
        name: Vec<String>,
        position: Vec<f64>,
        velocity: Vec<f64>,
        effort: Vec<f64>,
    }
}
message! {
    /// A point of a motion.
    JointTrajectoryPoint = "trajectory_msgs/JointTrajectoryPoint" "f3cd1e1c4d320c79d6985c904ae5dcd3" {
        positions: Vec<f64>,
        velocities: Vec<f64>,
        accelerations: Vec<f64>,
        effort: Vec<f64>,
        time_from_start: RosDuration,
    }
}
message! {
    /// A command to the joints of a limb.
    JointCommand = "baxter_core_msgs/JointCommand" "19bfec8434dd568ab3c633d187c36f2e"
        "int32 POSITION_MODE=1
        int32 VELOCITY_MODE=2
        int32 TORQUE_MODE=3
        int32 RAW_POSITION_MODE=4" {
        mode: i32,
        command: Vec<f64>,
        names: Vec<String>,
    }
}
message! {
    /// State of a limb's tip.
    EndpointState = "baxter_core_msgs/EndpointState" "44bea01d596ff699fa1447bec34167ac" {
        header: Header,
        pose: Pose,
        twist: Twist,
        wrench: Wrench,
    }
}
message! {
    /// State of the robot as a whole.
    AssemblyState = "baxter_core_msgs/AssemblyState" "356d9dd237ce73b2667da9235f541933"
        "uint8 ESTOP_BUTTON_UNPRESSED=0
        uint8 ESTOP_BUTTON_PRESSED=1
        uint8 ESTOP_BUTTON_UNKNOWN=2
        uint8 ESTOP_BUTTON_RELEASED=3
        uint8 ESTOP_SOURCE_NONE=0
        uint8 ESTOP_SOURCE_USER=1
        uint8 ESTOP_SOURCE_UNKNOWN=2
        uint8 ESTOP_SOURCE_FAULT=3
        uint8 ESTOP_SOURCE_BRAIN=4" {
        ready: bool,
        enabled: bool,
        stopped: bool,
        error: bool,
        estop_button: u8,
        estop_source: u8,
    }
}
message! {
    /// State of a gripper.
    EndEffectorState = "baxter_core_msgs/EndEffectorState" "ade777f069d738595bc19e246b8ec7a0"
        "uint8 STATE_FALSE=0
        uint8 STATE_TRUE=1
        uint8 STATE_UNKNOWN=2
        float32 POSITION_CLOSED=0.0
        float32 POSITION_OPEN=100.0
        float32 FORCE_MIN=0.0
        float32 FORCE_MAX=100.0" {
        timestamp: RosTime,
        id: u32,
        enabled: u8,
        calibrated: u8,
        ready: u8,
        moving: u8,
        gripping: u8,
        missed: u8,
        error: u8,
        reverse: u8,
        position: f32,
        force: f32,
        state: String,
        command: String,
        command_sender: String,
        command_sequence: u32,
    }
}
message! {
    /// A command to a gripper.
    EndEffectorCommand = "baxter_core_msgs/EndEffectorCommand" "c003234e90416f2ca02ac7837c42cbb7"
        "string CMD_NO_OP=no_op
        string CMD_SET=set
        string CMD_CONFIGURE=configure
        string CMD_REBOOT=reboot
        string CMD_RESET=reset
        string CMD_CALIBRATE=calibrate
        string CMD_CLEAR_CALIBRATION=clear_calibration
        string CMD_PREPARE_TO_GRIP=prepare_to_grip
        string CMD_GRIP=grip
        string CMD_RELEASE=release
        string CMD_GO=go
        string CMD_STOP=stop" {
        id: u32,
        command: String,
        args: String,
        sender: String,
        sequence: u32,
    }
}
message! {
    /// What is mounted as a gripper.
    EndEffectorProperties = "baxter_core_msgs/EndEffectorProperties" "21b83773ab9a35216d11e427573c76cc"
        "uint8 NO_GRIPPER=0
        uint8 SUCTION_CUP_GRIPPER=1
        uint8 ELECTRIC_GRIPPER=2
        uint8 PASSIVE_GRIPPER=3" {
        id: u32,
        ui_type: u8,
        manufacturer: String,
        product: String,
        serial_number: String,
        hardware_rev: String,
        firmware_rev: String,
        firmware_date: String,
        has_calibration: bool,
        controls_grip: bool,
        senses_grip: bool,
        reverses_grip: bool,
        controls_force: bool,
        senses_force: bool,
        controls_position: bool,
        senses_position: bool,
        properties: String,
    }
}

/// Returns name, checksum and definition of every message that Debian has no package for, nested ones
/// first.
pub fn without_a_package() -> Vec<(&'static str, &'static str, String)> {
    fn one<M: Message>() -> (&'static str, &'static str, String) {
        (M::NAME, M::MD5, M::definition())
    }
    vec![
        one::<JointCommand>(),
        one::<EndpointState>(),
        one::<AssemblyState>(),
        one::<EndEffectorState>(),
        one::<EndEffectorCommand>(),
        one::<EndEffectorProperties>(),
        one::<BoundingBox3D>(),
        one::<ObjectHypothesisWithPose>(),
        one::<Detection3D>(),
        one::<Detection3DArray>(),
        one::<AprilTagDetection>(),
        one::<AprilTagDetectionArray>(),
        one::<AlvarMarker>(),
        one::<AlvarMarkers>(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_round_trip_and_leave_no_byte_over() {
        let state = JointState {
            header: Header {
                seq: 7,
                stamp: RosTime { secs: 3, nsecs: 9 },
                frame_id: "base".into(),
            },
            name: vec!["left_s0".into(), "ß".into()],
            position: vec![0.5, f64::NAN],
            velocity: vec![-1.0],
            effort: Vec::new(),
        };
        let frame = state.to_frame();
        assert_eq!(frame[..4], ((frame.len() - 4) as u32).to_le_bytes());
        let read = JointState::from_bytes(&frame[4..]).unwrap();
        assert_eq!((&read.header, &read.name), (&state.header, &state.name));
        assert!(read.position[1].is_nan() && read.effort.is_empty());
        for end in 4..frame.len() {
            assert!(JointState::from_bytes(&frame[4..end]).is_err(), "cut at {end}");
        }
        let longer = [&frame[4..], &[0]].concat();
        assert!(JointState::from_bytes(&longer).unwrap_err().0.contains("1 bytes left over"));
    }

    #[test]
    fn list_length_that_lies_is_rejected() {
        let bytes = [u32::MAX.to_le_bytes().as_slice(), &[0; 32]].concat();
        assert!(JointTrajectoryPoint::from_bytes(&bytes).is_err());
    }

    #[test]
    fn full_definition_contains_each_nested_definition_once() {
        let text = EndpointState::full_definition();
        for name in ["std_msgs/Header", "geometry_msgs/Point", "geometry_msgs/Vector3"] {
            assert_eq!(text.matches(&format!("MSG: {name}\n")).count(), 1, "{name} in {text}");
        }
        assert!(text.starts_with("std_msgs/Header header\ngeometry_msgs/Pose pose\n"), "{text}");
        assert!(JointCommand::definition().starts_with("int32 POSITION_MODE=1\nint32 VELOCITY"));
    }

    #[test]
    fn negative_durations_round_down() {
        assert_eq!(RosDuration::from_s(-0.25), RosDuration { secs: -1, nsecs: 750_000_000 });
        assert_eq!(RosDuration::from_s(2.5), RosDuration { secs: 2, nsecs: 500_000_000 });
    }
}
