//! The receiving end of a topic, whatever its messages.

use super::gate::Gate;
use super::open::open_topic;
use super::port::{ReceivePort, Received};
use super::renewed::Renewed;
use super::{Bus, BusError, PortError, create};
use iceoryx2::port::ReceiveError;
use messages::topics::Topic;

/// The port of a reader, with its checks of incoming messages.
#[derive(Debug)]
pub(super) struct Receiver {
    pub(super) topic: &'static str,
    /// Unread messages of each writer that are kept.
    pub(super) buffer: usize,
    /// Messages that may be pending at a time.
    pub(super) pending_max: usize,
    port: Renewed<ReceivePort>,
    gate: Gate,
}

impl Receiver {
    /// Opens the topic for a reader that holds at most `buffer` unread messages of each writer.
    pub(super) fn open(bus: &Bus, topic: &Topic, buffer: usize) -> Result<Self, BusError> {
        let service = open_topic(bus, topic)?;
        let (name, history) = (topic.name, topic.history);
        let port = Renewed::new(name, move |failing| {
            create(name, || {
                service
                    .subscriber_builder()
                    .buffer_size(buffer)
                    .history_request(history)
                    .set_degradation_handler(failing.handler())
                    .create()
            })
        })?;
        let (gate, pending_max) = (Gate::new(bus, topic), buffer * topic.writers_max);
        Ok(Self { topic: name, buffer, pending_max, port, gate })
    }

    /// Returns the next message of this life of the group.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub(super) fn take(&self) -> Result<Option<Received>, PortError> {
        loop {
            match self.take_any()? {
                Some(message) if !self.admits(&message) => {}
                message => return Ok(message),
            }
        }
    }

    /// Returns the next message, whoever sent it and when.
    ///
    /// # Errors
    /// As [`Receiver::take`].
    pub(super) fn take_any(&self) -> Result<Option<Received>, PortError> {
        self.port.with(|port| Received::take(port).map_err(|error| self.failed(&error)))
    }

    /// Returns the next message of every writer, whoever sent it and when: none gives another one
    /// while the first is held.
    ///
    /// # Errors
    /// As [`Receiver::take`].
    pub(super) fn take_turn(&self) -> Result<Vec<Received>, PortError> {
        let mut turn = Vec::new();
        loop {
            match self.port.with(|port| Ok(Received::take(port)))? {
                Ok(Some(message)) => turn.push(message),
                Ok(None) | Err(ReceiveError::ExceedsMaxBorrows) => return Ok(turn),
                Err(error) => return Err(self.failed(&error)),
            }
        }
    }

    /// Returns whether the message is of this life of the group.
    pub(super) fn admits(&self, message: &Received) -> bool {
        self.gate.admits(message.stamp())
    }

    fn failed(&self, error: &ReceiveError) -> PortError {
        PortError::new(self.topic, format!("{error:?}"))
    }
}
