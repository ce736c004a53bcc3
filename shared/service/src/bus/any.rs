//! Readers of any topic, for programs that look at all of them.

use super::open::of_type;
use super::{Bus, BusError, EncodedReader, PortError, Reader, WireMessage};
use messages::schema::Schema;
use messages::topics::Topic;
use messages::{PolicyView, Stamp};
use std::any::Any;
use std::fmt::Debug;

/// A message of any topic, where it lies in shared memory.
#[derive(Clone, Copy, Debug)]
pub enum AnyMessage<'a> {
    /// Of fixed layout: its bytes, and the message for those who know its type.
    Fixed(&'a [u8], &'a dyn Any),
    /// A payload in postcard; nothing has decoded it yet.
    Encoded(&'a [u8]),
}

/// Reads a topic without knowing its type.
pub trait AnyReader: Debug {
    /// Hands over the messages that wait, oldest first, with their stamps. It ends even where a writer
    /// sends as fast as it is read.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    fn drain(&self, take: &mut dyn FnMut(&Stamp, AnyMessage<'_>)) -> Result<(), PortError>;
}

impl Bus {
    /// Reads a topic whatever its payload, with the buffer of a recorder ([`Topic::buffer_max`]).
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn any_reader(&self, topic: &Topic) -> Result<Box<dyn AnyReader>, BusError> {
        let buffer = topic.buffer_max();
        Ok(of_type!(topic,
        T => Box::new(self.buffered_reader::<T>(topic, buffer)?),
        // The type matters only to those who decode.
        else Box::new(self.buffered_encoded_reader::<PolicyView>(topic, buffer)?)))
    }
}

impl<T: WireMessage> AnyReader for Reader<T> {
    fn drain(&self, take: &mut dyn FnMut(&Stamp, AnyMessage<'_>)) -> Result<(), PortError> {
        self.drain_stamped(|message, stamp| take(stamp, AnyMessage::Fixed(bytes(message), message)))
    }
}

impl<T: Schema + Debug> AnyReader for EncodedReader<T> {
    fn drain(&self, take: &mut dyn FnMut(&Stamp, AnyMessage<'_>)) -> Result<(), PortError> {
        self.drain_stamped(|payload, stamp| {
            take(stamp, AnyMessage::Encoded(payload));
            Ok(())
        })
    }
}

fn bytes<T: WireMessage>(message: &T) -> &[u8] {
    // SAFETY: a message of fixed layout has no padding (the test of the wire layout checks each), so that
    // every byte of it is initialised.
    #[allow(unsafe_code)]
    unsafe {
        std::slice::from_raw_parts(std::ptr::from_ref(message).cast(), size_of::<T>())
    }
}
