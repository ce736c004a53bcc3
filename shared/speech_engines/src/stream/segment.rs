//! Segments of a stream: utterances with their samples.

use std::ops::Range;
use std::time::Duration;

use serde::{Deserialize, Serialize};
use vocabulary::time::Time;

use crate::vad::Closing;

/// An utterance from a stream, with the quiet around it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SpeechSegment {
    /// When the speech began.
    pub onset: Time,
    /// When the speech ended.
    pub end: Time,
    /// Samples to decode, one channel at [`RATE_HZ`].
    #[serde(with = "crate::unrecorded_sound")]
    pub samples: Vec<i16>,
    /// Range of the speech in `samples`.
    pub speech: Range<usize>,
}

impl SpeechSegment {
    /// Returns the pause that closes the utterance if nothing follows this segment.
    pub fn closing(&self, pause: Duration) -> Closing {
        let roll = self.samples.len() - self.speech.end;
        Closing { speech: self.speech.len(), roll, pause_s: pause.as_secs_f64() }
    }
}
