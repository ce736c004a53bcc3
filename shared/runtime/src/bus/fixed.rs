//! Readers and writers of fixed-layout topics.
//!
//! A writer never blocks: a slow reader loses the oldest message, and important ones are resent.

use super::gate::reject;
use super::open::has_messages;
use super::receiver::Receiver;
use super::sender::Sender;
use super::{Bus, BusError, Connect, PortError};
use messages::Stamp;
use messages::layout::{self, WireMessage};
use messages::topics::Topic;
use std::cell::Cell;
use std::fmt::Debug;
use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::rc::Rc;

impl Bus {
    /// Writes a fixed-layout topic.
    ///
    /// # Errors
    /// Another schema, too many writers, or an error of iceoryx2.
    pub fn writer<T: WireMessage>(&self, topic: &Topic) -> Result<Writer<T>, BusError> {
        has_messages::<T>(topic)?;
        let sender = Sender::open(self, topic, None)?;
        // A state of which only the latest message counts is repeated, and wakes readers if
        // changed.
        let latest = (topic.buffer == 1 && sender.wakes()).then(Cell::default);
        Ok(Writer { sender, latest })
    }

    /// Reads a fixed-layout topic.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn reader<T: WireMessage>(&self, topic: &Topic) -> Result<Reader<T>, BusError> {
        has_messages::<T>(topic)?;
        let receiver = Receiver::open(self, topic, topic.buffer)?;
        self.greet(topic);
        Ok(Reader { receiver, _message: PhantomData })
    }
}

/// Writes a fixed-layout topic.
#[derive(Debug)]
pub struct Writer<T: WireMessage> {
    sender: Rc<Sender>,
    /// The message sent last, if the topic is a state that is repeated.
    latest: Option<Cell<Option<T>>>,
}

impl<T: WireMessage> Writer<T> {
    /// Sends a copy of the message, as [`Writer::send_with`] sends one that it fills in place.
    ///
    /// # Errors
    /// iceoryx2 is out of memory.
    pub fn send(&self, message: &T) -> Result<(), PortError> {
        self.send_filled(|slot| slot.write(*message))
    }

    /// Fills a message in shared memory, from its default, sends it and wakes the topic's readers,
    /// unless it repeats a state: they take that with their next pass. That it was sent does not
    /// mean that it was received.
    ///
    /// # Errors
    /// iceoryx2 is out of memory.
    pub fn send_with(&self, fill: impl FnOnce(&mut T)) -> Result<(), PortError>
    where
        T: Default,
    {
        self.send_filled(|slot| {
            let message = slot.write(T::default());
            fill(message);
            message
        })
    }

    fn send_filled(
        &self,
        fill: impl FnOnce(&mut MaybeUninit<T>) -> &mut T,
    ) -> Result<(), PortError> {
        let mut state = None;
        let failed = |cause| PortError::new(self.sender.topic, cause);
        let write = |bytes: &mut [MaybeUninit<u8>]| {
            let slot = layout::slot(bytes).ok_or_else(|| failed("not its layout".to_owned()))?;
            let message = fill(slot);
            state = self.latest.as_ref().map(|_| *message);
            Ok(())
        };
        // SAFETY: the message fills its slot and has no padding.
        #[allow(unsafe_code)]
        let sent = unsafe { self.sender.send(1, write)? };
        sent.map_err(|error| failed(format!("{error:?}")))?;
        if self.is_news(state) {
            self.sender.wake_readers();
        }
        Ok(())
    }

    /// Returns whether the sent state differs from the last one, if the topic is a `state`.
    fn is_news(&self, state: Option<T>) -> bool {
        let Some(latest) = &self.latest else { return true };
        state != latest.replace(state)
    }
}

/// Reads a fixed-layout topic.
#[derive(Debug)]
pub struct Reader<T: WireMessage> {
    receiver: Receiver,
    _message: PhantomData<T>,
}

impl<T: WireMessage> Reader<T> {
    /// Returns the next message without copying it, if one is pending.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn take<R>(&self, read: impl FnOnce(&T) -> R) -> Result<Option<R>, PortError> {
        self.take_stamped(|message, _| read(message))
    }

    fn take_stamped<R>(&self, read: impl FnOnce(&T, &Stamp) -> R) -> Result<Option<R>, PortError> {
        while let Some(received) = self.receiver.take()? {
            match layout::checked(received.bytes()) {
                Ok(message) => return Ok(Some(read(message, received.stamp()))),
                Err(error) => reject(self.receiver.topic, &error),
            }
        }
        Ok(None)
    }

    /// Returns every pending message, in order. It ends even if a writer sends as fast as it is
    /// read: later messages wake the reader again.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn drain(&self, mut read: impl FnMut(&T)) -> Result<(), PortError> {
        self.drain_stamped(|message, _| read(message))
    }

    /// As [`Reader::drain`], with who sent each message and when.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn drain_stamped(&self, mut read: impl FnMut(&T, &Stamp)) -> Result<(), PortError> {
        for _ in 0..self.receiver.pending_max {
            if self.take_stamped(&mut read)?.is_none() {
                break;
            }
        }
        Ok(())
    }

    /// Returns the newest pending message.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn latest(&self) -> Result<Option<T>, PortError> {
        let mut latest = None;
        self.drain(|message| latest = Some(*message))?;
        Ok(latest)
    }
}
