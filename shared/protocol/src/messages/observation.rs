//! What an utterance was understood to say.

use crate::messages::common::{WireQuestion, checked_weight};
use crate::messages::gesture::WireGesture;
use crate::messages::utterance::HYPOTHESES_MAX;
use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::{self, WireError};
use iceoryx2::prelude::ZeroCopySend;
use scene::{Reading, WordId};

/// Scene words of one reading.
pub const BASE_WORDS_MAX: usize = 32;
/// Excluded groups of one reading.
pub const EXCLUDED_GROUPS_MAX: usize = 8;
/// Words of one excluded group.
pub const EXCLUDED_WORDS_MAX: usize = 6;
wire_struct! {
    /// A [`Reading`] on the wire.
    WireReading = "Reading" {
        /// Probability among the readings; they sum to 1.
        weight: f64,
        /// [`scene::Response`]: 0 none, 1 yes, 2 no.
        response: u8,
        /// [`scene::Intent`], in its order.
        intent: u8,
        /// Used entries of `base`.
        base_count: u8,
        /// Used entries of `excluded`.
        excluded_count: u8,
        /// Used words of each excluded group.
        excluded_len: [u8; EXCLUDED_GROUPS_MAX],
        /// Zero.
        reserved: [u8; 4],
        /// [`WordId`]s.
        base: [u16; BASE_WORDS_MAX],
        /// [`WordId`]s by group.
        excluded: [[u16; EXCLUDED_WORDS_MAX]; EXCLUDED_GROUPS_MAX],
    }
}

impl WireReading {
    /// The reading with its weight; words beyond the bounds are left out, and the caller told.
    pub fn new(reading: &Reading, weight: f64) -> (Self, Fits) {
        let mut wire = Self {
            weight,
            response: wire::response_code(reading.response),
            intent: wire::intent_code(reading.intent),
            base_count: reading.base.len().min(BASE_WORDS_MAX) as u8,
            excluded_count: reading.excluded.len().min(EXCLUDED_GROUPS_MAX) as u8,
            ..Self::default()
        };
        copy_words(&mut wire.base, &reading.base);
        let mut fits =
            reading.base.len() <= BASE_WORDS_MAX && reading.excluded.len() <= EXCLUDED_GROUPS_MAX;
        for (i, group) in reading.excluded.iter().take(EXCLUDED_GROUPS_MAX).enumerate() {
            wire.excluded_len[i] = copy_words(&mut wire.excluded[i], group) as u8;
            fits &= group.len() <= EXCLUDED_WORDS_MAX;
        }
        (wire, if fits { Fits::Whole } else { Fits::Cut })
    }

    /// The reading and its weight. `words` is `|V|` of the scene.
    ///
    /// # Errors
    /// Counts, codes or words that make no sense in such a scene.
    pub fn reading(&self, words: usize) -> Result<(f64, Reading), WireError> {
        let base = checked_words(&self.base, self.base_count, words)?;
        let groups = self
            .excluded
            .get(..usize::from(self.excluded_count))
            .ok_or(WireError::new("excluded count", self.excluded_count.into()))?;
        let excluded = groups
            .iter()
            .zip(self.excluded_len)
            .map(|(group, len)| checked_words(group, len, words))
            .collect::<Result<_, _>>()?;
        let reading = Reading {
            base,
            excluded,
            response: wire::response_from(self.response)?,
            intent: wire::intent_from(self.intent)?,
        };
        Ok((checked_weight(self.weight)?, reading))
    }
}

/// Whether everything fitted into a fixed layout.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fits {
    /// All of it.
    Whole,
    /// Something was left out.
    Cut,
}

fn copy_words(slots: &mut [u16], words: &[WordId]) -> usize {
    slots.iter_mut().zip(words).map(|(slot, word)| *slot = word.0).count()
}

fn checked_words(slots: &[u16], count: u8, known: usize) -> Result<Vec<WordId>, WireError> {
    let used = slots.get(..usize::from(count)).ok_or(WireError::new("word count", count.into()))?;
    used.iter()
        .map(|&w| {
            if usize::from(w) < known {
                Ok(WordId(w))
            } else {
                Err(WireError::new("word", w.into()))
            }
        })
        .collect()
}

wire_struct! {
    /// What an utterance was understood to say. Grounding to policy, one for each utterance.
    Observation = "Observation" nests [WireReading, WireQuestion, WireGesture] {
        /// The utterance's [`UtteranceSeq`].
        seq: u64,
        /// Of the utterance.
        heard_prompt: u64,
        /// Of the utterance.
        heard_question: WireQuestion,
        /// Of the utterance.
        gesture: WireGesture,
        /// [`scene::Scene::key`] of the scene that it was read with.
        scene_key: u64,
        /// Of the utterance.
        onset_ns: u64,
        /// Of the utterance.
        accepted_ns: u64,
        /// When it was read.
        grounded_ns: u64,
        /// How many of `readings` are used.
        reading_count: u8,
        /// Zero.
        reserved: [u8; 7],
        /// One reading per hypothesis, in its order.
        readings: [WireReading; HYPOTHESES_MAX],
        /// A word that the scene does not have, for the robot's reply; may be empty.
        unknown: FixedText<60>,
    }
}

impl Observation {
    /// The readings with their weights. `words` is `|V|` of the scene.
    ///
    /// # Errors
    /// As [`WireReading::reading`]; or none or too many readings.
    pub fn readings(&self, words: usize) -> Result<Vec<(f64, Reading)>, WireError> {
        let count = usize::from(self.reading_count);
        match self.readings.get(..count) {
            Some(used) if count > 0 => used.iter().map(|r| r.reading(words)).collect(),
            _ => Err(WireError::new("reading count", self.reading_count.into())),
        }
    }
}
