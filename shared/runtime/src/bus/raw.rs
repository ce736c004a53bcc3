//! Topics as bytes, for tests of services: written with any content, and read from any writer.

use super::open::notifiers;
use super::receiver::Receiver;
use super::sender::Sender;
use super::{Bus, BusError, Connect, PortError};
use messages::Stamp;
use messages::topics::Topic;
use std::iter;
use std::mem::MaybeUninit;
use std::rc::Rc;

impl Bus {
    /// Writes bytes to a topic, for tests of the services that read it.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn raw_writer(&self, topic: &Topic) -> Result<RawWriter, BusError> {
        let is_fixed = (topic.layout)().is_some();
        Ok(RawWriter { sender: Sender::open(self, topic, None)?, is_fixed })
    }

    /// Reads a topic without judging anything, for tests of the service that writes it.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn raw_reader(&self, topic: &Topic) -> Result<RawReader, BusError> {
        Ok(RawReader { receiver: Receiver::open(self, topic, topic.buffer)? })
    }

    /// Wakes the services that read a topic, as its writer does.
    ///
    /// # Errors
    /// iceoryx2 fails.
    pub fn wake_readers_of(&self, topic: &Topic) -> Result<(), BusError> {
        notifiers(self, topic)?.iter().for_each(|notifier| notifier.notify());
        Ok(())
    }
}

/// Writes bytes to a topic.
#[derive(Debug)]
pub struct RawWriter {
    sender: Rc<Sender>,
    is_fixed: bool,
}

impl RawWriter {
    /// Sends the bytes; those of a message of fixed layout are filled up with zeros, or cut.
    ///
    /// # Errors
    /// iceoryx2 is out of memory.
    pub fn send(&self, bytes: &[u8]) -> Result<(), PortError> {
        let slots = if self.is_fixed { 1 } else { bytes.len() };
        let write = |memory: &mut [MaybeUninit<u8>]| {
            let bytes = bytes.iter().copied().chain(iter::repeat(0));
            memory.iter_mut().zip(bytes).for_each(|(slot, byte)| _ = slot.write(byte));
            Ok(())
        };
        // SAFETY: there are bytes for all of the memory.
        #[allow(unsafe_code)]
        let sent = unsafe { self.sender.send(slots, write)? };
        sent.map_err(|error| PortError::new(self.sender.topic, format!("{error:?}")))?;
        self.sender.wake_readers();
        Ok(())
    }
}

/// Reads a topic without judging anything.
#[derive(Debug)]
pub struct RawReader {
    receiver: Receiver,
}

impl RawReader {
    /// Hands over the messages that wait, oldest first, with their stamps; also those of other
    /// epochs and incarnations, and those that make no sense.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn drain(&self, take: &mut dyn FnMut(&Stamp, &[u8])) -> Result<(), PortError> {
        for _ in 0..self.receiver.pending_max {
            let Some(received) = self.receiver.take_any()? else { break };
            take(received.stamp(), received.bytes());
        }
        Ok(())
    }
}
