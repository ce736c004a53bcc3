//! Reads utterances with a language model behind HTTP, in the chat-completions form: the prompt of
//! a scene, the request, the strict reading of the answer, and the calibration of its weights.
//!
//! Only [`Client`] does IO; everything else is pure, so that a replay needs no model.

mod answer;
mod calibration;
mod client;
mod prompt;
mod settings;

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;

pub use answer::{AnswerError, ModelReading, parse};
pub use calibration::{Case, LOSS_FLOOR, calibrated, fit, held_out_loss, log_loss};
pub use client::{Client, ClientError};
pub use prompt::{Prompt, utterance};
pub use settings::{Calibration, Configured, LanguageModel};

/// True if requests over https are compiled in.
pub const TLS: bool = cfg!(feature = "tls");

/// The section of the language model.
pub static PART: config::Part = config::Part {
    name: "model_reader",
    service: None,
    sections: &[config::Registered::of::<Configured>()],
};
