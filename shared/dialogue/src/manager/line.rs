//! Lines of the robot. They are typed; [`rendering`](crate::rendering) turns them into English.

use serde::{Deserialize, Serialize};

use crate::PickOutcome;

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
    UnknownWord(String),
    /// The interaction starts over.
    StartingOver,
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
}

/// A remark that answers the user without a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Remark {
    /// The motion stop is latched.
    Stopped,
    /// The objects and values that there are to choose from.
    Inventory,
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
        /// Which presentation it is worded for, from 1.
        presentation: u32,
    },
    /// The object of that description is being fetched.
    Fetching(String),
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
    /// The interaction is abandoned after silence.
    Abandoned,
    /// The interaction is abandoned because a part of the robot's memory is lost.
    Forgotten,
    /// The wanted object is not here.
    NotHere,
    /// None of the scene's objects is left.
    SceneReplaced,
}
