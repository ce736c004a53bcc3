//! Utterances as the manager hears them, and their form in journals.

use scene::UnknownWord;
use serde::{Deserialize, Serialize};
use vocabulary::ids::{PromptId, UtteranceSeq};
use vocabulary::time::Time;
use vocabulary::{Interpretation, PersonId, Presentation};

/// An utterance of the user with its interpretations.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(from = "Stored", into = "Stored")]
pub struct Utterance {
    /// Number of the utterance.
    pub seq: UtteranceSeq,
    /// The latest presentations whose sound had begun when it was accepted, newest first.
    pub presentations: Vec<Presentation>,
    /// Whether it was typed, or given whole in another way; else it was spoken live.
    pub typed: bool,
    /// When the user began to speak, or typed.
    pub onset: Time,
    /// When the user had finished.
    pub end: Time,
    /// Time at which the utterance was accepted.
    pub accepted: Time,
    /// Interpretations as an answer to each of the presentations, and to none.
    pub interpretations: Vec<Interpretation>,
    /// A word that the scene does not have.
    pub unknown: Option<UnknownWord>,
    /// The point that the user points at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Whether the user is still speaking, or more speech is being recognised.
    pub more: bool,
    /// Speaker, as far as the channel knows.
    pub from: PersonId,
}

impl Utterance {
    /// Returns true if every interpretation answers one of its presentations, or none.
    pub fn is_consistent(&self) -> bool {
        let answers = self.interpretations.iter().filter_map(|one| one.answers);
        answers.into_iter().all(|answered| answered < self.presentations.len())
    }

    /// Returns the last question that the user had heard completely before beginning to speak.
    pub fn heard(&self) -> PromptId {
        let heard = |put: &&Presentation| put.complete && put.ended <= Some(self.onset);
        self.presentations.iter().find(heard).map_or(PromptId(0), |put| put.prompt)
    }
}

/// An utterance in a journal: its fields in order.
type Stored = (
    (UtteranceSeq, Vec<Presentation>, bool),
    (Time, Time, Time),
    (Vec<Interpretation>, Option<UnknownWord>, Option<[f64; 3]>),
    Ending,
);

/// The last fields; earlier journals have `more: bool`, which the same bytes encode. Persons are
/// variants that came later.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Ending {
    Whole,
    More,
    WholeOf(PersonId),
    MoreOf(PersonId),
}

impl From<Stored> for Utterance {
    fn from(stored: Stored) -> Self {
        let ((seq, presentations, typed), (onset, end, accepted), said, more) = stored;
        let (interpretations, unknown, gesture) = said;
        let (more, from) = match more {
            Ending::Whole => (false, PersonId::default()),
            Ending::More => (true, PersonId::default()),
            Ending::WholeOf(from) => (false, from),
            Ending::MoreOf(from) => (true, from),
        };
        Self {
            seq,
            presentations,
            typed,
            onset,
            end,
            accepted,
            interpretations,
            unknown,
            gesture,
            more,
            from,
        }
    }
}

impl From<Utterance> for Stored {
    fn from(it: Utterance) -> Self {
        let more = match (it.more, it.from.is_nobody()) {
            (false, true) => Ending::Whole,
            (true, true) => Ending::More,
            (false, false) => Ending::WholeOf(it.from),
            (true, false) => Ending::MoreOf(it.from),
        };
        (
            (it.seq, it.presentations, it.typed),
            (it.onset, it.end, it.accepted),
            (it.interpretations, it.unknown, it.gesture),
            more,
        )
    }
}
