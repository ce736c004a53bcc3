//! A robot's topics as the robot has them: a simulated one, or a bridge to a real one. The arm's
//! side is its own.

use messages::robot::{
    AssemblyState, EndEffectorCommand, EndEffectorProperties, EndEffectorState, EndpointState,
    JointCommand, JointState, JointTrajectoryPoint, Order, Report, SpeedRatio,
};
use messages::topics::robot;
use messages::{Topic, WireMessage};
use service::Time;
use service::bus::{Bus, BusError, PortError, Reader, Writer};

/// Readers of orders and writers of reports; pairs are left and right.
#[derive(Debug)]
pub struct RobotSide {
    commands: [Reader<JointCommand>; 2],
    feed_forward: [Reader<JointTrajectoryPoint>; 2],
    ratios: [Reader<SpeedRatio>; 2],
    fingers: [Reader<EndEffectorCommand>; 2],
    joints: Writer<JointState>,
    assembly: Writer<AssemblyState>,
    endpoints: [Writer<EndpointState>; 2],
    grippers: [Writer<EndEffectorState>; 2],
    properties: [Writer<EndEffectorProperties>; 2],
}

impl RobotSide {
    /// Opens the topics.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn open(bus: &Bus) -> Result<Self, BusError> {
        Ok(Self {
            commands: readers(bus, &robot::JOINT_COMMAND)?,
            feed_forward: readers(bus, &robot::INVERSE_DYNAMICS_COMMAND)?,
            ratios: readers(bus, &robot::SET_SPEED_RATIO)?,
            fingers: readers(bus, &robot::GRIPPER_COMMAND)?,
            joints: bus.writer(&robot::JOINT_STATES)?,
            assembly: bus.writer(&robot::STATE)?,
            endpoints: writers(bus, &robot::ENDPOINT_STATE)?,
            grippers: writers(bus, &robot::GRIPPER_STATE)?,
            properties: writers(bus, &robot::GRIPPER_PROPERTIES)?,
        })
    }

    /// Hands over every pending order, in place in shared memory.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn drain(&self, mut take: impl FnMut(Order<'_>)) -> Result<(), PortError> {
        for limb in [0, 1] {
            self.ratios[limb].drain(|it| take(Order::SpeedRatio(limb, *it)))?;
            self.commands[limb].drain(|it| take(Order::Joints(limb, it.into())))?;
            self.feed_forward[limb].drain(|it| take(Order::FeedForward(limb, it.into())))?;
            self.fingers[limb].drain(|it| take(Order::Gripper(limb, it.into())))?;
        }
        Ok(())
    }

    /// Hands over the newest order of each topic, with the time when it was sent: for robots that
    /// have no use for older ones.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn newest(&self, mut take: impl FnMut(Order<'static>, Time)) -> Result<(), PortError> {
        for limb in [0, 1] {
            newest(&self.ratios[limb], |it, at| take(Order::SpeedRatio(limb, it), at))?;
            newest(&self.feed_forward[limb], |it, at| {
                take(Order::FeedForward(limb, it.into()), at);
            })?;
            newest(&self.commands[limb], |it, at| take(Order::Joints(limb, it.into()), at))?;
            newest(&self.fingers[limb], |it, at| take(Order::Gripper(limb, it.into()), at))?;
        }
        Ok(())
    }

    /// Publishes a report.
    ///
    /// # Errors
    /// As [`Writer::send`].
    pub fn send(&self, report: &Report<'_>) -> Result<(), PortError> {
        match report {
            Report::Joints(state) => self.joints.send(state),
            Report::Assembly(state) => self.assembly.send(state),
            Report::Endpoint(limb, state) => self.endpoints[*limb].send(state),
            Report::Gripper(limb, state) => self.grippers[*limb].send(state),
            Report::Properties(limb, own) => self.properties[*limb].send(own),
            // It has no topic.
            Report::Own(_) => Ok(()),
        }
    }
}

fn newest<T: WireMessage>(reader: &Reader<T>, take: impl FnOnce(T, Time)) -> Result<(), PortError> {
    let mut newest = None;
    reader.drain_stamped(|message, stamp| newest = Some((*message, Time(stamp.sent_ns))))?;
    if let Some((message, sent)) = newest {
        take(message, sent);
    }
    Ok(())
}

/// Opens the readers of a pair of topics.
pub(crate) fn readers<T: WireMessage>(
    bus: &Bus,
    [left, right]: &[Topic; 2],
) -> Result<[Reader<T>; 2], BusError> {
    Ok([bus.reader(left)?, bus.reader(right)?])
}

/// Opens the writers of a pair of topics.
pub(crate) fn writers<T: WireMessage>(
    bus: &Bus,
    [left, right]: &[Topic; 2],
) -> Result<[Writer<T>; 2], BusError> {
    Ok([bus.writer(left)?, bus.writer(right)?])
}
