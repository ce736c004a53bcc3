//! Understood utterances: `(l_b, l_r)` of section 3.6, extended by excluded values, references and
//! intents.

use crate::{Relation, Role, WordId};

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
    /// "I don't know": the user cannot tell.
    CannotTell,
    /// "I don't care", "either": the answer does not matter to the user.
    DoesNotMatter,
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
    /// Withdraw the request; with excluded groups, only what they describe ("don't get me the red one").
    Cancel,
    /// Repeat the question.
    Repeat,
    /// Forget everything said and start over.
    StartOver,
    /// Ask the robot what there is ("what colours do you have?").
    AskBack,
    /// Ask how many objects the words describe ("how many cups are there?").
    AskCount,
    /// Ask which objects the words describe ("what is on the shelf?").
    AskWhich,
    /// Ask where the objects are that the words describe.
    AskWhere,
    /// Ask for the reason of what the robot said or does.
    AskWhy,
    /// Ask what the robot is doing.
    AskStatus,
    /// Ask what one can say to the robot.
    AskHelp,
    /// Greet.
    Greet,
    /// Thank.
    Thank,
    /// Have the delivered object put back.
    PutBack,
    /// Take leave.
    Leave,
    /// Ask whether there is an object that the words describe ("is there a red mug?").
    AskWhether,
    /// Have the robot do something else than fetch ("wash the bowl").
    Chore,
    /// Stop moving at once, and withdraw the request ("stop, I don't want it").
    StopAndCancel,
    /// Move again after a stop ("go on"), which words cannot bring about. An answer in the same
    /// words ("keep going") stands.
    GoOn,
}

/// An object that an utterance refers to by an earlier mention.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum Reference {
    /// None.
    #[default]
    None,
    /// "the other one": not the one just spoken of.
    Other,
    /// "the same one again": the one delivered last.
    Same,
    /// "the smaller one", of those that may be meant.
    Smaller,
    /// "the bigger one", of those that may be meant.
    Larger,
    /// "the smallest one", of those that the words describe.
    Smallest,
    /// "the biggest one", of those that the words describe.
    Largest,
    /// "either", "you choose": any of those that may be meant.
    Any,
    /// "the leftmost one", "longer than the red one": by place, order or size.
    Relation(Relation),
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
    /// Its purpose. Where it asks for objects, `base` and `excluded` describe those.
    pub intent: Intent,
    /// The object that it points to by what was spoken of.
    pub refers: Reference,
    /// Words of each further object that is asked for ("… and the white cup"); of [`Intent::AskWhich`], each value that
    /// it is about ("is it long or short"); of a [`Relation`], of each object that it relates to.
    pub further: Vec<Vec<WordId>>,
    /// Doubts about its parts.
    pub doubt: Doubt,
}

impl Reading {
    /// Returns whether both mean the same, however well each was heard.
    pub fn says_the_same(&self, other: &Self) -> bool {
        let Self { base, response, excluded, intent, refers, further, doubt: _ } = self;
        let is_answer_the_same =
            (response, intent, refers) == (&other.response, &other.intent, &other.refers);
        is_answer_the_same
            && (base, excluded, further) == (&other.base, &other.excluded, &other.further)
    }
}

/// A word that was said and that the scene does not have.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct UnknownWord {
    /// The word as it was said, without an article, or the words of a compound: "frying pan".
    pub text: String,
    /// Its role in the sentence; a kind only if a thing is requested by that kind.
    pub role: Role,
}

/// Doubts about the parts of a reading: for each the probability that something else was said, from
/// 0 (certain, as for typed words) to 1. Entries missing at the end are certain.
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
