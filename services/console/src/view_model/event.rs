//! Events of the dialogue, for the study.

use messages::{Ended, Receipt};
use scene::Question;

/// Something that has happened; reported once.
#[derive(Clone, Debug, PartialEq)]
pub enum DialogueEvent {
    /// A line of the robot has begun.
    Presented {
        /// Its prompt.
        prompt: u64,
        /// Which presentation of it.
        presentation: u32,
        /// The question asked, if any.
        question: Question,
        /// Its words.
        text: String,
    },
    /// An utterance was accepted.
    Heard(Box<Receipt>),
    /// An interaction has ended.
    Ended(Ended),
}
