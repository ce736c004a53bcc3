//! An accepted utterance.

use crate::messages::common::{WireQuestion, checked_weight};
use crate::messages::gesture::WireGesture;
use crate::schema::wire_struct;
use crate::text::{FixedText, TextTooLong};
use crate::wire::{WireError, wire_enum};
use iceoryx2::prelude::ZeroCopySend;

/// Longest utterance, all hypotheses together, in bytes.
pub const UTTERANCE_BYTES_MAX: usize = 16_380;
/// Hypotheses of one utterance.
pub const HYPOTHESES_MAX: usize = 5;
wire_enum! {
    /// Where an utterance came from.
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
    /// A hypothesis: where its words lie in the utterance's text, and how likely it is.
    Hypothesis = "Hypothesis" {
        /// First byte.
        start: u32,
        /// Bytes.
        len: u32,
        /// Probability among the hypotheses; they sum to 1.
        weight: f64,
    }
}

wire_struct! {
    /// An accepted utterance. Speech to grounding.
    Utterance = "Utterance" nests [WireQuestion, WireGesture, Hypothesis] {
        /// [`UtteranceSeq`].
        seq: u64,
        /// [`PromptId`] of the last question whose presentation had ended when the person began
        /// to speak.
        heard_prompt: u64,
        /// That question.
        heard_question: WireQuestion,
        /// [`scene::Scene::key`] of the scene that it was asked about.
        heard_scene: u64,
        /// Where the person points, if anywhere.
        gesture: WireGesture,
        /// When the person began to speak or type.
        onset_ns: u64,
        /// When the person had ended.
        end_ns: u64,
        /// When it was accepted.
        accepted_ns: u64,
        /// [`Source`].
        source: u8,
        /// How many of `hypotheses` are used; the first is the best. 0 for a gesture without words.
        hypothesis_count: u8,
        /// Zero.
        reserved: [u8; 6],
        /// What was heard, most likely first.
        hypotheses: [Hypothesis; HYPOTHESES_MAX],
        /// The text of all hypotheses, one after another.
        text: FixedText<UTTERANCE_BYTES_MAX>,
    }
}

impl Utterance {
    /// Sets the hypotheses; weights are normalised.
    ///
    /// # Errors
    /// Their texts together are longer than [`UTTERANCE_BYTES_MAX`].
    pub fn set_hypotheses(&mut self, hypotheses: &[(String, f64)]) -> Result<(), TextTooLong> {
        let used = &hypotheses[..hypotheses.len().min(HYPOTHESES_MAX)];
        let total: f64 = used.iter().map(|(_, weight)| weight).sum();
        let mut text = String::new();
        for (slot, (words, weight)) in self.hypotheses.iter_mut().zip(used) {
            let (start, len) = (text.len() as u32, words.len() as u32);
            *slot = Hypothesis { start, len, weight: weight / total };
            text.push_str(words);
        }
        self.hypothesis_count = used.len() as u8;
        self.text = FixedText::new(&text)?;
        Ok(())
    }

    /// The hypotheses with their weights, most likely first.
    ///
    /// # Errors
    /// Counts, spans, weights or bytes that make no sense.
    pub fn hypotheses(&self) -> Result<Vec<(&str, f64)>, WireError> {
        let count = usize::from(self.hypothesis_count);
        let used = self
            .hypotheses
            .get(..count)
            .ok_or(WireError::new("hypothesis count", self.hypothesis_count.into()))?;
        let text = self.text.as_str()?;
        used.iter()
            .map(|h| {
                let end = h.start.saturating_add(h.len) as usize;
                let words = text.get(h.start as usize..end);
                let words = words.ok_or(WireError::new("hypothesis span", h.start))?;
                let weight = checked_weight(h.weight)?;
                Ok((words, weight))
            })
            .collect()
    }
}
