//! A line of the transcript.

use messages::{GateVerdict, Outcome};
use serde::{Deserialize, Serialize};
use service::view::{Answered, Meaning, Speaker};

/// A line of the transcript; keys that do not apply are left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Rises from line to line, also over restarts of the console.
    pub id: u64,
    /// Time, milliseconds of the monotonic clock.
    pub at_ms: f64,
    /// Time, milliseconds since 1970.
    pub unix_ms: u64,
    pub who: Speaker,
    pub text: String,
    /// Source of an utterance: typed, browser, microphone, stream, file, gesture.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seq: Option<u64>,
    /// Probability of the text among all that it may have been.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f32>,
    /// Result of each recogniser, if two were asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub recognisers: Option<Recognisers>,
    /// Why it is not acted on: `no_words`, `other_talk`, `no_speech` or `covered`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub verdict: Option<GateVerdict>,
    /// Possible meanings, most likely first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub understood: Vec<Meaning>,
    /// The questions that the policy attributed it to, most probable first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub answers: Vec<Answered>,
    /// Outcome of the interaction that has ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outcome: Option<Outcome>,
    /// Subject of a note of the system.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<Note>,
    /// The robot's prompt, and which presentation of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub said: Option<(u64, u32)>,
}

/// Subject of a note of the system, in values: a page puts them into its own language.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Note {
    /// An interaction has ended, with the line's `outcome`.
    Ended { object: Option<String>, questions: u32, seconds: f64 },
    /// The motion stop was latched.
    Stopped,
    /// The motion stop was released.
    Released,
    /// A service is not running.
    ServiceLost { service: String },
    /// A service is back, after its previous run ended like that.
    ServiceBack { service: String, exit: Option<String> },
}

/// Result of each recogniser.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Recognisers {
    /// Best words of the first one.
    pub first: String,
    /// Words of the second one; `None` if it was too late.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub second: Option<String>,
}

impl Line {
    pub fn to_text(&self) -> String {
        // Every part of a line can be written.
        serde_json::to_string(self).unwrap_or_default()
    }
}
