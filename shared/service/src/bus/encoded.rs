//! Readers and writers of topics whose payloads are postcard in a byte slice.

use super::gate::{Gate, reject};
use super::open::{notifiers, open_topic};
use super::ports::subscribe;
use super::renewed::Renewed;
use super::segment_error::{self, SegmentError};
use super::sender::Sender;
use super::{Bus, BusError, Connect, Ipc, PortError, create};
use iceoryx2::port::{publisher::Publisher, subscriber::Subscriber};
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy};
use messages::Stamp;
use messages::schema::Schema;
use messages::topics::Topic;
use serde::{Serialize, de::DeserializeOwned};
use std::cell::Cell;
use std::marker::PhantomData;
use std::rc::Rc;

/// First guess at the size of a payload, bytes; it grows as needed.
const BYTES: usize = 4096;
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
        let publisher = Renewed::new(name, move |failing| {
            create(name, || {
                service
                    .publisher_builder()
                    .max_loaned_samples(1)
                    .initial_max_slice_len(BYTES)
                    .allocation_strategy(AllocationStrategy::PowerOfTwo)
                    .backpressure_strategy(BackpressureStrategy::DiscardData)
                    .set_degradation_handler(failing.handler())
                    .create()
            })
        })?;
        let sender = Sender::open(self, name, publisher, notifiers(self, topic)?);
        let is_view = topic.writer.is_some();
        let (topic, stamp) = (topic.name, self.stamp());
        Ok(EncodedWriter {
            topic,
            is_view,
            is_short: Cell::new(false),
            sender,
            stamp,
            _payload: PhantomData,
        })
    }

    /// Reads a topic of encoded payloads.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn encoded_reader<T: Schema>(&self, topic: &Topic) -> Result<EncodedReader<T>, BusError> {
        let service = open_topic!(self, topic, [u8])?;
        let subscriber = subscribe(service, topic)?;
        self.greet(topic);
        let gate = Gate::new(self, topic);
        Ok(EncodedReader { topic: topic.name, subscriber, gate, _payload: PhantomData })
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
    stamp: Stamp,
    _payload: PhantomData<T>,
}

impl<T: Schema> EncodedWriter<T> {
    /// Encodes and sends the payload. Where it needs more memory than was reserved and there is
    /// none, a service goes on without showing it.
    ///
    /// # Errors
    /// The payload cannot be encoded or is too large, or iceoryx2 is out of memory.
    pub fn send(&self, payload: &T) -> Result<(), PortError>
    where
        T: Serialize,
    {
        let failed = |cause| PortError::new(self.topic, cause);
        let bytes = postcard::to_stdvec(payload).map_err(|e| failed(e.to_string()))?;
        if bytes.len() > BYTES_MAX {
            return Err(failed(format!("{} bytes, {BYTES_MAX} at most", bytes.len())));
        }
        let is_sent = self.sender.with(|publisher| {
            segment_error::take();
            let mut sample = match publisher.loan_slice_uninit(bytes.len()) {
                Ok(sample) => sample,
                Err(error) => return self.unsent(format!("{error:?}")).map(|()| false),
            };
            self.is_short.set(false);
            *sample.user_header_mut() = Stamp { sent_ns: crate::clock::now().ns(), ..self.stamp };
            let sent = sample.write_from_slice(&bytes).send();
            sent.map(|_| true).map_err(|e| failed(format!("{e:?}")))
        })?;
        if !is_sent {
            return Ok(());
        }
        self.sender.wake_readers();
        Ok(())
    }
}

impl<T: Schema> EncodedWriter<T> {
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

/// Reads a topic of postcard payloads.
#[derive(Debug)]
pub struct EncodedReader<T: Schema> {
    topic: &'static str,
    subscriber: Renewed<Subscriber<Ipc, [u8], Stamp>>,
    gate: Gate,
    _payload: PhantomData<T>,
}

impl<T: Schema + DeserializeOwned> EncodedReader<T> {
    /// Returns the next payload; an invalid one is logged and skipped, because a client's invalid
    /// bytes must not stop a service.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn take(&self) -> Result<Option<T>, PortError> {
        self.subscriber.with(|subscriber| {
            loop {
                let received = subscriber.receive();
                let received =
                    received.map_err(|e| PortError::new(self.topic, format!("{e:?}")))?;
                let Some(sample) = received else { return Ok(None) };
                if !self.gate.admits(sample.user_header()) {
                    continue;
                }
                match postcard::from_bytes(sample.payload()) {
                    Ok(payload) => return Ok(Some(payload)),
                    Err(error) => reject(self.topic, &error),
                }
            }
        })
    }

    /// Returns the newest pending payload.
    ///
    /// # Errors
    /// As [`EncodedReader::take`].
    pub fn latest(&self) -> Result<Option<T>, PortError> {
        let mut latest = None;
        while let Some(payload) = self.take()? {
            latest = Some(payload);
        }
        Ok(latest)
    }
}
