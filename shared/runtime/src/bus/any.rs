//! Readers of any topic, for programs that look at all of them.

use super::open::of_type;
use super::{Bus, BusError, EncodedReader, PortError, Reader, WireMessage};
use messages::schema::Schema;
use messages::topics::Topic;
use messages::{PolicyView, Stamp};
use std::any::Any;
use std::cell::Cell;
use std::fmt::Debug;
use std::sync::atomic::{AtomicU64, Ordering};

/// Messages that this process's readers of any topic have lost.
static LOST: AtomicU64 = AtomicU64::new(0);

/// Returns how many messages this process has lost because it did not read them in time. Readers of any
/// topic count them, for topics with one writer; others see only what they need.
pub fn lost() -> u64 {
    LOST.load(Ordering::Relaxed)
}

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
        let numbers = (topic.writers_max == 1).then(Cell::default);
        Ok(of_type!(topic,
        T => Box::new(Counted { reader: self.buffered_reader::<T>(topic, buffer)?, numbers }),
        // The type matters only to those who decode.
        else Box::new(Counted {
            reader: self.buffered_encoded_reader::<PolicyView>(topic, buffer)?,
            numbers,
        })))
    }
}

/// A reader that counts what it has lost.
#[derive(Debug)]
struct Counted<R> {
    reader: R,
    /// Incarnation and number of the latest message, where there is one writer.
    numbers: Option<Cell<(u32, u32)>>,
}

impl<R> Counted<R> {
    /// Counts the messages between the latest one and this one.
    fn count_lost(&self, stamp: &Stamp) {
        let Some(numbers) = &self.numbers else { return };
        let lost = lost_between(numbers.get(), (stamp.incarnation, stamp.sequence));
        if lost > 0 {
            LOST.fetch_add(lost.into(), Ordering::Relaxed);
        }
        numbers.set((stamp.incarnation, stamp.sequence));
    }
}

/// Messages between two that followed each other, each with incarnation and number of its writer. A number
/// of 0 says that none came before, or that the writer does not count.
fn lost_between(before: (u32, u32), next: (u32, u32)) -> u32 {
    let is_counted = before.0 == next.0 && before.1 != 0;
    if is_counted { next.1.saturating_sub(before.1.saturating_add(1)) } else { 0 }
}

impl<T: WireMessage> AnyReader for Counted<Reader<T>> {
    fn drain(&self, take: &mut dyn FnMut(&Stamp, AnyMessage<'_>)) -> Result<(), PortError> {
        self.reader.drain_stamped(|message, stamp| {
            self.count_lost(stamp);
            take(stamp, AnyMessage::Fixed(bytes(message), message));
        })
    }
}

impl<T: Schema + Debug> AnyReader for Counted<EncodedReader<T>> {
    fn drain(&self, take: &mut dyn FnMut(&Stamp, AnyMessage<'_>)) -> Result<(), PortError> {
        self.reader.drain_stamped(|payload, stamp| {
            self.count_lost(stamp);
            take(stamp, AnyMessage::Encoded(payload));
            Ok(())
        })
    }
}

pub(super) fn bytes<T: WireMessage>(message: &T) -> &[u8] {
    // SAFETY: a message of fixed layout has no padding (the test of the wire layout checks each), so that
    // every byte of it is initialised.
    #[allow(unsafe_code)]
    unsafe {
        std::slice::from_raw_parts(std::ptr::from_ref(message).cast(), size_of::<T>())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_within_one_start_of_the_writer_are_losses() {
        for (before, next, expected) in [
            ((0, 0), (1, 7), 0),
            ((1, 7), (1, 8), 0),
            ((1, 7), (1, 11), 3),
            ((1, 7), (2, 11), 0),
            ((1, u32::MAX), (1, 1), 0),
            ((1, 7), (1, 0), 0),
            ((1, 7), (1, 7), 0),
        ] {
            assert_eq!(lost_between(before, next), expected, "{before:?} {next:?}");
        }
    }
}
