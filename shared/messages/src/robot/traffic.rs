//! Everything that goes to and comes from a robot. Limbs are 0, left, and 1, right, as in the pairs
//! of [`crate::topics::robot`].

use super::{
    AssemblyState, EndEffectorCommand, EndEffectorProperties, EndEffectorState, EndpointState,
    JointCommand, JointState, JointTrajectoryPoint, SpeedRatio,
};
use crate::MessageRef;
use serde::{Deserialize, Serialize};

/// A report of the robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Report<'a> {
    /// `joint_states`, of all or some joints.
    Joints(MessageRef<'a, JointState>),
    /// `state`.
    Assembly(AssemblyState),
    /// `endpoint_state` of a limb.
    Endpoint(usize, MessageRef<'a, EndpointState>),
    /// `end_effector/<limb>_gripper/state`.
    Gripper(usize, MessageRef<'a, EndEffectorState>),
    /// `end_effector/<limb>_gripper/properties`.
    Properties(usize, MessageRef<'a, EndEffectorProperties>),
    /// A report that a driver's own port makes, in an encoding that only that driver reads.
    Own(Vec<u8>),
}

/// An order to a robot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Order<'a> {
    /// `joint_command` of a limb.
    Joints(usize, MessageRef<'a, JointCommand>),
    /// `inverse_dynamics_command` of a limb.
    FeedForward(usize, MessageRef<'a, JointTrajectoryPoint>),
    /// `set_speed_ratio` of a limb.
    SpeedRatio(usize, SpeedRatio),
    /// `end_effector/<limb>_gripper/command`.
    Gripper(usize, MessageRef<'a, EndEffectorCommand>),
    /// An order that only the driver's own port reads.
    Own(Vec<u8>),
}
