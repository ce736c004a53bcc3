//! Topics as bytes, for tests of services: written whatever the bytes mean, and read whoever sent them.

use super::any::bytes;
use super::open::{notifiers, of_type, open_topic};
use super::ports::subscribe;
use super::renewed::Renewed;
use super::{Bus, BusError, EncodedWriter, Ipc, PortError, WireMessage, Writer};
use iceoryx2::port::subscriber::Subscriber;
use messages::topics::Topic;
use messages::{PolicyView, Stamp};
use std::fmt::Debug;

/// Writes bytes to a topic.
pub trait RawWriter: Debug {
    /// Sends the bytes; those of a message of fixed layout are filled up with zeros, or cut.
    ///
    /// # Errors
    /// iceoryx2 is out of memory.
    fn send(&self, bytes: &[u8]) -> Result<(), PortError>;
}

/// Reads a topic without judging anything.
pub trait RawReader: Debug {
    /// Hands over the messages that wait, oldest first, with their stamps; also those of other epochs and
    /// incarnations, and those that make no sense.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    fn drain(&self, take: &mut dyn FnMut(&Stamp, &[u8])) -> Result<(), PortError>;
}

impl Bus {
    /// Writes bytes to a topic, for tests of the services that read it.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn raw_writer(&self, topic: &Topic) -> Result<Box<dyn RawWriter>, BusError> {
        Ok(of_type!(topic,
            T => Box::new(self.writer::<T>(topic)?),
            // The type matters only to those who decode.
            else Box::new(self.encoded_writer::<PolicyView>(topic)?)))
    }

    /// Reads a topic without judging anything, for tests of the service that writes it.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn raw_reader(&self, topic: &Topic) -> Result<Box<dyn RawReader>, BusError> {
        let pending_max = topic.buffer * topic.writers_max;
        Ok(of_type!(topic,
        T => {
            let subscriber = subscribe(open_topic!(self, topic, T)?, topic, topic.buffer)?;
            Box::new(FixedRaw::<T> { topic: topic.name, pending_max, subscriber })
        },
        else {
            let subscriber = subscribe(open_topic!(self, topic, [u8])?, topic, topic.buffer)?;
            Box::new(EncodedRaw { topic: topic.name, pending_max, subscriber })
        }))
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

impl<T: WireMessage + Default> RawWriter for Writer<T> {
    fn send(&self, bytes: &[u8]) -> Result<(), PortError> {
        let mut message = T::default();
        let len = bytes.len().min(size_of::<T>());
        // SAFETY: a message of fixed layout is made of numbers and of codes, which are bytes until they are checked
        // ([`messages::wire`]): any bytes are a value of it. Source and target are apart and hold `len` bytes.
        #[allow(unsafe_code)]
        unsafe {
            let target = std::ptr::from_mut(&mut message).cast::<u8>();
            std::ptr::copy_nonoverlapping(bytes.as_ptr(), target, len);
        }
        Writer::send(self, &message)
    }
}

impl RawWriter for EncodedWriter<PolicyView> {
    fn send(&self, bytes: &[u8]) -> Result<(), PortError> {
        self.send_bytes(bytes)
    }
}

#[derive(Debug)]
struct FixedRaw<T: WireMessage> {
    topic: &'static str,
    pending_max: usize,
    subscriber: Renewed<Subscriber<Ipc, T, Stamp>>,
}

impl<T: WireMessage> RawReader for FixedRaw<T> {
    fn drain(&self, take: &mut dyn FnMut(&Stamp, &[u8])) -> Result<(), PortError> {
        self.subscriber.with(|subscriber| {
            for _ in 0..self.pending_max {
                let received = subscriber.receive();
                let received =
                    received.map_err(|e| PortError::new(self.topic, format!("{e:?}")))?;
                let Some(sample) = received else { break };
                take(sample.user_header(), bytes(sample.payload()));
            }
            Ok(())
        })
    }
}

#[derive(Debug)]
struct EncodedRaw {
    topic: &'static str,
    pending_max: usize,
    subscriber: Renewed<Subscriber<Ipc, [u8], Stamp>>,
}

impl RawReader for EncodedRaw {
    fn drain(&self, take: &mut dyn FnMut(&Stamp, &[u8])) -> Result<(), PortError> {
        self.subscriber.with(|subscriber| {
            for _ in 0..self.pending_max {
                let received = subscriber.receive();
                let received =
                    received.map_err(|e| PortError::new(self.topic, format!("{e:?}")))?;
                let Some(sample) = received else { break };
                take(sample.user_header(), sample.payload());
            }
            Ok(())
        })
    }
}
