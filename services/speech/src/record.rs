//! Journal records of the speech service.

use dialogue::Presentation;
use messages::{RequestKey, Source, UtteranceSeq};
use serde::{Deserialize, Serialize};
use service::Time;

use crate::Hypothesis;

/// A journal record of the speech service.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Record {
    /// An utterance was accepted. It will be applied exactly once.
    Accepted(Accepted),
    /// A prompt was spoken, to its end or until it was interrupted. Later answers may refer to it.
    Presented(Presentation),
}

/// An accepted utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accepted {
    /// Its number.
    pub seq: UtteranceSeq,
    /// The client's key.
    pub key: RequestKey,
    /// Number and total of the segment in the client's sound.
    pub segment: (u32, u32),
    /// Hypotheses, most likely first; none for a gesture without words.
    pub hypotheses: Vec<Hypothesis>,
    /// The point that was pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Origin of the utterance.
    pub source: Source,
    /// The latest questions whose sound had begun by then, newest first.
    pub asked: Vec<Presentation>,
    /// When the speech began.
    pub onset: Time,
    /// When the speech ended.
    pub end: Time,
    /// Signal-to-noise ratio, decibels; 0 for text.
    pub snr_db: f32,
    /// When it was accepted.
    pub accepted: Time,
}
