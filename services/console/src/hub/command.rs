//! What viewers ask the bridge to do.

use serde_json::Value as Json;
use service::Time;
use service::status::GroupStatus;

use super::ViewerId;
use crate::voice::PcmFrame;

/// A message to the main loop.
#[derive(Debug)]
pub enum Command {
    /// Something to be done and answered once, under the number that the page gave it.
    Do(ViewerId, u64, Verb),
    /// Sound of a viewer's microphone.
    Sound(ViewerId, PcmFrame),
    /// A viewer has gone.
    Left(ViewerId),
    /// What the supervisor says of the group, or why it says nothing.
    Group(Result<Box<GroupStatus>, String>),
}

/// What the dialogue and the study are asked to do.
#[derive(Clone, Debug, PartialEq)]
pub enum Verb {
    /// Says something to the robot.
    Say(Words),
    /// "Not that one", whatever is meant by "that" just now.
    NotThat,
    /// Begins the dialogue anew.
    StartOver,
    /// A verb of the study's, without its prefix, with its arguments.
    Study(String, Json),
}

/// Words for the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Words {
    /// What was said.
    pub text: String,
    /// What may have been said instead, with weights; of a browser's recogniser.
    pub alternatives: Vec<(String, f64)>,
    /// Whether a browser's recogniser has heard it, rather than that it was typed.
    pub spoken: bool,
    /// When the person began, if that is known.
    pub began: Option<Time>,
    /// When the person had ended, if that is known.
    pub ended: Option<Time>,
}

/// An order to the motion stop: handled before everything else.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// Who gave it.
    pub viewer: ViewerId,
    /// The number that the page gave it.
    pub id: u64,
    /// Whether the arm is to stop, or may go on.
    pub stop: bool,
}
