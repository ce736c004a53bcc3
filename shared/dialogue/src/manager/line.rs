//! Lines of the robot. They are typed; [`rendering`](crate::rendering) turns them into English.

use scene::UnknownWord;
use serde::{Deserialize, Serialize};

use vocabulary::PickOutcome;

/// A line that goes with an act.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Line {
    /// A remark before the content.
    pub preface: Preface,
    /// The content.
    pub content: Content,
}

impl From<Content> for Line {
    fn from(content: Content) -> Self {
        Self { preface: Preface::None, content }
    }
}

/// A remark before a line's content.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preface {
    /// No remark.
    #[default]
    None,
    /// The user said a word that the scene does not have.
    UnknownWord(UnknownWord),
    /// The objects changed; descriptions of those that are gone and of those that are new.
    ObjectsChanged {
        /// Objects that are gone.
        gone: Vec<String>,
        /// Objects that are new.
        new: Vec<String>,
    },
    /// The objects changed, and there are too many of them to list.
    SceneChanged,
    /// A remark of its own: the question that follows was interrupted by it.
    Remark(Remark),
    /// Several objects are fetched, described by these words, in this order.
    InTurn(Vec<Vec<String>>),
    /// The pick of the object of that description is over, and the next one's turn has come.
    PickEnded(String, PickOutcome),
    /// The object that was handed over was refused.
    Sorry,
    /// Putting back the object of that description is over.
    PutBackEnded(String, PickOutcome),
    /// These objects are left, which the user cannot distinguish; descriptions.
    Left(Vec<String>),
}

/// A remark that answers the user without a decision. Journals hold positions: new ones come last.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Remark {
    /// The motion stop is latched, and the arm is at rest.
    Stopped,
    /// The objects and values that there are to choose from.
    Inventory,
    /// A greeting.
    Greeting,
    /// The answer to a farewell.
    Goodbye,
    /// The answer to thanks.
    Welcome,
    /// Explains possible requests to the user.
    Help,
    /// The utterance was not understood.
    NotUnderstood,
    /// Agreement.
    AllRight,
    /// The scene has nothing of this kind.
    Unknown(UnknownWord),
    /// Nothing is being done.
    Idle,
    /// Nothing was handed over that could be put back.
    NothingToPutBack,
    /// The object of that description is being fetched.
    Fetching(String),
    /// The object of that description is being left.
    Leaving(String),
    /// The object of that description is being put back, or will be.
    PuttingBack(String),
    /// The object of the first description is being fetched; that of the second is put back then.
    PutBackInTurn(String, String),
    /// The answer to a question about the scene.
    Objects {
        /// Kind of the user's question.
        asked: AboutObjects,
        /// The words that describe the objects.
        words: Vec<String>,
        /// Names of the objects.
        objects: Vec<String>,
    },
    /// Evidence for the objects in question.
    Why(Reason),
    /// Nothing but fetching and putting back can be done. The name of the object that is offered to
    /// be fetched, if there is one.
    OnlyFetches(Option<String>),
    /// The object of that description is handed over: it was called off too late.
    TooLate(String),
    /// The motion stop is still latched, and only a person releases it.
    StillStopped,
    /// The arm has not confirmed a stop.
    StopUnconfirmed,
}

/// A question of the user about the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AboutObjects {
    /// The number of objects.
    Count,
    /// The list of objects.
    Which,
    /// The places of the objects.
    Where,
    /// Whether such objects exist.
    Whether,
    /// The value of an attribute, out of several, of the objects; the words are these values.
    Either,
}

/// Reason for an action of the robot.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Reason {
    /// A question distinguishes these objects; descriptions.
    Between(Vec<String>),
    /// The user said these words.
    Said(Vec<String>),
    /// The object is the likeliest.
    Likeliest,
    /// No action needs an explanation.
    None,
}

/// Content of a line.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Content {
    /// Nothing is said.
    #[default]
    Silence,
    /// The act's question.
    Question {
        /// Selects one of the scene's wordings.
        variant: u64,
        /// For which time in the interaction it is put, from 1.
        time: u32,
        /// The answers that are left, in their spoken form; empty if they are too many.
        choices: Vec<String>,
        /// Whether the repetition is the last.
        is_last: bool,
    },
    /// Asks for the wanted object for the given time, from 1.
    Wanted(u32),
    /// The object of that description is being fetched.
    Fetching(String),
    /// The object of that description is to be fetched once the motion stop is released.
    HeldBack(String),
    /// The motion stop was released: asks whether the object of that description is still wanted.
    AskToRelease(String),
    /// The object of that description is being put back.
    PuttingBack(String),
    /// The object of that description is to be put back once the motion stop is released.
    PutBackHeldBack(String),
    /// The motion stop was released: asks whether to put back the object of that description.
    AskToPutBack(String),
    /// Putting back the object of that description is over.
    PutBackEnded(String, PickOutcome),
    /// The pick that was held back is confirmed.
    Confirmed,
    /// The pick of the object of that description is over.
    PickEnded(String, PickOutcome),
    /// A remark.
    Remark(Remark),
    /// The pick is called off because another object is wanted.
    Correcting,
    /// The pick is called off at the user's request.
    CallingOff,
    /// The request was withdrawn.
    Cancelled,
    /// The interaction is abandoned because a part of the robot's memory is lost.
    Forgotten,
    /// The wanted object is not here.
    NotHere,
    /// No object of the scene is left.
    SceneReplaced,
    /// Putting back is called off at the user's request.
    Keeping,
    /// The object of that description was cancelled and cannot go back: offers to hand it over.
    Kept(String),
    /// Asks whether the first of the objects of these descriptions is wanted; the others come next.
    Offered(Vec<String>),
}
