//! A line of the transcript.

use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

/// Who said it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Who {
    /// Somebody, to the robot.
    Person,
    /// The robot.
    Robot,
    /// Somebody, but not to the robot, or so it seemed.
    Unmeant,
    /// Nobody: something has happened.
    System,
}

/// A line of the transcript; what does not apply to it is left out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Rises from line to line, also over restarts of the console.
    pub id: u64,
    /// When, milliseconds of the monotonic clock.
    pub at_ms: f64,
    /// When, milliseconds since 1970.
    pub unix_ms: u64,
    /// When, hours, minutes and seconds of UTC.
    pub clock: String,
    /// Who said it.
    pub who: Who,
    /// What.
    pub text: String,
    /// How it came: typed, browser, microphone, stream, file, gesture.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub source: String,
    /// Number of the utterance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seq: Option<u64>,
    /// Probability of the text among all that it may have been.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub confidence: Option<f32>,
    /// How far it stood above the noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub snr_db: Option<f32>,
    /// What it may mean, likeliest first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub understood: Vec<Meaning>,
    /// The question that it was taken to answer.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub answers: Option<String>,
    /// What the robot asks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub question: Option<Json>,
    /// How an interaction ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outcome: Option<String>,
    /// Which prompt of the robot's, and which presentation of it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub said: Option<(u64, u32)>,
}

/// One way to understand an utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meaning {
    /// In words: `yes · small · not white`.
    pub text: String,
    /// Its probability.
    pub weight: f64,
}

impl Line {
    /// The line as pages get it.
    pub fn to_text(&self) -> String {
        // Every part of a line can be written.
        serde_json::to_string(self).unwrap_or_default()
    }
}
