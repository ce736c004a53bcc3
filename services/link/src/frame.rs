//! Messages of one topic on their way to a mirror.
//!
//! A frame is complete for its topic: the latest message of a state, the last few of others. It is
//! sent on changes, and once a second; a lost frame costs no more than that.

use std::collections::VecDeque;

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use service::bounded::push_bounded;
use service::{Span, Time};

use crate::mirrored::Mirrored;
use crate::offset::Offset;

/// Interval at which everything is sent again.
pub const REPEAT_EVERY: Span = Span::from_ms(1_000);

/// Content sent under a state's key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frame<T> {
    /// Key of the messages' layout; of another one nothing else can be read.
    pub schema: u64,
    /// Number of the sender's start, at random.
    pub start: u64,
    /// When it was sent, nanoseconds of the sender's monotonic clock.
    pub sent_ns: u64,
    /// The messages, oldest first, each with its number from 1 in this start.
    pub messages: Vec<(u64, T)>,
}

/// A frame that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum FrameError {
    /// The messages are of another version.
    #[error(
        "its {0} are of another version of whichone; help: install the same version on both machines"
    )]
    Version(&'static str),
    /// The frame is invalid.
    #[error("expected {0}, found {1}")]
    Invalid(&'static str, String),
}

/// Reads a frame.
///
/// # Errors
/// Not a frame of these messages.
pub fn read<T: Mirrored + DeserializeOwned>(bytes: &[u8]) -> Result<Frame<T>, FrameError> {
    let invalid = |error: postcard::Error| FrameError::Invalid(T::NAME, error.to_string());
    let (schema, _) = postcard::take_from_bytes::<u64>(bytes).map_err(invalid)?;
    if schema != T::key().0 {
        return Err(FrameError::Version(T::NAME));
    }
    let frame: Frame<T> = postcard::from_bytes(bytes).map_err(invalid)?;
    Ok(frame)
}

/// The messages of one topic that are to be sent.
#[derive(Debug)]
pub struct Outgoing<T> {
    schema: u64,
    start: u64,
    /// The last messages, each with its number.
    kept: VecDeque<(u64, T)>,
    /// The newest one without its times, to detect changes.
    newest: Option<T>,
    last_number: u64,
    sent: Option<Time>,
    has_changed: bool,
}

impl<T: Mirrored> Outgoing<T> {
    /// Nothing yet, of the start with this number.
    pub fn new(start: u64) -> Self {
        Self {
            schema: T::key().0,
            start,
            kept: VecDeque::new(),
            newest: None,
            last_number: 0,
            sent: None,
            has_changed: false,
        }
    }

    /// Takes the topic's next message. A state that only differs in its times has not changed.
    pub fn take(&mut self, message: T) {
        let mut timeless = message.clone();
        timeless.times(&mut |time| *time = 0);
        let is_same = T::KEPT == 1 && self.newest.as_ref() == Some(&timeless);
        self.newest = Some(timeless);
        if !is_same {
            self.last_number += 1;
            self.has_changed = true;
        }
        push_bounded(&mut self.kept, T::KEPT, (self.last_number, message));
    }

    /// Returns the frame to be sent at `now`, if one is due.
    pub fn due(&mut self, now: Time) -> Option<Vec<u8>> {
        let pause = if self.has_changed { T::PAUSE } else { REPEAT_EVERY };
        let is_due = self.sent.is_none_or(|sent| now >= sent + pause);
        if !is_due || self.kept.is_empty() {
            return None;
        }
        self.sent = Some(now);
        self.has_changed = false;
        let messages = self.kept.iter().cloned().collect();
        let (schema, start) = (self.schema, self.start);
        let frame = Frame { schema, start, sent_ns: now.ns(), messages };
        // Messages of the group can be encoded: they were.
        postcard::to_stdvec(&frame).ok()
    }
}

/// The messages of one topic that have arrived.
#[derive(Debug)]
pub struct Incoming<T> {
    /// The sender's start, and the number of the newest message.
    newest: (u64, u64),
    /// The last messages by the sender's times, so that those of a restarted link are known again.
    known: VecDeque<T>,
}

impl<T> Default for Incoming<T> {
    fn default() -> Self {
        Self { newest: (0, 0), known: VecDeque::new() }
    }
}

impl<T: Mirrored> Incoming<T> {
    /// Returns a frame's new messages, oldest first, in this machine's time: of a state its latest
    /// one in any case, of others each once. Frames that were overtaken are left out.
    pub fn take(&mut self, frame: Frame<T>, now: Time, offset: &mut Offset) -> Vec<T> {
        offset.observe(frame.sent_ns, now);
        if frame.start != self.newest.0 {
            self.newest = (frame.start, 0);
        }
        let mut new = Vec::new();
        for (number, message) in frame.messages {
            let is_old = number < self.newest.1 || (T::KEPT > 1 && number == self.newest.1);
            if is_old {
                continue;
            }
            self.newest.1 = number;
            if T::KEPT > 1 {
                if self.known.contains(&message) {
                    continue;
                }
                push_bounded(&mut self.known, 2 * T::KEPT, message.clone());
            }
            let mut here = message;
            here.times(&mut |time| *time = offset.here(*time));
            new.push(here);
        }
        new
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::{ArmStatus, Presented, Receipt};

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    fn receipt(seq: u64) -> Receipt {
        Receipt { seq, segments: 1, onset_ns: at(seq).ns(), ..Receipt::default() }
    }

    #[test]
    fn states_are_sent_on_change_and_each_second() {
        let mut out = Outgoing::<Presented>::new(1);
        let mut sent = Vec::new();
        for ms in 0..3_000_u64 {
            // Sent again by its writer all the time, with a new time.
            let prompt = if ms < 500 { 1 } else { 2 };
            out.take(Presented { prompt, started_ns: ms, ..Presented::default() });
            if out.due(at(ms)).is_some() {
                sent.push(ms);
            }
        }
        assert_eq!(sent, [0, 500, 1_500, 2_500]);
    }

    #[test]
    fn every_message_of_a_window_arrives_once_whatever_is_lost_doubled_or_overtaken() {
        let mut out = Outgoing::<Receipt>::new(7);
        let mut frames = Vec::new();
        for seq in 1..=40 {
            out.take(receipt(seq));
            frames.extend(out.due(at(seq * 100)));
        }
        let mut into = Incoming::<Receipt>::default();
        let mut offset = Offset::default();
        let mut arrived = Vec::new();
        for (place, bytes) in frames.iter().enumerate() {
            if place % 4 != 0 {
                continue;
            }
            for bytes in [bytes, &frames[place / 2], bytes] {
                let frame = read::<Receipt>(bytes).unwrap();
                let new = into.take(frame, at(100 * place as u64 + 5_000), &mut offset);
                arrived.extend(new.iter().map(|receipt| receipt.seq));
            }
        }
        assert_eq!(arrived, (1..=37).collect::<Vec<_>>());
    }

    #[test]
    fn receipts_of_a_restarted_link_are_known_again() {
        let mut into = Incoming::<Receipt>::default();
        let mut offset = Offset::default();
        let mut arrived = Vec::new();
        for start in [1, 2] {
            let mut out = Outgoing::new(start);
            (1..=3 + start).for_each(|seq| out.take(receipt(seq)));
            let frame = read(&out.due(at(9)).unwrap()).unwrap();
            arrived.extend(into.take(frame, at(5), &mut offset).iter().map(|r: &Receipt| r.seq));
        }
        assert_eq!(arrived, [1, 2, 3, 4, 5]);
    }

    #[test]
    fn times_arrive_in_the_receivers_clock() {
        let mut out = Outgoing::<Presented>::new(1);
        out.take(Presented { prompt: 1, started_ns: at(900_000).ns(), ..Presented::default() });
        let frame = read::<Presented>(&out.due(at(900_300)).unwrap()).unwrap();
        let new = Incoming::default().take(frame, at(1_000), &mut Offset::default());
        assert_eq!((new[0].started_ns, new[0].ended_ns), (at(700).ns(), 0));
    }

    #[test]
    fn frames_of_other_versions_and_nonsense_are_refused() {
        let mut out = Outgoing::<ArmStatus>::new(1);
        out.take(ArmStatus::default());
        let bytes = out.due(at(1)).unwrap();
        assert_eq!(read::<Presented>(&bytes), Err(FrameError::Version("Presented")));
        for cut in 0..bytes.len() {
            assert!(read::<ArmStatus>(&bytes[..cut]).is_err(), "{cut}");
        }
        let flood = postcard::to_stdvec(&(ArmStatus::default_key(), 1_u64, 2_u64, u64::MAX));
        assert!(read::<ArmStatus>(&flood.unwrap()).is_err());
    }

    trait DefaultKey {
        fn default_key() -> u64;
    }

    impl DefaultKey for ArmStatus {
        fn default_key() -> u64 {
            <Self as messages::schema::Schema>::key().0
        }
    }
}
