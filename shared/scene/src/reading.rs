//! Understood utterances: `(l_b, l_r)` of section 3.6, extended by excluded values and intents.

use crate::WordId;

/// The answer to a question, `l_r`.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Response {
    /// An affirmative and no negative word.
    Yes,
    /// A negative and no affirmative word.
    No,
    /// Neither, or both.
    #[default]
    None,
}

/// The purpose of an utterance.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Intent {
    /// Says something about the wanted object, or answers.
    #[default]
    Inform,
    /// Not addressed to the robot, or without content.
    None,
    /// Stop moving at once.
    Stop,
    /// Withdraw the request.
    Cancel,
    /// Repeat the question.
    Repeat,
    /// Forget everything said and start over.
    StartOver,
    /// Ask the robot a question ("what colours do you have?").
    AskBack,
}

/// One way to understand an utterance.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Reading {
    /// `l_b`: the scene's words as they were said, a repeated word repeated. One factor of eq. (4)
    /// each.
    pub base: Vec<WordId>,
    /// `l_r`: the answer, if there is one.
    pub response: Response,
    /// Groups of words; an object that has every value of a group is ruled out.
    pub excluded: Vec<Vec<WordId>>,
    /// Its purpose.
    pub intent: Intent,
    /// Doubts about its parts.
    pub doubt: Doubt,
}

/// Doubts about the parts of a reading: for each the probability that something else was said, from 0
/// (certain, as for typed words) to 1. Entries missing at the end are certain.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Doubt {
    /// By word of [`Reading::base`].
    pub base: Vec<f64>,
    /// By group of [`Reading::excluded`].
    pub excluded: Vec<f64>,
    /// Of [`Reading::response`].
    pub response: f64,
}

impl Doubt {
    /// Of word `at` of the base.
    pub fn of_word(&self, at: usize) -> f64 {
        self.base.get(at).copied().unwrap_or(0.0)
    }

    /// Of group `at` of the excluded ones.
    pub fn of_group(&self, at: usize) -> f64 {
        self.excluded.get(at).copied().unwrap_or(0.0)
    }
}
