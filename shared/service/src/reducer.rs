//! The core of a service: a deterministic reducer from events to effects.
//!
//! A node does no IO, reads no clock and starts no threads; it states its outputs and records
//! as [`Effects`], and the runtime carries them out in one fixed order: append all records, sync
//! once, and only then publish. So a node can be killed at any point, and a simulation can run all
//! of them in one thread. Urgent outputs alone do not wait for records: a node that has some may
//! handle further events before the records of an earlier one are durable.

use crate::Time;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

/// Input of a node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Event<In> {
    /// A journal of the group has been set aside since the epoch began. Comes before
    /// [`Event::Started`] at every start since, so it must be idempotent.
    SetAside(SetAside),
    /// The node has been recovered and its topics are open.
    Started,
    /// Something arrived, from a topic or a device.
    Message(In),
    /// A deadline has passed, or the periodic tick is due.
    Tick,
    /// The service is to end: bring moving parts to rest, then call [`Effects::exit`].
    Shutdown,
}

/// The numbers that are over because a journal of the group was set aside: nothing with these
/// numbers is in progress any more, and none is assigned again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetAside {
    /// The highest of them; for utterances, interactions, prompts and acts alike.
    pub over: u64,
    /// Whether this service's own journal was set aside and its successor is still empty.
    pub is_own: bool,
}

/// A service as a reducer. Its inputs and statements can be recorded, and replayed with another
/// build ([`crate::flight`]).
pub trait Node: Sized + 'static {
    /// Configuration of the node.
    type Config;
    /// Messages and device results that it receives; messages are read in place in shared memory.
    type In<'a>: Serialize + DeserializeOwned;
    /// Messages that it publishes, and requests to its devices.
    type Out: Serialize + DeserializeOwned;
    /// Records of the node's journal. A stateless node uses [`Never`].
    type Record: Serialize + DeserializeOwned + Send + 'static;

    /// Restores the node from its journal; empty at the first start. It is the only constructor, so
    /// that first start and restart share one path.
    ///
    /// # Errors
    /// The journal contradicts the configuration in a way that the node cannot repair.
    fn recover(config: Self::Config, records: Vec<Self::Record>) -> Result<Self, NodeError>;

    /// Handles one event. Must be deterministic in `(self, event, now)`.
    fn on(
        &mut self,
        event: Event<Self::In<'_>>,
        now: Time,
        fx: &mut Effects<Self::Out, Self::Record>,
    );

    /// Learns that every record stated so far is durable.
    fn on_durable(&mut self) {}

    /// Returns the time of the next [`Event::Tick`].
    fn deadline(&self) -> Option<Time>;

    /// Returns the arrival of the oldest pending input, for the operator's status.
    fn pending_since(&self) -> Option<Time> {
        None
    }

    /// Returns the service's status for the operator, in a few words.
    fn status(&self) -> Option<&str> {
        None
    }

    /// Returns how many messages the node has rejected as invalid, for the operator's status.
    fn rejected(&self) -> u64 {
        0
    }

    /// Returns whether the node can do its work. Until then its service is not reported ready.
    fn is_ready(&self) -> bool {
        true
    }

    /// Returns records that replace the whole journal so far, so that it can be compacted; `None`
    /// if work in progress does not permit that.
    fn snapshot(&self) -> Option<Vec<Self::Record>> {
        None
    }

    /// Returns once whether [`Node::snapshot`] must replace the journal, its content erased.
    fn take_erasure(&mut self) -> bool {
        false
    }

    /// Returns the whole state, so that a flight can begin here; `None` if work in progress, or the
    /// kind of node, does not permit that.
    fn checkpoint(&self) -> Option<Vec<u8>> {
        None
    }

    /// Restores the node from [`Node::checkpoint`]: from here on it behaves like that node.
    ///
    /// # Errors
    /// The checkpoint is not of this configuration and this build.
    fn resume(_config: Self::Config, _checkpoint: &[u8]) -> Result<Self, NodeError> {
        Err(NodeError::foreign_checkpoint())
    }
}

/// Effects of one or more events, in the order in which they were stated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Effects<Out, Record> {
    records: Vec<Record>,
    vital: bool,
    urgent: Vec<Out>,
    outputs: Vec<Out>,
    exit: bool,
}

impl<Out, Record> Default for Effects<Out, Record> {
    fn default() -> Self {
        let (urgent, outputs) = (Vec::new(), Vec::new());
        Self { records: Vec::new(), vital: false, urgent, outputs, exit: false }
    }
}

impl<Out, Record> Effects<Out, Record> {
    /// Appends `record` to the journal before anything of this batch is published.
    pub fn append(&mut self, record: Record) {
        self.records.push(record);
    }

    /// As [`Effects::append`], for a record that protects people: on a full disk it takes the space
    /// that the journal keeps in reserve.
    pub fn append_vital(&mut self, record: Record) {
        self.vital = true;
        self.append(record);
    }

    /// Publishes `output` once every record of this batch is durable.
    pub fn publish(&mut self, output: Out) {
        self.outputs.push(output);
    }

    /// Publishes `output` at once: it depends on no record that is not durable yet.
    pub fn publish_urgent(&mut self, output: Out) {
        self.urgent.push(output);
    }

    /// Ends the service after the current batch.
    pub fn exit(&mut self) {
        self.exit = true;
    }

    /// Returns true if the service is to end.
    pub fn exits(&self) -> bool {
        self.exit
    }

    /// Returns whether nothing is stated.
    pub fn is_empty(&self) -> bool {
        let Self { records, urgent, outputs, exit, .. } = self;
        records.is_empty() && urgent.is_empty() && outputs.is_empty() && !exit
    }

    /// Returns the records.
    pub fn records(&self) -> &[Record] {
        &self.records
    }

    /// Keeps only the request to end, once everything is carried out.
    pub(crate) fn carried_out(&mut self) {
        *self = Self { exit: self.exit, ..Self::default() };
    }

    /// Takes the records, leaving none.
    pub fn take_records(&mut self) -> Vec<Record> {
        std::mem::take(&mut self.records)
    }

    /// Returns whether one of the records since the last call is vital.
    pub fn take_vital(&mut self) -> bool {
        std::mem::take(&mut self.vital)
    }

    /// Takes the outputs that wait for no record, leaving none.
    pub fn take_urgent(&mut self) -> Vec<Out> {
        std::mem::take(&mut self.urgent)
    }

    /// Takes the outputs, urgent ones first, leaving none.
    pub fn take_outputs(&mut self) -> Vec<Out> {
        let mut outputs = self.take_urgent();
        outputs.append(&mut self.outputs);
        outputs
    }
}

/// The record type of a stateless node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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

impl NodeError {
    /// A checkpoint that this build cannot resume from.
    pub fn foreign_checkpoint() -> Self {
        let what = "the checkpoint is not of this build and configuration".to_owned();
        Self { what, help: "replay the flight with the build that recorded it".to_owned() }
    }
}
