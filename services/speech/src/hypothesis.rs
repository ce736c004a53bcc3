//! The hypotheses of a recogniser.

use serde::{Deserialize, Serialize};

/// One way to understand an utterance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hypothesis {
    /// The words; a recogniser's are lower case and separated by single blanks.
    pub text: String,
    /// Weight relative to the other hypotheses of the utterance, above 0.
    pub weight: f64,
    /// Confidence in each blank-separated word, 0 to 1; words beyond the end are certain.
    pub word_confidence: Vec<f32>,
}

impl Hypothesis {
    /// Returns words that are certain, such as typed ones.
    pub fn certain(text: impl Into<String>) -> Self {
        Self { text: text.into(), weight: 1.0, word_confidence: Vec::new() }
    }

    /// Returns the words with their confidences.
    pub fn of_words(words: impl IntoIterator<Item = (String, f32)>, weight: f64) -> Self {
        let (words, word_confidence): (Vec<_>, Vec<_>) = words.into_iter().unzip();
        Self { text: words.join(" "), weight, word_confidence }
    }

    /// Returns the hypothesis as sent to grounding.
    pub(crate) fn view(&self) -> messages::Hypothesis<'_> {
        let confidence = self.word_confidence.clone();
        messages::Hypothesis { text: &self.text, weight: self.weight, confidence }
    }
}
