//! The arm's side of the robot's own topics.

use arm_driver::Port;
use config::Settings;
use manipulation::Robot;
use messages::robot::{
    AssemblyState, EndEffectorCommand, EndEffectorProperties, EndEffectorState, JointCommand,
    JointState, JointTrajectoryPoint, Order, Report, SpeedRatio,
};
use messages::topics::robot;
use service::bus::{Bus, PortError, Reader, Writer};
use service::exit::Failure;

use crate::robot_side::{readers, writers};

/// The robot's topics as the arm uses them; pairs are left and right.
#[derive(Debug)]
struct RobotTopics {
    joints: Reader<JointState>,
    assembly: Reader<AssemblyState>,
    grippers: [Reader<EndEffectorState>; 2],
    properties: [Reader<EndEffectorProperties>; 2],
    commands: [Writer<JointCommand>; 2],
    feed_forward: [Writer<JointTrajectoryPoint>; 2],
    ratios: [Writer<SpeedRatio>; 2],
    fingers: [Writer<EndEffectorCommand>; 2],
}

/// Opens the topics.
pub(crate) fn connect(bus: &Bus, _: &Settings, _: &Robot) -> Result<Box<dyn Port>, Failure> {
    Ok(Box::new(RobotTopics {
        joints: bus.reader(&robot::JOINT_STATES)?,
        assembly: bus.reader(&robot::STATE)?,
        grippers: readers(bus, &robot::GRIPPER_STATE)?,
        properties: readers(bus, &robot::GRIPPER_PROPERTIES)?,
        commands: writers(bus, &robot::JOINT_COMMAND)?,
        feed_forward: writers(bus, &robot::INVERSE_DYNAMICS_COMMAND)?,
        ratios: writers(bus, &robot::SET_SPEED_RATIO)?,
        fingers: writers(bus, &robot::GRIPPER_COMMAND)?,
    }))
}

impl Port for RobotTopics {
    fn drain(&mut self, take: &mut dyn FnMut(Report<'_>)) -> Result<(), PortError> {
        // The robot as a whole first: joints mean nothing on one that has been switched off.
        self.assembly.drain(|state| take(Report::Assembly(*state)))?;
        for limb in [0, 1] {
            self.properties[limb].drain(|own| take(Report::Properties(limb, own.into())))?;
            self.grippers[limb].drain(|state| take(Report::Gripper(limb, state.into())))?;
        }
        self.joints.drain(|state| take(Report::Joints(state.into())))
    }

    fn send(&mut self, order: &Order<'_>) -> Result<(), PortError> {
        match order {
            Order::Joints(limb, command) => self.commands[*limb].send(command),
            Order::FeedForward(limb, point) => self.feed_forward[*limb].send(point),
            Order::SpeedRatio(limb, ratio) => self.ratios[*limb].send(ratio),
            Order::Gripper(limb, command) => self.fingers[*limb].send(command),
            Order::Own(_) => Ok(()),
        }
    }
}
