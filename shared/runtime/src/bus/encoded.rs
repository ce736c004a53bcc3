//! Readers and writers of topics whose payloads are postcard in a byte slice.

use super::gate::{Gate, reject};
use super::open::{notifiers, open_topic};
use super::ports::subscribe;
use super::renewed::Renewed;
use super::segment_error::{self, SegmentError};
use super::sender::Sender;
use super::{Bus, BusError, Connect, Ipc, PortError, Stamps, create};
use iceoryx2::port::{ReceiveError, publisher::Publisher, subscriber::Subscriber};
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy};
use iceoryx2::sample::Sample;
use messages::Stamp;
use messages::schema::Schema;
use messages::topics::Topic;
use postcard::ser_flavors::{Flavor, Size};
use serde::{Serialize, de::DeserializeOwned};
use std::cell::Cell;
use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::rc::Rc;

/// First guess at the size of a payload, bytes; it grows as needed.
const BYTES: usize = 4096;
/// The same for clients, of which most say a sentence and end: their memory has room for dozens of payloads.
const CLIENT_BYTES: usize = 1024;
/// Largest payload, bytes.
const BYTES_MAX: usize = 16 << 20;

impl Bus {
    /// Writes a topic of encoded payloads.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn encoded_writer<T: Schema>(&self, topic: &Topic) -> Result<EncodedWriter<T>, BusError> {
        let service = open_topic!(self, topic, [u8])?;
        let name = topic.name;
        let bytes = if topic.writer.is_some() { BYTES } else { CLIENT_BYTES };
        let publisher = Renewed::new(name, move |failing| {
            create(name, || {
                service
                    .publisher_builder()
                    .max_loaned_samples(1)
                    .initial_max_slice_len(bytes)
                    .allocation_strategy(AllocationStrategy::PowerOfTwo)
                    .backpressure_strategy(BackpressureStrategy::DiscardData)
                    .set_degradation_handler(failing.handler())
                    .create()
            })
        })?;
        let sender = Sender::open(self, name, publisher, notifiers(self, topic)?);
        let is_view = topic.writer.is_some();
        let (topic, stamps) = (topic.name, self.stamps());
        Ok(EncodedWriter {
            topic,
            is_view,
            is_short: Cell::new(false),
            sender,
            stamps,
            _payload: PhantomData,
        })
    }

    /// Reads a topic of encoded payloads.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn encoded_reader<T: Schema>(&self, topic: &Topic) -> Result<EncodedReader<T>, BusError> {
        self.buffered_encoded_reader(topic, topic.buffer)
    }

    pub(super) fn buffered_encoded_reader<T: Schema>(
        &self,
        topic: &Topic,
        buffer: usize,
    ) -> Result<EncodedReader<T>, BusError> {
        let service = open_topic!(self, topic, [u8])?;
        let subscriber = subscribe(service, topic, buffer)?;
        self.greet(topic);
        let gate = Gate::new(self, topic);
        let (topic, pending_max) = (topic.name, buffer * topic.writers_max);
        Ok(EncodedReader { topic, buffer, pending_max, subscriber, gate, _payload: PhantomData })
    }
}

/// Writes a topic of postcard payloads.
#[derive(Debug)]
pub struct EncodedWriter<T: Schema> {
    topic: &'static str,
    /// What a service shows to clients; a later one replaces it.
    is_view: bool,
    /// The last payload was dropped for want of shared memory.
    is_short: Cell<bool>,
    sender: Rc<Sender<Publisher<Ipc, [u8], Stamp>>>,
    stamps: Stamps,
    _payload: PhantomData<T>,
}

impl<T: Schema> EncodedWriter<T> {
    /// Encodes the payload into shared memory and sends it. Where it needs more memory than was
    /// reserved and there is none, a service goes on without showing it.
    ///
    /// # Errors
    /// The payload cannot be encoded or is too large, or iceoryx2 is out of memory.
    pub fn send(&self, payload: &T) -> Result<(), PortError>
    where
        T: Serialize,
    {
        let failed = |error: postcard::Error| PortError::new(self.topic, error.to_string());
        let length = postcard::serialize_with_flavor(payload, Size::default()).map_err(failed)?;
        self.send_filled(length, |unwritten| {
            postcard::serialize_with_flavor(payload, unwritten).map_err(failed)
        })
    }
}

impl<T: Schema> EncodedWriter<T> {
    /// Sends bytes that somebody else has encoded.
    ///
    /// # Errors
    /// As [`EncodedWriter::send`].
    pub(super) fn send_bytes(&self, bytes: &[u8]) -> Result<(), PortError> {
        self.send_filled(bytes.len(), |mut unwritten| {
            let written = unwritten.try_extend(bytes).and_then(|()| unwritten.finalize());
            written.map_err(|error| PortError::new(self.topic, error.to_string()))
        })
    }

    /// Sends a payload of this length, which `fill` writes into shared memory to its end.
    fn send_filled(
        &self,
        length: usize,
        fill: impl FnOnce(Unwritten<'_>) -> Result<(), PortError>,
    ) -> Result<(), PortError> {
        let failed = |cause| PortError::new(self.topic, cause);
        if length > BYTES_MAX {
            return Err(failed(format!("{length} bytes, {BYTES_MAX} at most")));
        }
        let is_sent = self.sender.with(|publisher| {
            segment_error::take();
            let mut sample = match publisher.loan_slice_uninit(length) {
                Ok(sample) => sample,
                Err(error) => return self.unsent(format!("{error:?}")).map(|()| false),
            };
            self.is_short.set(false);
            *sample.user_header_mut() = self.stamps.next();
            fill(Unwritten(sample.payload_mut()))?;
            // SAFETY: filled to its end without an error, every byte has been written.
            #[allow(unsafe_code)]
            let sample = unsafe { sample.assume_init() };
            sample.send().map(|_| true).map_err(|e| failed(format!("{e:?}")))
        })?;
        if is_sent {
            self.sender.wake_readers();
        }
        Ok(())
    }

    fn unsent(&self, cause: String) -> Result<(), PortError> {
        match segment_error::take() {
            Some(error @ SegmentError::Room { .. }) if self.is_view => {
                if !self.is_short.replace(true) {
                    tracing::warn!(topic = self.topic, %error, "not shown");
                }
                Ok(())
            }
            Some(error) => Err(PortError::new(self.topic, error.to_string())),
            None => Err(PortError::new(self.topic, cause)),
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

/// Encoded bytes in shared memory.
type Slice = Sample<Ipc, [u8], Stamp>;

/// Reads a topic of postcard payloads.
#[derive(Debug)]
pub struct EncodedReader<T: Schema> {
    topic: &'static str,
    /// Unread payloads of each writer that are kept.
    buffer: usize,
    /// Payloads that may be pending at a time.
    pending_max: usize,
    subscriber: Renewed<Subscriber<Ipc, [u8], Stamp>>,
    gate: Gate,
    _payload: PhantomData<T>,
}

impl<T: Schema> EncodedReader<T> {
    /// Decodes the next payload where it lies in shared memory, so that it may borrow bytes and text
    /// from there; an invalid one is logged and skipped, because a client's invalid bytes must not
    /// stop a service.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn take_with<R>(
        &self,
        mut decode: impl FnMut(&[u8]) -> postcard::Result<R>,
    ) -> Result<Option<R>, PortError> {
        self.take_stamped(|bytes, _| decode(bytes))
    }

    /// As [`EncodedReader::take_with`] for everything that is pending, with who sent each payload and when. It ends
    /// even where a writer sends as fast as it is read.
    pub(super) fn drain_stamped(
        &self,
        mut decode: impl FnMut(&[u8], &Stamp) -> postcard::Result<()>,
    ) -> Result<(), PortError> {
        for _ in 0..self.pending_max {
            if self.take_stamped(&mut decode)?.is_none() {
                break;
            }
        }
        Ok(())
    }

    pub(super) fn take_stamped<R>(
        &self,
        mut decode: impl FnMut(&[u8], &Stamp) -> postcard::Result<R>,
    ) -> Result<Option<R>, PortError> {
        self.subscriber.with(|subscriber| {
            loop {
                let received = subscriber.receive();
                let received =
                    received.map_err(|e| PortError::new(self.topic, format!("{e:?}")))?;
                let Some(sample) = received else { return Ok(None) };
                if !self.gate.admits(sample.user_header()) {
                    continue;
                }
                match decode(sample.payload(), sample.user_header()) {
                    Ok(payload) => return Ok(Some(payload)),
                    Err(error) => reject(self.topic, &error),
                }
            }
        })
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

    /// Takes what is pending, one payload of each writer in turn. It ends even where a writer sends as
    /// fast as it is read: what arrives meanwhile wakes the reader again.
    ///
    /// # Errors
    /// As [`EncodedReader::take`].
    pub fn drain_in_turn(&self, mut take: impl FnMut(T)) -> Result<(), PortError> {
        self.subscriber.with(|subscriber| {
            for _ in 0..self.buffer {
                let turn = self.turn(subscriber)?;
                if turn.is_empty() {
                    break;
                }
                for sample in turn.iter().filter(|it| self.gate.admits(it.user_header())) {
                    match postcard::from_bytes(sample.payload()) {
                        Ok(payload) => take(payload),
                        Err(error) => reject(self.topic, &error),
                    }
                }
            }
            Ok(())
        })
    }

    /// Returns the next payload of every writer: none gives another one while the first is held.
    fn turn(&self, subscriber: &Subscriber<Ipc, [u8], Stamp>) -> Result<Vec<Slice>, PortError> {
        let mut turn = Vec::new();
        loop {
            match subscriber.receive() {
                Ok(Some(sample)) => turn.push(sample),
                Ok(None) | Err(ReceiveError::ExceedsMaxBorrows) => return Ok(turn),
                Err(error) => return Err(PortError::new(self.topic, format!("{error:?}"))),
            }
        }
    }

    /// Returns the newest pending payload.
    ///
    /// # Errors
    /// As [`EncodedReader::take`].
    pub fn latest(&self) -> Result<Option<T>, PortError> {
        let mut latest = None;
        self.drain_stamped(|bytes, _| postcard::from_bytes(bytes).map(|it| latest = Some(it)))?;
        Ok(latest)
    }
}
