//! From samples to words.

mod ffi;
mod gate;
mod pocketsphinx;

pub use gate::{Gate, Outcome, RejectReason};
pub use pocketsphinx::{PocketSphinx, PocketSphinxOptions, RecogniserUnavailable};

/// One way to understand an utterance.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// The words, separated by blanks, lower case.
    pub text: String,
    /// Its share among the hypotheses of the utterance, 0 to 1; they sum to 1 at most.
    pub confidence: f32,
    /// Each word with the posterior probability that it was said there, 0 to 1; known of the best
    /// hypothesis only.
    pub words: Vec<(String, f32)>,
}

/// Why an utterance was not decoded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RecogniseError {
    /// The library reported a failure; the next utterance may do better.
    #[error("the recogniser failed on this utterance")]
    Failed,
}

/// Turns an utterance into words.
pub trait Recogniser: Send {
    /// Decodes one whole utterance, 16 kHz mono. The hypotheses come best first, with different
    /// texts; none if nothing was recognised.
    ///
    /// # Errors
    /// If the backend fails on these samples.
    fn recognise(&mut self, pcm: &[i16]) -> Result<Vec<Hypothesis>, RecogniseError>;
}
