//! The core of a service: a deterministic reducer from events to effects.
//!
//! A node does no IO, reads no clock and starts no threads; it states its outputs and records
//! as [`Effects`], and the runtime carries them out in one fixed order: append all records, sync
//! once, and only then publish. So a node can be killed at any point, and a simulation can run all
//! of them in one thread.

use crate::{Effects, Time};

/// Input of a node.
#[derive(Clone, Debug, PartialEq)]
pub enum Event<In> {
    /// The node has been recovered and its topics are open.
    Started,
    /// Something arrived, from a topic or a device.
    Message(In),
    /// A deadline has passed, or the periodic tick is due.
    Tick,
    /// The service is to end: bring what moves to rest, then call [`Effects::exit`].
    Shutdown,
}

/// A service as a reducer.
pub trait Node: Sized {
    /// Its configuration.
    type Config;
    /// Messages and device results that it receives.
    type In;
    /// Messages that it publishes, and requests to its devices.
    type Out;
    /// Records of its journal. A stateless node uses [`Never`].
    type Record;

    /// Restores the node from its journal; empty at the first start. There is no other way
    /// to make one, so that first start and restart share one path.
    ///
    /// # Errors
    /// The journal contradicts the configuration in a way that the node cannot repair.
    fn recover(config: Self::Config, records: Vec<Self::Record>) -> Result<Self, NodeError>;

    /// Handles one event. Must be deterministic in `(self, event, now)`.
    fn on(&mut self, event: Event<Self::In>, now: Time, fx: &mut Effects<Self::Out, Self::Record>);

    /// Returns the time of the next [`Event::Tick`].
    fn deadline(&self) -> Option<Time>;

    /// Returns the arrival of the oldest pending input, for the operator's status.
    fn pending_since(&self) -> Option<Time> {
        None
    }

    /// Returns records that replace the whole journal so far, if nothing is in progress, so
    /// that the journal can be compacted.
    fn snapshot(&self) -> Option<Vec<Self::Record>> {
        None
    }
}

/// The record type of a stateless node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Never {}

/// A node cannot be recovered.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what} (help: {help})")]
pub struct NodeError {
    /// Description of the error.
    pub what: String,
    /// Advice to the operator.
    pub help: String,
}
