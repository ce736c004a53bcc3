//! Readers of any topic, for programs that look at all of them.

use super::gate::reject;
use super::receiver::Receiver;
use super::{Bus, BusError, PortError};
use messages::Stamp;
use messages::layout::{FixedMessage, Layout};
use messages::topics::Topic;
use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

/// Messages that this process's readers of any topic have lost.
static LOST: AtomicU64 = AtomicU64::new(0);

/// Returns how many messages this process has lost because it did not read them in time. Counted by
/// readers of any topic, for topics with one writer; other readers see only what they need.
pub fn lost() -> u64 {
    LOST.load(Ordering::Relaxed)
}

/// A message of any topic, borrowed from shared memory.
#[derive(Clone, Copy, Debug)]
pub enum AnyMessage<'a> {
    /// A message of fixed layout.
    Fixed(FixedMessage<'a>),
    /// A payload in postcard; nothing has decoded it yet.
    Encoded(&'a [u8]),
}

impl Bus {
    /// Reads a topic whatever its payload, with the buffer of a recorder ([`Topic::buffer_max`]).
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn any_reader(&self, topic: &Topic) -> Result<AnyReader, BusError> {
        let receiver = Receiver::open(self, topic, topic.buffer_max())?;
        self.greet(topic);
        let numbers = (topic.writers_max == 1).then(Cell::default);
        Ok(AnyReader { receiver, layout: (topic.layout)(), numbers })
    }
}

/// Reader of a topic of unknown type, which counts lost messages.
#[derive(Debug)]
pub struct AnyReader {
    receiver: Receiver,
    /// Layout of the topic's messages, unless they are encoded.
    layout: Option<Layout>,
    /// Incarnation and number of the latest message, if there is one writer.
    numbers: Option<Cell<(u32, u32)>>,
}

impl AnyReader {
    /// Hands over pending messages with their stamps, oldest first. It ends even if a writer sends
    /// as fast as it is read.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn drain(&self, take: &mut dyn FnMut(&Stamp, AnyMessage<'_>)) -> Result<(), PortError> {
        for _ in 0..self.receiver.pending_max {
            let Some(received) = self.receiver.take()? else { break };
            let (stamp, bytes) = (received.stamp(), received.bytes());
            let message = match &self.layout {
                Some(layout) => FixedMessage::checked(layout, bytes).map(AnyMessage::Fixed),
                None => Ok(AnyMessage::Encoded(bytes)),
            };
            match message {
                Ok(message) => {
                    self.count_lost(stamp);
                    take(stamp, message);
                }
                Err(error) => reject(self.receiver.topic, &error),
            }
        }
        Ok(())
    }

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

/// Messages between two that followed each other, each with incarnation and number of its writer. A
/// number of 0 says that none came before, or that the writer does not count.
fn lost_between(before: (u32, u32), next: (u32, u32)) -> u32 {
    let is_counted = before.0 == next.0 && before.1 != 0;
    if is_counted { next.1.saturating_sub(before.1.saturating_add(1)) } else { 0 }
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
