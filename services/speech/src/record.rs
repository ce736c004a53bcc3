//! What the speech service must not forget.

use node::Time;
use protocol::{PromptId, RequestKey, UtteranceSeq};
use scene::Question;
use serde::{Deserialize, Serialize};

/// A journal record of the speech service.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Record {
    /// An utterance was accepted. From here on it will be applied, once.
    Accepted(Accepted),
    /// A prompt was said to its end. From here on an answer can be meant for it.
    Presented(Said),
}

/// An accepted utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Accepted {
    /// Its number.
    pub seq: UtteranceSeq,
    /// The client's key.
    pub key: RequestKey,
    /// Which piece of the client's sound, and of how many.
    pub segment: (u32, u32),
    /// What was heard with its weight, most likely first; nothing for a gesture without words.
    pub hypotheses: Vec<(String, f64)>,
    /// The point that was pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// [`protocol::Source`] as on the wire.
    pub source: u8,
    /// The last question that had been said to its end when the person began to speak.
    pub heard: Option<Said>,
    /// When the person began to speak.
    pub onset: Time,
    /// When the person had ended.
    pub end: Time,
    /// When it was accepted.
    pub accepted: Time,
}

/// A prompt that was said to its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Said {
    /// The prompt.
    pub prompt: PromptId,
    /// Which presentation of it.
    pub presentation: u32,
    /// What it asked; none for a mere remark.
    pub question: Question,
    /// Key of the scene that it asked about.
    pub scene_key: u64,
    /// When its sound began.
    pub started: Time,
    /// When its sound ended.
    pub ended: Time,
}
