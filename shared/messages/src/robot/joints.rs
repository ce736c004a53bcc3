//! Joints: commands to a limb, and measurements.

use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::WireError;
use iceoryx2::prelude::ZeroCopySend;

/// Joints of a limb.
pub const LIMB_JOINTS: usize = 7;
/// Most joints in one joint state: 7 a limb, head pan and nod, torso.
pub const JOINTS_MAX: usize = 17;

/// Control mode of a joint command. Baxter also knows 3, torque, and 4, raw position, which
/// bypasses its collision avoidance; neither is ever used here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointMode {
    /// `POSITION_MODE`, radians.
    Position,
    /// `VELOCITY_MODE`, rad/s.
    Velocity,
}

impl JointMode {
    /// The number in [`JointCommand::mode`].
    pub const fn code(self) -> i32 {
        match self {
            Self::Position => 1,
            Self::Velocity => 2,
        }
    }

    /// The meaning of a number.
    ///
    /// # Errors
    /// A mode that is not used here.
    pub const fn from_code(code: i32) -> Result<Self, WireError> {
        match code {
            1 => Ok(Self::Position),
            2 => Ok(Self::Velocity),
            _ => Err(WireError::new("joint command mode", code.unsigned_abs())),
        }
    }
}

wire_struct! {
    /// `baxter_core_msgs/JointCommand`: what the joints of one limb are to do now. A limb that has
    /// heard none for 0.2 s (`joint_command_timeout`) goes back to holding its position.
    JointCommand = "JointCommand" {
        /// [`JointMode`].
        mode: i32,
        /// Number of used entries below.
        len: u32,
        /// Radians or rad/s, after the mode.
        command: [f64; LIMB_JOINTS],
        /// The joints' names, in the order of `command`.
        names: [FixedText<28>; LIMB_JOINTS],
    }
}

wire_struct! {
    /// `sensor_msgs/JointState`: what was measured, by name. Baxter sends its 17 joints in
    /// alphabetical order, and the joint of an electric gripper's finger in messages of their own,
    /// so readers look for names and never for places.
    JointState = "JointState" {
        /// `header.stamp`, monotonic clock.
        stamp_ns: u64,
        /// Number of used entries below.
        len: u32,
        /// Zero.
        reserved: u32,
        /// The joints' names.
        name: [FixedText<28>; JOINTS_MAX],
        /// Positions, radians; metres for a finger.
        position: [f64; JOINTS_MAX],
        /// Velocities, rad/s; m/s for a finger.
        velocity: [f64; JOINTS_MAX],
        /// Torques, newton metres; newtons for a finger.
        effort: [f64; JOINTS_MAX],
    }
}

wire_struct! {
    /// `trajectory_msgs/JointTrajectoryPoint` on `inverse_dynamics_command`: where the commanded
    /// motion is, how fast, and how it accelerates, joints in the order s0, s1, e0, e1, w0, w1,
    /// w2. Feed-forward: the robot computes the torques that this takes and lags less.
    JointTrajectoryPoint = "JointTrajectoryPoint" {
        /// Radians.
        positions: [f64; LIMB_JOINTS],
        /// rad/s.
        velocities: [f64; LIMB_JOINTS],
        /// rad/s².
        accelerations: [f64; LIMB_JOINTS],
        /// Seconds since the motion began.
        time_from_start_s: f64,
    }
}

wire_struct! {
    /// `std_msgs/Float64` on `set_speed_ratio`: the share of its greatest velocity that a limb may
    /// use in position mode; 0.3 until the first message.
    SpeedRatio = "SpeedRatio" {
        /// 0 to 1.
        data: f64,
    }
}

wire_struct! {
    /// `baxter_core_msgs/EndpointState`: the tip of `<limb>_gripper`.
    EndpointState = "EndpointState" {
        /// `header.stamp`, monotonic clock.
        stamp_ns: u64,
        /// Position in `base`, metres, and orientation, quaternion x, y, z, w.
        pose: [f64; 7],
        /// Linear velocity, m/s, and angular velocity, rad/s, axes of `base`.
        twist: [f64; 6],
        /// Force, newtons, and torque, newton metres.
        wrench: [f64; 6],
    }
}

impl JointCommand {
    /// A command for `joints`: name and value each, at most 7 of them.
    ///
    /// # Errors
    /// More joints, or a name that is too long.
    pub fn new(mode: JointMode, joints: &[(&str, f64)]) -> Result<Self, WireError> {
        let mut message = Self { mode: mode.code(), len: joints.len() as u32, ..Self::default() };
        if joints.len() > LIMB_JOINTS {
            return Err(WireError::new("joint command length", message.len));
        }
        for (i, (name, value)) in joints.iter().enumerate() {
            let fits = FixedText::new(name);
            message.names[i] = fits.map_err(|e| WireError::new("joint name of", e.bytes as u32))?;
            message.command[i] = *value;
        }
        Ok(message)
    }

    /// Name and value of each joint.
    ///
    /// # Errors
    /// A length beyond the bound, or a name that is not text.
    pub fn joints(&self) -> Result<Vec<(&str, f64)>, WireError> {
        let (names, command) = (self.names.get(..self.len as usize), &self.command);
        let names = names.ok_or(WireError::new("joint command length", self.len))?;
        names.iter().zip(command).map(|(name, value)| Ok((name.as_str()?, *value))).collect()
    }
}

/// State of one joint: position, velocity, effort.
pub type Measurement = [f64; 3];

impl JointState {
    /// Measurements of `joints` at `stamp_ns`: at most 17 names with position, velocity and effort.
    ///
    /// # Errors
    /// More joints, or a name that is too long.
    pub fn new(stamp_ns: u64, joints: &[(&str, Measurement)]) -> Result<Self, WireError> {
        let mut message = Self { stamp_ns, len: joints.len() as u32, ..Self::default() };
        if joints.len() > JOINTS_MAX {
            return Err(WireError::new("joint state length", message.len));
        }
        for (i, (name, [position, velocity, effort])) in joints.iter().enumerate() {
            let fits = FixedText::new(name);
            message.name[i] = fits.map_err(|e| WireError::new("joint name of", e.bytes as u32))?;
            message.position[i] = *position;
            message.velocity[i] = *velocity;
            message.effort[i] = *effort;
        }
        Ok(message)
    }

    /// Name, position, velocity and effort of each joint.
    ///
    /// # Errors
    /// A length beyond the bound, a name that is not text, or a position that is not a number.
    pub fn joints(&self) -> Result<Vec<(&str, Measurement)>, WireError> {
        let names = self.name.get(..self.len as usize);
        let names = names.ok_or(WireError::new("joint state length", self.len))?;
        let measured = |i: usize| {
            let measured = [self.position[i], self.velocity[i], self.effort[i]];
            let sound = measured.iter().all(|number| number.is_finite());
            sound.then_some(measured).ok_or(WireError::new("no number for joint", i as u32))
        };
        let read = names.iter().enumerate();
        read.map(|(i, name)| Ok((name.as_str()?, measured(i)?))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joint_states_round_trip_by_name() {
        let joints = [("left_s0", 0.5), ("left_w2", -1.0)];
        let command = JointCommand::new(JointMode::Position, &joints).unwrap();
        assert_eq!((command.mode, command.joints().unwrap()), (1, joints.to_vec()));
        let joints = [("head_pan", [0.1, 0.2, 0.3])];
        assert_eq!(JointState::new(5, &joints).unwrap().joints().unwrap(), joints);
    }

    #[test]
    fn joint_states_with_invalid_content_are_rejected() {
        let long = ["a"; 8].map(|name| (name, 0.0));
        assert!(JointCommand::new(JointMode::Position, &long).is_err());
        let name = "a".repeat(29);
        assert!(JointState::new(0, &[(&name, [0.0; 3])]).is_err());
        let command = JointCommand { len: 9, ..JointCommand::default() };
        assert!(command.joints().is_err());
        let lost = JointState::new(0, &[("left_s0", [f64::NAN, 0.0, 0.0])]).unwrap();
        assert!(lost.joints().is_err());
        assert!(JointMode::from_code(4).is_err(), "raw position mode is never used");
    }
}
