//! The interpretation of an utterance.

use crate::fixed::common::{AskedQuestion, WireGesture, checked_share, used};
use crate::fixed::utterance::{ASKED_MAX, Source};
use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::{Code, WireError, WireField};
use dialogue::Interpretation;
use iceoryx2::prelude::ZeroCopySend;
use scene::{Doubt, Intent, Reading, Response, WordId};

/// Readings of one utterance, for all questions together.
pub const READINGS_MAX: usize = 32;
/// Scene words of one reading.
pub const BASE_WORDS_MAX: usize = 32;
/// Excluded groups of one reading.
pub const EXCLUDED_GROUPS_MAX: usize = 8;
/// Words of one excluded group.
pub const EXCLUDED_WORDS_MAX: usize = 6;
/// [`WireReading::question`] of a reading that answers no question.
pub const NO_QUESTION: u8 = u8::MAX;
wire_struct! {
    /// A [`Reading`] on the wire.
    WireReading = "Reading" {
        /// Probability among the readings for the same question; they sum to 1.
        weight: f64,
        /// By word of `base`: probability that it was not said.
        base_doubt: [f32; BASE_WORDS_MAX],
        /// By excluded group: probability that it was not meant.
        excluded_doubt: [f32; EXCLUDED_GROUPS_MAX],
        /// Probability that the response was not given.
        response_doubt: f32,
        /// [`WordId`]s.
        base: [u16; BASE_WORDS_MAX],
        /// [`WordId`]s by group.
        excluded: [[u16; EXCLUDED_WORDS_MAX]; EXCLUDED_GROUPS_MAX],
        /// Used words of each excluded group.
        excluded_len: [u8; EXCLUDED_GROUPS_MAX],
        /// The question that it is the answer to if the utterance answers that one: its place in
        /// the observation's `asked`, or [`NO_QUESTION`].
        question: u8,
        /// [`scene::Response`]: 0 none, 1 yes, 2 no.
        response: Code<Response>,
        /// [`scene::Intent`], in its order.
        intent: Code<Intent>,
        /// Used entries of `base`.
        base_count: u8,
        /// Used entries of `excluded`.
        excluded_count: u8,
        /// Zero.
        reserved: [u8; 7],
    }
}

impl WireReading {
    /// Encodes the interpretation; words beyond the bounds are left out and reported to the caller.
    pub fn new(interpretation: &Interpretation) -> (Self, Fits) {
        let Interpretation { weight, answers, reading } = interpretation;
        let mut wire = Self {
            weight: *weight,
            question: answers.map_or(NO_QUESTION, |place| place as u8),
            response: reading.response.into(),
            intent: reading.intent.into(),
            base_count: reading.base.len().min(BASE_WORDS_MAX) as u8,
            excluded_count: reading.excluded.len().min(EXCLUDED_GROUPS_MAX) as u8,
            response_doubt: reading.doubt.response as f32,
            ..Self::default()
        };
        copy_words(&mut wire.base, &reading.base);
        copy_doubts(&mut wire.base_doubt, &reading.doubt.base);
        copy_doubts(&mut wire.excluded_doubt, &reading.doubt.excluded);
        let mut fits =
            reading.base.len() <= BASE_WORDS_MAX && reading.excluded.len() <= EXCLUDED_GROUPS_MAX;
        for (i, group) in reading.excluded.iter().take(EXCLUDED_GROUPS_MAX).enumerate() {
            wire.excluded_len[i] = copy_words(&mut wire.excluded[i], group) as u8;
            fits &= group.len() <= EXCLUDED_WORDS_MAX;
        }
        (wire, if fits { Fits::Whole } else { Fits::Cut })
    }

    /// Decodes it. `words` is `|V|` of the scene, `asked` the number of questions.
    ///
    /// # Errors
    /// Counts, codes, doubts, questions or words that make no sense then.
    pub fn interpretation(&self, words: usize, asked: usize) -> Result<Interpretation, WireError> {
        self.check()?;
        let answers = match self.question {
            NO_QUESTION => None,
            place if usize::from(place) < asked => Some(usize::from(place)),
            place => return Err(WireError::new("question", place.into())),
        };
        let reading = self.reading(words)?;
        Ok(Interpretation { weight: checked_share("weight", self.weight)?, answers, reading })
    }

    fn reading(&self, words: usize) -> Result<Reading, WireError> {
        let base = checked_words(&self.base, self.base_count, words)?;
        let groups = used(&self.excluded, self.excluded_count, "excluded count")?;
        let excluded: Vec<Vec<WordId>> = groups
            .iter()
            .zip(self.excluded_len)
            .map(|(group, len)| checked_words(group, len, words))
            .collect::<Result<_, _>>()?;
        let doubt = Doubt {
            base: doubts(&self.base_doubt, base.len())?,
            excluded: doubts(&self.excluded_doubt, excluded.len())?,
            response: checked_share("doubt", self.response_doubt.into())?,
        };
        let (response, intent) = (self.response.get(), self.intent.get());
        Ok(Reading { base, excluded, response, intent, doubt })
    }
}

fn copy_doubts(slots: &mut [f32], doubts: &[f64]) {
    slots.iter_mut().zip(doubts).for_each(|(slot, doubt)| *slot = *doubt as f32);
}

/// The doubts of the used entries, up to the last that is one.
fn doubts(slots: &[f32], used: usize) -> Result<Vec<f64>, WireError> {
    let used = &slots[..used.min(slots.len())];
    let known = used.iter().rposition(|doubt| *doubt != 0.0).map_or(0, |last| last + 1);
    used[..known].iter().map(|doubt| checked_share("doubt", f64::from(*doubt))).collect()
}

/// Result of encoding into a fixed layout.
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
    let known = |&w: &u16| {
        (usize::from(w) < known).then_some(WordId(w)).ok_or(WireError::new("word", w.into()))
    };
    used(slots, count, "word count")?.iter().map(known).collect()
}

wire_struct! {
    /// The interpretation of an utterance. Grounding to policy, one for each utterance.
    Observation = "Observation" {
        /// The utterance's [`UtteranceSeq`].
        seq: u64,
        /// Of the utterance.
        asked: [AskedQuestion; ASKED_MAX],
        /// Of the utterance.
        gesture: WireGesture,
        /// [`scene::Scene::key`] of the scene that it was read with.
        scene_key: u64,
        /// Of the utterance.
        onset_ns: u64,
        /// Of the utterance.
        end_ns: u64,
        /// Of the utterance.
        accepted_ns: u64,
        /// When it was read.
        grounded_ns: u64,
        /// Number of used entries of `readings`.
        reading_count: u8,
        /// Number of used entries of `asked`.
        asked_count: u8,
        /// [`Source`] of the utterance.
        source: Code<Source>,
        /// Zero.
        reserved: [u8; 5],
        /// Possible meanings: for each question asked and for none, most likely first.
        readings: [WireReading; READINGS_MAX],
        /// A word that the scene does not have, for the robot's reply; may be empty.
        unknown: FixedText<60>,
    }
}

impl Observation {
    /// Decodes the possible meanings of the utterance. `words` is `|V|` of the scene.
    ///
    /// # Errors
    /// As [`WireReading::interpretation`]; or none or too many.
    pub fn interpretations(&self, words: usize) -> Result<Vec<Interpretation>, WireError> {
        let asked = self.asked()?.len();
        let readings = used(&self.readings, self.reading_count, "reading count")?;
        if readings.is_empty() {
            return Err(WireError::new("reading count", 0));
        }
        readings.iter().map(|reading| reading.interpretation(words, asked)).collect()
    }

    /// The questions that the utterance may answer, newest first.
    ///
    /// # Errors
    /// A count that makes no sense.
    pub fn asked(&self) -> Result<&[AskedQuestion], WireError> {
        used(&self.asked, self.asked_count, "asked count")
    }
}
