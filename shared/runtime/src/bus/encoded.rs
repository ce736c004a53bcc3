//! Readers and writers of topics whose payloads are postcard in a byte slice.

use super::gate::reject;
use super::open::has_messages;
use super::receiver::Receiver;
use super::segment_error::{self, SegmentError};
use super::sender::Sender;
use super::{Bus, BusError, Connect, PortError};
use messages::schema::Schema;
use messages::topics::Topic;
use postcard::ser_flavors::{Flavor, Size};
use serde::{Serialize, de::DeserializeOwned};
use std::cell::Cell;
use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::rc::Rc;

/// Largest payload, bytes.
const BYTES_MAX: usize = 16 << 20;

impl Bus {
    /// Writes a topic of encoded payloads.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn encoded_writer<T: Schema>(&self, topic: &Topic) -> Result<EncodedWriter<T>, BusError> {
        self.encoded_writer_of(topic, None)
    }

    /// Opens a topic for writing encoded payloads of limited size; a larger one is an error.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub(crate) fn encoded_writer_of<T: Schema>(
        &self,
        topic: &Topic,
        bytes_max: Option<usize>,
    ) -> Result<EncodedWriter<T>, BusError> {
        has_messages::<T>(topic)?;
        let sender = Sender::open(self, topic, bytes_max)?;
        let (is_view, is_short) = (topic.writer.is_some(), Cell::new(false));
        Ok(EncodedWriter { is_view, is_short, sender, _payload: PhantomData })
    }

    /// Reads a topic of encoded payloads.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn encoded_reader<T: Schema>(&self, topic: &Topic) -> Result<EncodedReader<T>, BusError> {
        has_messages::<T>(topic)?;
        let receiver = Receiver::open(self, topic, topic.buffer)?;
        self.greet(topic);
        Ok(EncodedReader { receiver, _payload: PhantomData })
    }
}

/// Writes a topic of postcard payloads.
#[derive(Debug)]
pub struct EncodedWriter<T: Schema> {
    /// Whether the payload is a view for clients; a later one replaces it.
    is_view: bool,
    /// The last payload was dropped for lack of shared memory.
    is_short: Cell<bool>,
    sender: Rc<Sender>,
    _payload: PhantomData<T>,
}

impl<T: Schema> EncodedWriter<T> {
    /// Encodes the payload into shared memory and sends it. If it needs more memory than was
    /// reserved and there is none, a service continues without showing it.
    ///
    /// # Errors
    /// The payload cannot be encoded or is too large, or iceoryx2 is out of memory.
    pub fn send(&self, payload: &T) -> Result<(), PortError>
    where
        T: Serialize,
    {
        let failed = |error: postcard::Error| self.failed(error.to_string());
        let length = postcard::serialize_with_flavor(payload, Size::default()).map_err(failed)?;
        if length > BYTES_MAX {
            return Err(self.failed(format!("{length} bytes, {BYTES_MAX} at most")));
        }
        let write = |memory: &mut [MaybeUninit<u8>]| {
            postcard::serialize_with_flavor(payload, Unwritten(memory)).map_err(failed)
        };
        // SAFETY: a rest that is not written is an error.
        #[allow(unsafe_code)]
        let sent = unsafe { self.sender.send(length, write)? };
        match sent {
            Ok(()) => {
                self.is_short.set(false);
                self.sender.wake_readers();
                Ok(())
            }
            Err(error) => self.unsent(format!("{error:?}")),
        }
    }

    fn failed(&self, cause: String) -> PortError {
        PortError::new(self.sender.topic, cause)
    }

    fn unsent(&self, cause: String) -> Result<(), PortError> {
        match segment_error::take() {
            Some(error @ SegmentError::Room { .. }) if self.is_view => {
                if !self.is_short.replace(true) {
                    tracing::warn!(topic = self.sender.topic, %error, "not shown");
                }
                Ok(())
            }
            Some(error) => Err(self.failed(error.to_string())),
            None => Err(self.failed(cause)),
        }
    }
}

/// Bytes of a loan that are still to be written by the encoder.
struct Unwritten<'a>(&'a mut [MaybeUninit<u8>]);

impl Flavor for Unwritten<'_> {
    type Output = ();

    fn try_push(&mut self, byte: u8) -> postcard::Result<()> {
        self.try_extend(&[byte])
    }

    fn try_extend(&mut self, bytes: &[u8]) -> postcard::Result<()> {
        let slots = self.0.split_off_mut(..bytes.len());
        let slots = slots.ok_or(postcard::Error::SerializeBufferFull)?;
        for (slot, byte) in slots.iter_mut().zip(bytes) {
            slot.write(*byte);
        }
        Ok(())
    }

    /// # Errors
    /// Fewer bytes than the loan has.
    fn finalize(self) -> postcard::Result<()> {
        if self.0.is_empty() { Ok(()) } else { Err(postcard::Error::SerdeSerCustom) }
    }
}

/// Reads a topic of postcard payloads.
#[derive(Debug)]
pub struct EncodedReader<T: Schema> {
    receiver: Receiver,
    _payload: PhantomData<T>,
}

impl<T: Schema> EncodedReader<T> {
    /// Decodes the next payload in place in shared memory, so that it may borrow bytes and text
    /// from there; an invalid one is logged and skipped, because a client's invalid bytes must not
    /// stop a service.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn take_with<R>(
        &self,
        mut decode: impl FnMut(&[u8]) -> postcard::Result<R>,
    ) -> Result<Option<R>, PortError> {
        while let Some(received) = self.receiver.take()? {
            match decode(received.bytes()) {
                Ok(payload) => return Ok(Some(payload)),
                Err(error) => reject(self.receiver.topic, &error),
            }
        }
        Ok(None)
    }
}

impl<T: Schema + DeserializeOwned> EncodedReader<T> {
    /// As [`EncodedReader::take_with`], with a payload that is kept.
    ///
    /// # Errors
    /// As [`EncodedReader::take_with`].
    pub fn take(&self) -> Result<Option<T>, PortError> {
        self.take_with(|bytes| postcard::from_bytes(bytes))
    }

    /// Takes pending payloads, one of each writer in turn. It ends even if a writer sends as fast
    /// as it is read: later payloads wake the reader again.
    ///
    /// # Errors
    /// As [`EncodedReader::take`].
    pub fn drain_in_turn(&self, mut take: impl FnMut(T)) -> Result<(), PortError> {
        for _ in 0..self.receiver.buffer {
            let turn = self.receiver.take_turn()?;
            if turn.is_empty() {
                break;
            }
            for received in turn.iter().filter(|it| self.receiver.admits(it)) {
                match postcard::from_bytes(received.bytes()) {
                    Ok(payload) => take(payload),
                    Err(error) => reject(self.receiver.topic, &error),
                }
            }
        }
        Ok(())
    }

    /// Returns the newest pending payload.
    ///
    /// # Errors
    /// As [`EncodedReader::take`].
    pub fn latest(&self) -> Result<Option<T>, PortError> {
        let mut latest = None;
        for _ in 0..self.receiver.pending_max {
            match self.take()? {
                Some(payload) => latest = Some(payload),
                None => break,
            }
        }
        Ok(latest)
    }
}
