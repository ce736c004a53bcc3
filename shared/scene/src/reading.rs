//! What an utterance was understood to say: `(l_b, l_r)` of section 3.6 with the extensions that
//! people need (excluded values, intents).

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

/// What the person wants with the utterance.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Intent {
    /// Says something about the wanted object, or answers.
    #[default]
    Inform,
    /// Not meant for the robot, or without content.
    None,
    /// Stop moving, now.
    Stop,
    /// The request is withdrawn.
    Cancel,
    /// Say the question again.
    Repeat,
    /// Forget what was said and begin anew.
    StartOver,
    /// A question to the robot ("what colours do you have?").
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
    /// What the person wants with it.
    pub intent: Intent,
    /// How doubtful its parts are.
    pub doubt: Doubt,
}

/// How doubtful it is that a reading's parts are what was said: for each the probability that it
/// was something else, 0 (certain, as of typed words) to 1. What is missing at an end is certain.
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
