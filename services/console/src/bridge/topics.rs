//! The topics that the console reads.

use messages::{JointStates, Observation, Partial, RobotAct, TrajectoryView, WorldView, topics};
use service::bus::{Bus, BusError, EncodedReader, Reader};
use service::view::LatestTopics;

/// Every topic that is shown.
#[derive(Debug)]
pub(super) struct Topics {
    pub(super) latest: LatestTopics,
    pub(super) acts: Reader<RobotAct>,
    pub(super) partials: Reader<Partial>,
    pub(super) observations: Reader<Observation>,
    pub(super) worlds: EncodedReader<WorldView>,
    pub(super) trajectories: EncodedReader<TrajectoryView>,
    pub(super) joints: Reader<JointStates>,
}

impl Topics {
    pub(super) fn open(bus: &Bus) -> Result<Self, BusError> {
        Ok(Self {
            latest: LatestTopics::open(bus)?,
            acts: bus.reader(&topics::ACT)?,
            partials: bus.reader(&topics::PARTIAL)?,
            observations: bus.reader(&topics::OBSERVATION)?,
            worlds: bus.encoded_reader(&topics::WORLD)?,
            trajectories: bus.encoded_reader(&topics::TRAJECTORY)?,
            joints: bus.reader(&topics::JOINTS)?,
        })
    }
}
