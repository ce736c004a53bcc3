//! The first recogniser's result for an utterance.

use crate::audio::VoiceEvidence;
use messages::Hypothesis;

/// The first recogniser's view of one utterance, as far as it has one.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct FirstView {
    /// Hypotheses with different texts, best first; empty if nothing was recognised.
    pub hypotheses: Vec<Hypothesis>,
    /// Length of the words on the best path and of other speech between them, without pauses and
    /// noises, seconds; 0 without a word on it.
    pub words_s: Option<f32>,
    /// Share of voice in the sound, if noise reduction has shown it.
    pub voice: Option<VoiceEvidence>,
}

impl From<Vec<Hypothesis>> for FirstView {
    fn from(hypotheses: Vec<Hypothesis>) -> Self {
        Self { hypotheses, ..Self::default() }
    }
}
