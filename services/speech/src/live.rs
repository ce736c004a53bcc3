//! An utterance while it is being heard.

use std::sync::atomic::{AtomicU64, Ordering};

use messages::{RequestKey, Source};
use service::Time;

use crate::devices::stream::Cut;

/// What a live source has to tell. Every utterance that began ends exactly once.
#[derive(Clone, Debug, PartialEq)]
pub enum Live {
    /// Somebody began to speak.
    Began(Began),
    /// What was said since this was told last. May be missing.
    SoFar {
        /// The utterance.
        sound: u64,
        /// One channel at 16 kHz.
        samples: Vec<i16>,
    },
    /// Who speaks has paused: perhaps this is all, and then its end tells the same. May be missing.
    Paused {
        /// The utterance.
        sound: u64,
        /// What was heard so far.
        cut: Cut,
    },
    /// Whoever spoke has ended; the sound is to be decoded.
    Ended {
        /// The utterance.
        sound: u64,
        /// What was heard.
        cut: Cut,
    },
    /// Nobody spoke although the microphone was opened for it, or it could not be opened.
    Silent {
        /// The sound that was asked for.
        sound: u64,
        /// Why nothing was heard, in words for people.
        reason: String,
    },
    /// A client's stream is over; nothing more comes of it.
    Over {
        /// The stream.
        stream: RequestKey,
        /// Utterances that were in it.
        utterances: u32,
        /// Samples of it that were lost on their way.
        lost: u64,
    },
}

impl Live {
    /// Whether the service does as well without it.
    pub fn is_hint(&self) -> bool {
        matches!(self, Self::SoFar { .. } | Self::Paused { .. })
    }
}

/// The beginning of an utterance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Began {
    /// Number of the sound: that of the request which opened the microphone, else a new one
    /// ([`next_sound`]).
    pub sound: u64,
    /// When the person began to speak.
    pub at: Time,
    /// The stream that it is in.
    pub stream: RequestKey,
    /// Which utterance of a client's stream: the tenth of a second in which it began. None for a
    /// microphone's, which stands alone.
    pub segment: Option<u32>,
    /// Where it comes from.
    pub source: Source,
    /// Whether the robot shall fall silent for it.
    pub interrupts: bool,
}

/// Sounds that live sources number themselves begin here; below are those that the reducer numbers.
pub const LIVE_FROM: u64 = 1 << 32;

/// A number that no other live sound of this process has.
pub fn next_sound() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(LIVE_FROM);
    NEXT.fetch_add(1, Ordering::Relaxed)
}
