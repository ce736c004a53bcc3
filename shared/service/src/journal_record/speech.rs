use messages::{Hypothesis, Source};
use serde::{Deserialize, Serialize};

use crate::view::QuestionView;

/// A record of the speech service.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum SpeechRecord {
    /// An utterance was accepted.
    Accepted(AcceptedRecord),
    /// A line of the robot was spoken, to its end or until it was interrupted.
    Presented(PresentationRecord),
    /// A user ordered a stop.
    StopOrdered {
        /// When.
        given_ns: u64,
    },
    /// The arm has carried out a stop that a user ordered, or obeys a later order.
    StopSettled {
        /// When the stop was ordered.
        given_ns: u64,
    },
}

/// An accepted utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AcceptedRecord {
    /// Number of the utterance.
    pub utterance: u64,
    /// The words as they were most likely said; empty for a gesture without words.
    pub text: String,
    /// Probability of these words among the hypotheses.
    pub confidence: f64,
    /// Every hypothesis, most likely first.
    pub hypotheses: Vec<Hypothesis>,
    /// Source of the utterance.
    pub source: Source,
    /// Name of the person who spoke, if known.
    pub from: Option<String>,
    /// The point that was pointed at, metres, frame `base`.
    pub gesture_m: Option<[f64; 3]>,
    /// The latest questions whose sound had begun by then, newest first.
    pub asked: Vec<PresentationRecord>,
    /// When the speech began.
    pub onset_ns: u64,
    /// When the speech ended.
    pub end_ns: u64,
    /// Signal-to-noise ratio, decibels; `None` for text.
    pub snr_db: Option<f32>,
    /// Index of the part of the client's sound, from 0, and the number of parts.
    pub segment: u32,
    /// Number of parts of the client's sound; 0 while that is not known.
    pub segments: u32,
    /// The client's key of the request, hexadecimal.
    pub key: String,
}

/// One presentation of a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PresentationRecord {
    /// Number of the line.
    pub prompt: u64,
    /// Number of the prompt's presentation, from 1.
    pub presentation: u32,
    /// The question; `None` if its scene is no longer known.
    pub question: Option<QuestionView<String>>,
    /// Start of the presentation's sound.
    pub began_ns: u64,
    /// End of the sound; `None` while it plays.
    pub ended_ns: Option<u64>,
    /// Whether it was said to its end.
    pub complete: bool,
}
