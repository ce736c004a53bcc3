//! What the speech service must not forget.

use messages::{PresentationState, Presented, PromptId, RequestKey, Source, UtteranceSeq};
use scene::Question;
use serde::{Deserialize, Serialize};
use service::Time;

/// A journal record of the speech service.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Record {
    /// An utterance was accepted. From here on it will be applied, once.
    Accepted(Accepted),
    /// A prompt was said, to its end or until it was broken off. From here on an answer can be
    /// meant for it.
    Presented(Said),
}

/// One way to understand an utterance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hypothesis {
    /// The words.
    pub text: String,
    /// Relative weight among the hypotheses, above 0.
    pub weight: f64,
    /// How sure each blank-separated word is, 0 to 1; those beyond the end are certain.
    pub confidence: Vec<f32>,
}

impl Hypothesis {
    /// Words that are certain: typed ones.
    pub fn certain(text: impl Into<String>) -> Self {
        Self { text: text.into(), weight: 1.0, confidence: Vec::new() }
    }
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
    /// What was heard, most likely first; nothing for a gesture without words.
    pub hypotheses: Vec<Hypothesis>,
    /// The point that was pointed at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Where it came from.
    pub source: Source,
    /// The latest questions whose sound had begun by then, newest first.
    pub asked: Vec<Said>,
    /// When the person began to speak.
    pub onset: Time,
    /// When the person had ended.
    pub end: Time,
    /// How far the speech stood above the noise around it, decibels; 0 for text.
    pub snr_db: f32,
    /// When it was accepted.
    pub accepted: Time,
}

/// A prompt that was said.
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
    /// When its sound ended or was broken off; its beginning while it lasts.
    pub ended: Time,
    /// Whether it was said to its end.
    pub whole: bool,
}

impl Said {
    /// As the policy and the console get it.
    pub(crate) fn presented(&self, state: PresentationState) -> Presented {
        Presented {
            prompt: self.prompt.0,
            presentation: self.presentation,
            started_ns: self.started.ns(),
            ended_ns: self.ended.ns(),
            state: state.code(),
            ..Presented::default()
        }
    }
}
