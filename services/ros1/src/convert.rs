//! Messages of ROS as those of the group and back, field by field.
//!
//! What does not fit is dropped as a whole and never cut off. Numbers are not judged here: the arm does
//! that for all that it is told.

use crate::types as ros;
use ::ros::wire::{RosDuration, Unreadable};
use messages::robot::{
    AssemblyState, EndEffectorCommand, EndEffectorProperties, EndEffectorState, EndpointState,
    JointCommand, JointMode, JointState, JointTrajectoryPoint, Measurement, SpeedRatio,
};
use messages::{Code, FixedText};
use service::Time;

/// Converts measured joints. A publisher may leave out velocities or efforts; they count as zero.
///
/// # Errors
/// More joints or longer names than the group's message holds, or lists of different lengths.
pub fn joint_state(state: &ros::JointState, made: Time) -> Result<JointState, Unreadable> {
    let count = state.name.len();
    let lists = [&state.position, &state.velocity, &state.effort];
    if let Some(list) = lists.iter().find(|list| !list.is_empty() && list.len() != count) {
        return Err(Unreadable(format!("joint state of {count} names and {} values", list.len())));
    }
    let value = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
    let joints: Vec<(&str, Measurement)> =
        (0..count).map(|i| (state.name[i].as_str(), lists.map(|list| value(list, i)))).collect();
    Ok(JointState::new(made.ns(), &joints)?)
}

/// Converts the state of the robot as a whole.
pub fn assembly_state(state: &ros::AssemblyState) -> AssemblyState {
    AssemblyState {
        ready: state.ready.into(),
        enabled: state.enabled.into(),
        stopped: state.stopped.into(),
        error: state.error.into(),
        estop_button: Code::from_raw(state.estop_button),
        estop_source: state.estop_source,
        ..AssemblyState::default()
    }
}

/// Converts the state of a limb's tip.
pub fn endpoint_state(state: &ros::EndpointState, made: Time) -> EndpointState {
    let ros::Pose { position: p, orientation: q } = &state.pose;
    let both = |a: &ros::Vector3, b: &ros::Vector3| [a.x, a.y, a.z, b.x, b.y, b.z];
    EndpointState {
        stamp_ns: made.ns(),
        pose: [p.x, p.y, p.z, q.x, q.y, q.z, q.w],
        twist: both(&state.twist.linear, &state.twist.angular),
        wrench: both(&state.wrench.force, &state.wrench.torque),
    }
}

/// Converts the state of a gripper. A command or sender of another program that is too long is left
/// out: it only confirms that program's commands.
pub fn gripper_state(state: &ros::EndEffectorState, made: Time) -> EndEffectorState {
    EndEffectorState {
        timestamp_ns: made.ns(),
        id: state.id,
        enabled: Code::from_raw(state.enabled),
        calibrated: Code::from_raw(state.calibrated),
        ready: Code::from_raw(state.ready),
        moving: Code::from_raw(state.moving),
        gripping: Code::from_raw(state.gripping),
        missed: Code::from_raw(state.missed),
        error: Code::from_raw(state.error),
        reverse: Code::from_raw(state.reverse),
        position: state.position,
        force: state.force,
        command_sequence: state.command_sequence,
        command: FixedText::new(&state.command).unwrap_or_default(),
        command_sender: FixedText::new(&state.command_sender).unwrap_or_default(),
    }
}

/// Converts the properties of a gripper. Its texts are for people.
pub fn gripper_properties(own: &ros::EndEffectorProperties) -> EndEffectorProperties {
    EndEffectorProperties {
        id: own.id,
        ui_type: Code::from_raw(own.ui_type),
        has_calibration: own.has_calibration.into(),
        controls_grip: own.controls_grip.into(),
        senses_grip: own.senses_grip.into(),
        reverses_grip: own.reverses_grip.into(),
        controls_force: own.controls_force.into(),
        senses_force: own.senses_force.into(),
        controls_position: own.controls_position.into(),
        senses_position: own.senses_position.into(),
        manufacturer: FixedText::truncated(&own.manufacturer),
        product: FixedText::truncated(&own.product),
        serial_number: FixedText::truncated(&own.serial_number),
        ..EndEffectorProperties::default()
    }
}

/// Converts a command to the joints of a limb.
///
/// # Errors
/// A mode that is never used here, a value that is not a number, or an invalid message.
pub fn joint_command(command: &JointCommand) -> Result<ros::JointCommand, Unreadable> {
    let mode = JointMode::from_code(command.mode)?.code();
    let joints = command.joints()?;
    if let Some((name, value)) = joints.iter().find(|(_, value)| !value.is_finite()) {
        return Err(Unreadable(format!("command {value} for joint {name}")));
    }
    let (names, values) = joints.into_iter().map(|(name, value)| (name.to_owned(), value)).unzip();
    Ok(ros::JointCommand { mode, command: values, names })
}

/// Converts a point of a motion.
pub fn trajectory_point(point: &JointTrajectoryPoint) -> ros::JointTrajectoryPoint {
    ros::JointTrajectoryPoint {
        positions: point.positions.into(),
        velocities: point.velocities.into(),
        accelerations: point.accelerations.into(),
        effort: Vec::new(),
        time_from_start: RosDuration::from_s(point.time_from_start_s),
    }
}

/// Converts a speed ratio.
pub fn speed_ratio(ratio: &SpeedRatio) -> ros::Float64 {
    ros::Float64 { data: ratio.data }
}

/// Converts a command to a gripper.
///
/// # Errors
/// Bytes that are not text.
pub fn gripper_command(
    command: &EndEffectorCommand,
) -> Result<ros::EndEffectorCommand, Unreadable> {
    Ok(ros::EndEffectorCommand {
        id: command.id,
        command: command.command.as_str()?.to_owned(),
        args: command.args.as_str()?.to_owned(),
        sender: command.sender.as_str()?.to_owned(),
        sequence: command.sequence,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::robot::Command;

    fn joints(names: usize, positions: usize) -> ros::JointState {
        let name = (0..names).map(|i| format!("joint_{i}")).collect();
        let position = vec![0.5; positions];
        ros::JointState { name, position, ..ros::JointState::default() }
    }

    #[test]
    fn joint_state_is_copied_or_dropped_and_never_cut() {
        let state = joint_state(&joints(17, 17), Time(5)).unwrap();
        assert_eq!((state.stamp_ns, state.len), (5, 17));
        assert_eq!(state.joints().unwrap()[16], ("joint_16", [0.5, 0.0, 0.0]));
        assert!(joint_state(&joints(18, 18), Time(5)).is_err());
        assert!(joint_state(&joints(3, 2), Time(5)).is_err());
        let long = ros::JointState { name: vec!["x".repeat(29)], ..joints(0, 1) };
        assert!(joint_state(&long, Time(5)).is_err());
    }

    #[test]
    fn measured_nan_is_passed_on_and_commanded_nan_is_not() {
        let state = ros::JointState { position: vec![f64::NAN], ..joints(1, 0) };
        assert!(joint_state(&state, Time(0)).unwrap().position[0].is_nan());
        let position =
            |value| JointCommand::new(JointMode::Position, &[("left_s0", value)]).unwrap();
        assert_eq!(joint_command(&position(0.5)).unwrap().command, [0.5]);
        assert!(joint_command(&position(f64::NAN)).is_err());
        let raw = JointCommand { mode: 4, ..position(0.5) };
        assert!(joint_command(&raw).is_err(), "raw position mode is never used");
    }

    #[test]
    fn gripper_commands_are_confirmed_by_sender_and_sequence() {
        let command = EndEffectorCommand::new(3, Command::Go(50.0), "whichone", 7);
        let sent = gripper_command(&command).unwrap();
        assert_eq!((sent.command.as_str(), sent.args.as_str()), ("go", "{\"position\": 50.000}"));
        let state = |sender: &str| {
            let command_sender = sender.to_owned();
            let state =
                ros::EndEffectorState { command_sender, command_sequence: 7, ..Default::default() };
            gripper_state(&state, Time(9))
        };
        assert!(state(&sent.sender).has_handled(&command));
        // The SDK's programs sign with long names.
        assert!(
            !state(&"/rsdk_gripper_action_server_left_1416347".repeat(2)).has_handled(&command)
        );
    }
}
