//! Events of live audio sources.

use std::sync::atomic::{AtomicU64, Ordering};

use messages::{RequestKey, Source};
use serde::{Deserialize, Serialize};
use vocabulary::time::Time;

use super::segment::SpeechSegment;

/// An event of a live source. Every utterance that began ends exactly once.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum StreamEvent {
    /// An utterance began.
    Began(Began),
    /// The samples since the previous such event. Optional.
    Samples {
        /// The utterance.
        sound: u64,
        /// One channel at 16 kHz.
        #[serde(with = "crate::unrecorded_sound")]
        samples: Vec<i16>,
    },
    /// The speaker paused: unless speech continues, the end carries the same segment. Optional.
    Paused {
        /// The utterance.
        sound: u64,
        /// The utterance so far.
        segment: SpeechSegment,
    },
    /// The robot's own voice covers a part of the utterance, which may change its meaning.
    Cut {
        /// The utterance.
        sound: u64,
    },
    /// The utterance ended.
    Ended {
        /// The utterance.
        sound: u64,
        /// Samples of the utterance.
        segment: SpeechSegment,
    },
    /// The microphone was opened without speech, or could not be opened.
    Silent {
        /// The requested sound.
        sound: u64,
        /// Reason, for users.
        reason: String,
    },
    /// A client's stream ended.
    Closed {
        /// The stream.
        stream: RequestKey,
        /// Number of utterances in the stream.
        utterances: u32,
        /// Samples lost in transit.
        lost: u64,
    },
}

impl StreamEvent {
    /// Returns whether the event is optional.
    pub fn is_optional(&self) -> bool {
        matches!(self, Self::Samples { .. } | Self::Paused { .. })
    }
}

/// Numbers an utterance by the time of its onset.
pub(crate) type Begin<'a> = &'a mut dyn FnMut(Time) -> Began;

/// The beginning of an utterance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Began {
    /// Number of the sound: that of the request which opened the microphone, otherwise a new one
    /// ([`next_sound`]).
    pub sound: u64,
    /// When the speech began.
    pub at: Time,
    /// The stream that contains the utterance.
    pub stream: RequestKey,
    /// Number of the utterance within a client's stream: the tenth of a second in which it began.
    /// `None` for a microphone's.
    pub segment: Option<u32>,
    /// Source of the utterance.
    pub source: Source,
    /// `true` if the utterance interrupts the robot.
    pub interrupts: bool,
}

/// First number of the sounds that live sources number; the reducer uses the numbers below.
pub const LIVE_FROM: u64 = 1 << 32;

/// Returns a number that no other live sound of this process has.
pub fn next_sound() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(LIVE_FROM);
    NEXT.fetch_add(1, Ordering::Relaxed)
}
