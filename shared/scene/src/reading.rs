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
}
