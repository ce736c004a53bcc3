//! The arm's side of the robot's own topics.

use messages::robot::{
    AssemblyState, EndEffectorCommand, EndEffectorProperties, EndEffectorState, JointCommand,
    JointState, JointTrajectoryPoint, Order, Report, SpeedRatio,
};
use messages::topics::robot;
use service::bus::{Bus, BusError, PortError, Reader, Writer};
use service::robot_topics::{readers, writers};

/// The robot's topics as the arm uses them; pairs are left and right.
#[derive(Debug)]
pub(super) struct RobotTopics {
    joints: Reader<JointState>,
    assembly: Reader<AssemblyState>,
    grippers: [Reader<EndEffectorState>; 2],
    properties: [Reader<EndEffectorProperties>; 2],
    commands: [Writer<JointCommand>; 2],
    feed_forward: [Writer<JointTrajectoryPoint>; 2],
    ratios: [Writer<SpeedRatio>; 2],
    fingers: [Writer<EndEffectorCommand>; 2],
}

impl RobotTopics {
    pub(super) fn open(bus: &Bus) -> Result<Self, BusError> {
        Ok(Self {
            joints: bus.reader(&robot::JOINT_STATES)?,
            assembly: bus.reader(&robot::STATE)?,
            grippers: readers(bus, &robot::GRIPPER_STATE)?,
            properties: readers(bus, &robot::GRIPPER_PROPERTIES)?,
            commands: writers(bus, &robot::JOINT_COMMAND)?,
            feed_forward: writers(bus, &robot::INVERSE_DYNAMICS_COMMAND)?,
            ratios: writers(bus, &robot::SET_SPEED_RATIO)?,
            fingers: writers(bus, &robot::GRIPPER_COMMAND)?,
        })
    }

    pub(super) fn drain(&self, mut take: impl FnMut(Report<'_>)) -> Result<(), PortError> {
        // The robot as a whole first: joints mean nothing on one that has been switched off.
        self.assembly.drain(|state| take(Report::Assembly(*state)))?;
        for limb in [0, 1] {
            self.properties[limb].drain(|own| take(Report::Properties(limb, own.into())))?;
            self.grippers[limb].drain(|state| take(Report::Gripper(limb, state.into())))?;
        }
        self.joints.drain(|state| take(Report::Joints(state.into())))
    }

    pub(super) fn send(&self, order: &Order<'_>) -> Result<(), PortError> {
        match order {
            Order::Joints(limb, command) => self.commands[*limb].send(command),
            Order::FeedForward(limb, point) => self.feed_forward[*limb].send(point),
            Order::SpeedRatio(limb, ratio) => self.ratios[*limb].send(ratio),
            Order::Gripper(limb, command) => self.fingers[*limb].send(command),
        }
    }
}
