//! Commands of viewers to the main loop.

use messages::{PromptId, RequestKey, StopId};
use serde_json::Value as Json;
use service::Time;
use service::control::Watched;
use vocabulary::PersonId;

use super::ViewerId;
use crate::voice::PcmFrame;

/// A message to the main loop.
#[derive(Debug)]
pub enum Command {
    /// A command that is answered once, under the number that the page gave it.
    Do(ViewerId, u64, Verb),
    Sound(ViewerId, PcmFrame),
    Left(ViewerId),
    /// The supervisor's status of the group, or why there is none.
    Group(Watched),
}

/// A command for the dialogue or for the study.
#[derive(Clone, Debug, PartialEq)]
pub enum Verb {
    Say(Words),
    /// Denies the object in question or being fetched.
    NotThat,
    /// Makes the robot forget the request.
    StartOver,
    /// A command of the study, without its prefix, with its arguments.
    Study(String, Json),
}

#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    pub text: String,
    /// Other hypotheses of a browser's recogniser, with weights.
    pub alternatives: Vec<(String, f64)>,
    /// `true` if a browser's recogniser has heard it, `false` if it was typed.
    pub spoken: bool,
    pub began: Option<Time>,
    pub ended: Option<Time>,
    /// The robot's latest prompt that the page had shown before; 0 if unknown.
    pub seen: PromptId,
    /// Speaker of the words.
    pub from: PersonId,
    /// Key of the request, the same for each repetition of it; `None` if nothing repeats it.
    pub key: Option<RequestKey>,
}

pub fn typed(text: &str) -> Words {
    let alternatives = Vec::new();
    Words {
        text: text.to_owned(),
        alternatives,
        spoken: false,
        began: None,
        ended: None,
        seen: PromptId(0),
        from: PersonId::default(),
        key: None,
    }
}

/// An order to the motion stop; handled before everything else.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    pub viewer: ViewerId,
    /// The command's number; `None` if the order comes with words, which are answered.
    pub id: Option<u64>,
    /// `true` latches the stop, `false` releases it.
    pub stop: bool,
    /// The stop that a release is meant for, 0 for any.
    pub of: StopId,
}
