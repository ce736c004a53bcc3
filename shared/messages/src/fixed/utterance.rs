//! An accepted utterance.

use crate::fixed::common::{AskedQuestion, WireGesture, checked_share, used};
use crate::schema::wire_struct;
use crate::text::{FixedText, TextTooLong};
use crate::wire::{Code, WireError, wire_enum};
use iceoryx2::prelude::ZeroCopySend;
use serde::{Deserialize, Serialize};
use vocabulary::PERSON_BYTES_MAX;

/// Longest utterance, all hypotheses together, in bytes.
pub const UTTERANCE_BYTES_MAX: usize = 16_380;
/// Hypotheses of one utterance.
pub const HYPOTHESES_MAX: usize = 5;
/// Words of one hypothesis whose confidence is published.
pub const CONFIDENCES_MAX: usize = 32;
/// Presentations of questions that an utterance may answer.
pub const ASKED_MAX: usize = 4;
wire_enum! {
    /// Origin of an utterance.
    Source {
        /// Typed or injected text.
        Text = 0,
        /// A WAV file.
        Wav = 1,
        /// A microphone.
        Microphone = 2,
        /// A browser's own recogniser.
        Browser = 3,
        /// A pointing gesture, with or without words.
        Gesture = 4,
    }
}

wire_struct! {
    /// A [`Hypothesis`] on the wire: where its words lie in the utterance's text, and how sure it is.
    WireHypothesis = "Hypothesis" {
        /// First byte.
        start: u32,
        /// Bytes.
        len: u32,
        /// Probability among the hypotheses; they sum to 1.
        weight: f64,
        /// Confidence of each blank-separated word: 0 (not said) to 255 (certain). Unknown for
        /// words beyond these.
        confidence: [u8; CONFIDENCES_MAX],
    }
}

/// One recognised wording of an utterance.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Hypothesis {
    /// The words.
    pub text: String,
    /// Relative weight among the hypotheses, above 0.
    pub weight: f64,
    /// Probability of each blank-separated word, 0 to 1. Words beyond the end are certain.
    pub word_confidence: Vec<f32>,
}

impl Hypothesis {
    /// Returns the only hypothesis of a typed text.
    pub fn certain(text: impl Into<String>) -> Self {
        Self { text: text.into(), weight: 1.0, word_confidence: Vec::new() }
    }

    /// Returns a hypothesis of words with their confidences.
    pub fn of_words(words: impl IntoIterator<Item = (String, f32)>, weight: f64) -> Self {
        let (words, word_confidence): (Vec<_>, Vec<_>) = words.into_iter().unzip();
        Self { text: words.join(" "), weight, word_confidence }
    }
}

wire_struct! {
    /// An accepted utterance. Speech to grounding.
    Utterance = "Utterance" {
        /// `UtteranceSeq`.
        seq: u64,
        /// The latest questions whose sound had begun when the utterance was accepted, newest
        /// first.
        asked: [AskedQuestion; ASKED_MAX],
        /// Target of the pointing gesture, if any.
        gesture: WireGesture,
        /// When the person began to speak or type.
        onset_ns: u64,
        /// When the person had ended.
        end_ns: u64,
        /// When it was accepted.
        accepted_ns: u64,
        /// [`Source`].
        source: Code<Source>,
        /// Number of used entries of `hypotheses`; the first is the best. 0 for a gesture without
        /// words.
        hypothesis_count: u8,
        /// Number of used entries of `asked`.
        asked_count: u8,
        /// Zero.
        reserved: u8,
        /// Name of the person who speaks; empty: nobody in particular.
        from: FixedText<PERSON_BYTES_MAX>,
        /// Recognition hypotheses, most likely first.
        hypotheses: [WireHypothesis; HYPOTHESES_MAX],
        /// The text of all hypotheses, one after another.
        text: FixedText<UTTERANCE_BYTES_MAX>,
    }
}

impl Utterance {
    /// Sets the hypotheses; weights are normalised.
    ///
    /// # Errors
    /// Their texts together are longer than [`UTTERANCE_BYTES_MAX`].
    pub fn set_hypotheses(&mut self, heard: &[Hypothesis]) -> Result<(), TextTooLong> {
        let used = &heard[..heard.len().min(HYPOTHESES_MAX)];
        let total: f64 = used.iter().map(|heard| heard.weight).sum();
        let mut text = String::new();
        for (slot, heard) in self.hypotheses.iter_mut().zip(used) {
            let (start, len) = (text.len() as u32, heard.text.len() as u32);
            let confidence = confidence_codes(&heard.word_confidence);
            *slot = WireHypothesis { start, len, weight: heard.weight / total, confidence };
            text.push_str(&heard.text);
        }
        self.hypothesis_count = used.len() as u8;
        self.text = FixedText::new(&text)?;
        Ok(())
    }

    /// The hypotheses, most likely first.
    ///
    /// # Errors
    /// Counts, spans, weights or bytes that make no sense.
    pub fn hypotheses(&self) -> Result<Vec<Hypothesis>, WireError> {
        let text = self.text.as_str()?;
        used(&self.hypotheses, self.hypothesis_count, "hypothesis count")?
            .iter()
            .map(|h| {
                let end = h.start.saturating_add(h.len) as usize;
                let words = text.get(h.start as usize..end);
                let text = words.ok_or(WireError::new("hypothesis span", h.start))?.to_owned();
                let weight = checked_share("weight", h.weight)?;
                Ok(Hypothesis { text, weight, word_confidence: confidences(&h.confidence) })
            })
            .collect()
    }

    /// Sets the questions that it may answer, newest first; at most [`ASKED_MAX`].
    pub fn set_asked(&mut self, asked: &[AskedQuestion]) {
        let used = self.asked.iter_mut().zip(asked);
        self.asked_count = used.map(|(slot, asked)| *slot = *asked).count() as u8;
    }

    /// The questions that it may answer, newest first.
    ///
    /// # Errors
    /// A count that makes no sense.
    pub fn asked(&self) -> Result<&[AskedQuestion], WireError> {
        used(&self.asked, self.asked_count, "asked count")
    }
}

const CERTAIN: u8 = u8::MAX;

fn confidence_codes(confidence: &[f32]) -> [u8; CONFIDENCES_MAX] {
    let mut codes = [CERTAIN; CONFIDENCES_MAX];
    for (code, confidence) in codes.iter_mut().zip(confidence) {
        *code = (confidence.clamp(0.0, 1.0) * f32::from(CERTAIN)).round() as u8;
    }
    codes
}

/// The confidences up to the last word that is not certain.
fn confidences(codes: &[u8; CONFIDENCES_MAX]) -> Vec<f32> {
    let known = codes.iter().rposition(|code| *code != CERTAIN).map_or(0, |last| last + 1);
    codes[..known].iter().map(|code| f32::from(*code) / f32::from(CERTAIN)).collect()
}
