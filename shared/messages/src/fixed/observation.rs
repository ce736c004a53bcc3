//! The interpretation of an utterance.

use crate::fixed::common::{AskedQuestion, WireGesture, checked_share, used};
use crate::fixed::utterance::{ASKED_MAX, Source};
use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::{Code, WireError, WireField};
use iceoryx2::prelude::ZeroCopySend;
use scene::{Doubt, Intent, Reading, Reference, Relation, Response, Role, UnknownWord, WordId};
use vocabulary::{Interpretation, PERSON_BYTES_MAX, PersonId};

/// Readings of one utterance, for all questions together.
pub const READINGS_MAX: usize = 32;
/// Scene words of one reading.
pub const BASE_WORDS_MAX: usize = 32;
/// Excluded groups of one reading.
pub const EXCLUDED_GROUPS_MAX: usize = 8;
/// Words of one excluded group.
pub const EXCLUDED_WORDS_MAX: usize = 6;
/// Further objects of one reading.
pub const FURTHER_MAX: usize = 4;
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
        /// [`WordId`]s by further object.
        further: [[u16; EXCLUDED_WORDS_MAX]; FURTHER_MAX],
        /// Used words of each excluded group.
        excluded_len: [u8; EXCLUDED_GROUPS_MAX],
        /// Used words of each further object.
        further_len: [u8; FURTHER_MAX],
        /// The question that it is the answer to if the utterance answers that one: its place in
        /// the observation's `asked`, or [`NO_QUESTION`].
        question: u8,
        /// [`scene::Response`].
        response: Code<Response>,
        /// [`scene::Intent`], in its order.
        intent: Code<Intent>,
        /// [`scene::Reference`].
        refers: Code<Reference>,
        /// Used entries of `base`.
        base_count: u8,
        /// Used entries of `excluded`.
        excluded_count: u8,
        /// Used entries of `further`.
        further_count: u8,
        /// [`scene::Relation::code`] of a relation in `refers`; else zero.
        relation: u8,
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
            refers: reading.refers.into(),
            relation: match reading.refers {
                Reference::Relation(relation) => relation.code(),
                _ => 0,
            },
            base_count: reading.base.len().min(BASE_WORDS_MAX) as u8,
            excluded_count: reading.excluded.len().min(EXCLUDED_GROUPS_MAX) as u8,
            further_count: reading.further.len().min(FURTHER_MAX) as u8,
            response_doubt: reading.doubt.response as f32,
            ..Self::default()
        };
        copy_words(&mut wire.base, &reading.base);
        copy_doubts(&mut wire.base_doubt, &reading.doubt.base);
        copy_doubts(&mut wire.excluded_doubt, &reading.doubt.excluded);
        let fits = [
            reading.base.len() <= BASE_WORDS_MAX,
            copy_groups(&mut wire.excluded, &mut wire.excluded_len, &reading.excluded),
            copy_groups(&mut wire.further, &mut wire.further_len, &reading.further),
        ];
        (wire, if fits == [true; 3] { Fits::Whole } else { Fits::Cut })
    }

    /// Decodes the interpretation. `words` is `|V|` of the scene, `asked` the number of questions.
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
        let excluded = checked_groups(groups, &self.excluded_len, words)?;
        let groups = used(&self.further, self.further_count, "further count")?;
        let further = checked_groups(groups, &self.further_len, words)?;
        let doubt = Doubt {
            base: doubts(&self.base_doubt, base.len())?,
            excluded: doubts(&self.excluded_doubt, excluded.len())?,
            response: checked_share("doubt", self.response_doubt.into())?,
        };
        let (response, intent) = (self.response.get(), self.intent.get());
        let refers = match self.refers.get() {
            Reference::Relation(_) => Relation::of_code(self.relation)
                .map(Reference::Relation)
                .ok_or_else(|| WireError::new("relation", self.relation.into()))?,
            refers => refers,
        };
        Ok(Reading { base, excluded, response, intent, refers, further, doubt })
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
    /// The whole utterance.
    Whole,
    /// Something was left out.
    Cut,
}

fn copy_words(slots: &mut [u16], words: &[WordId]) -> usize {
    slots.iter_mut().zip(words).map(|(slot, word)| *slot = word.0).count()
}

/// Copies groups of words; returns whether all of them fit.
fn copy_groups(
    slots: &mut [[u16; EXCLUDED_WORDS_MAX]],
    lengths: &mut [u8],
    groups: &[Vec<WordId>],
) -> bool {
    for ((slots, len), group) in slots.iter_mut().zip(&mut *lengths).zip(groups) {
        *len = copy_words(slots, group) as u8;
    }
    groups.len() <= lengths.len() && groups.iter().all(|group| group.len() <= EXCLUDED_WORDS_MAX)
}

fn checked_groups(
    groups: &[[u16; EXCLUDED_WORDS_MAX]],
    lengths: &[u8],
    known: usize,
) -> Result<Vec<Vec<WordId>>, WireError> {
    groups.iter().zip(lengths).map(|(group, len)| checked_words(group, *len, known)).collect()
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
        /// The utterance's `UtteranceSeq`.
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
        /// [`scene::Role`] of `unknown`.
        unknown_role: Code<Role>,
        /// Of the utterance.
        from: FixedText<PERSON_BYTES_MAX>,
        /// Possible meanings: for each question asked and for none, most likely first.
        readings: [WireReading; READINGS_MAX],
        /// A word that the scene does not have, for the robot's reply ("plate"); may be empty.
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

    /// The word that the scene does not have, if there is one.
    pub fn unknown(&self) -> Option<UnknownWord> {
        let text = self.unknown.as_str().ok().filter(|text| !text.is_empty())?;
        Some(UnknownWord { text: text.to_owned(), role: self.unknown_role.get() })
    }

    /// The person who speaks.
    ///
    /// # Errors
    /// Bytes that are not a name.
    pub fn person(&self) -> Result<PersonId, WireError> {
        let name = self.from.as_str()?;
        PersonId::new(name).map_err(|_| WireError::new("person", name.len() as u32))
    }

    /// The questions that the utterance may answer, newest first.
    ///
    /// # Errors
    /// A count that makes no sense.
    pub fn asked(&self) -> Result<&[AskedQuestion], WireError> {
        used(&self.asked, self.asked_count, "asked count")
    }
}
