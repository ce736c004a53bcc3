//! Inputs and outputs of the reducer.

use messages::{MessageRef, Observation, Utterance};
use serde::{Deserialize, Serialize};
use service::Time;

/// Events delivered to the reducer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum In<'a> {
    /// An utterance, from speech.
    Utterance(MessageRef<'a, Utterance>),
    /// Outcome of a request to the model.
    Answer(ModelAnswer),
}

/// Messages published, and requests to the model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Out {
    /// To the policy.
    Observation(Box<Observation>),
    /// To the model.
    Ask(ModelRequest),
}

/// A request to the model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ModelRequest {
    /// Identifies the request in the answer.
    pub ticket: u64,
    /// When the answer counts no longer, monotonic clock.
    pub due: Time,
    /// The utterance, as [`model_reader::utterance`] writes it.
    pub utterance: String,
}

/// Outcome of a request to the model.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ModelAnswer {
    /// The request.
    pub ticket: u64,
    /// The text of the answer; or in a sentence why there is none.
    pub content: Result<String, String>,
}
