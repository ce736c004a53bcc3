//! The topics that the console reads.

use messages::{
    Activity, ArmStatus, Hearing, JointStates, Observation, Partial, PolicyView, Presented,
    Receipt, RobotAct, TrajectoryView, WorldView, topics,
};
use service::Time;
use service::bus::{Bus, BusError, EncodedReader, PortError, Reader};

/// Every topic that is shown.
#[derive(Debug)]
pub(super) struct Ports {
    pub(super) views: EncodedReader<PolicyView>,
    pub(super) acts: Reader<RobotAct>,
    pub(super) presented: Reader<Presented>,
    pub(super) activity: Reader<Activity>,
    pub(super) hearing: Reader<Hearing>,
    pub(super) partials: Reader<Partial>,
    pub(super) receipts: Reader<Receipt>,
    pub(super) observations: Reader<Observation>,
    pub(super) statuses: Reader<ArmStatus>,
    pub(super) worlds: EncodedReader<WorldView>,
    pub(super) trajectories: EncodedReader<TrajectoryView>,
    pub(super) joints: Reader<JointStates>,
}

impl Ports {
    pub(super) fn open(bus: &Bus) -> Result<Self, BusError> {
        Ok(Self {
            views: bus.encoded_reader(&topics::VIEW)?,
            acts: bus.reader(&topics::ACT)?,
            presented: bus.reader(&topics::PRESENTED)?,
            activity: bus.reader(&topics::ACTIVITY)?,
            hearing: bus.reader(&topics::HEARING)?,
            partials: bus.reader(&topics::PARTIAL)?,
            receipts: bus.reader(&topics::RECEIPT)?,
            observations: bus.reader(&topics::OBSERVATION)?,
            statuses: bus.reader(&topics::STATUS)?,
            worlds: bus.encoded_reader(&topics::WORLD)?,
            trajectories: bus.encoded_reader(&topics::TRAJECTORY)?,
            joints: bus.reader(&topics::JOINTS)?,
        })
    }
}

impl Ports {
    /// What the arm has said, and when.
    pub(super) fn stamped_statuses(&self) -> Vec<(ArmStatus, Time)> {
        let mut statuses = Vec::new();
        let drained = self
            .statuses
            .drain_stamped(|status, stamp| statuses.push((*status, Time(stamp.sent_ns))));
        quiet(drained.map(Some));
        statuses
    }
}

/// A connection that breaks as a service dies is made anew by the next one; until then there is
/// nothing to take.
pub(super) fn quiet<T>(result: Result<Option<T>, PortError>) -> Option<T> {
    result.ok().flatten()
}

/// Everything that waits on a topic.
pub(super) fn all<T: service::bus::WireMessage + Copy>(reader: &Reader<T>) -> Vec<T> {
    let mut all = Vec::new();
    quiet(reader.drain(|message| all.push(*message)).map(Some));
    all
}
