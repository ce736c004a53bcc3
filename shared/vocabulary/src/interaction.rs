//! How far a pick and its interaction have come, and how they end.

use scene::ObjectId;
use serde::{Deserialize, Serialize};

use crate::ids::{InteractionId, UtteranceSeq};
use crate::time::Span;

/// Kind of a decision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ActKind {
    /// Waits for the user.
    #[default]
    Wait,
    /// Asks a question.
    Ask,
    /// Says a line; no answer is expected.
    Say,
    /// Picks an object and says so.
    Pick,
    /// Calls a pick off: an object that is grasped already goes back to its place, unless the gripper has
    /// begun to let go of it where it hands it over. Calls putting back off, unless the object is already grasped.
    Cancel,
    /// Puts the object that was handed over back in its place and says so.
    PutBack,
}

impl ActKind {
    /// Returns the name used in JSON and in journals' text, e.g. `ask`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wait => "wait",
            Self::Ask => "ask",
            Self::Say => "say",
            Self::Pick => "pick",
            Self::Cancel => "cancel",
            Self::PutBack => "put_back",
        }
    }
}

/// What the arm is ordered to do with an object. Both kinds of order have one numbering, the phases
/// and the outcomes of a pick, and the same rules.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Task {
    /// Fetch it from its place and hand it over.
    #[default]
    Fetch,
    /// Take it from the user, where it was handed over, and put it back in its place.
    PutBack,
}

/// Phase of a pick. Each is durable before the arm acts on it.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize,
)]
#[serde(rename_all = "snake_case")]
pub enum PickPhase {
    /// Nothing to do.
    #[default]
    Idle,
    /// Accepted; nothing has moved.
    Accepted,
    /// Moving to the object, gripper open.
    Moving,
    /// The gripper closes on the object.
    Closing,
    /// The object is held: lifted and carried to the user, or carried to its place and put down.
    Holding,
    /// Called off while it is held: the object is carried back to its place and put down.
    Returning,
    /// Over; see the outcome.
    Done,
}

/// Outcome of a pick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum PickOutcome {
    /// Not over yet.
    #[default]
    Pending,
    /// The object was handed over.
    Delivered,
    /// No motion reaches it; nothing moved.
    Unreachable,
    /// Unknown whether the object was grasped; a person must look.
    Interrupted,
    /// Called off by the policy or the operator; the object was put back or never touched.
    Cancelled,
    /// The fingers closed on nothing in every attempt; nothing is held.
    Missed,
    /// The robot did not follow its motion, or did not arrive; a person must look.
    Blocked,
    /// The object is back in its place.
    PutBack,
    /// The object is no longer where it was seen; nothing is held.
    Vanished,
    /// Called off while it was held, and no way back to its place was found: the gripper keeps hold
    /// of it until the next order for it.
    Kept,
}

/// Time after a motion stop in which no release counts, whoever gives either: a frightened person presses again and
/// again, and two people press at once.
pub const RESUME_AFTER: Span = Span::from_ms(2_000);

/// Outcome of an interaction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// An object was handed over.
    Delivered,
    /// An object was handed over, and the user refused it.
    Refused,
    /// The arm failed; the object is named.
    Failed,
    /// The user withdrew the request.
    Cancelled,
    /// The user fell silent, or no question helped.
    Abandoned,
    /// The scene was replaced during the interaction, and none of its objects is left.
    SceneChanged,
    /// The robot concluded that the wanted object is not here.
    NotHere,
}

impl Outcome {
    /// Returns how a pick's outcome ends its interaction; `None` while the pick is pending.
    pub fn of_pick(outcome: PickOutcome) -> Option<Self> {
        match outcome {
            // Putting an object back does not end an interaction.
            PickOutcome::Pending | PickOutcome::PutBack => None,
            PickOutcome::Delivered => Some(Self::Delivered),
            PickOutcome::Unreachable
            | PickOutcome::Interrupted
            | PickOutcome::Missed
            | PickOutcome::Vanished
            | PickOutcome::Kept
            | PickOutcome::Blocked => Some(Self::Failed),
            PickOutcome::Cancelled => Some(Self::Cancelled),
        }
    }
}

/// An interaction that has ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ended {
    /// Its number.
    pub interaction: InteractionId,
    /// The object that was picked or tried, numbered as in the scene of that time.
    pub object: Option<ObjectId>,
    /// That object's name.
    pub name: Option<String>,
    /// Its outcome.
    pub outcome: Outcome,
    /// Questions asked, repetitions not counted.
    pub questions: u32,
    /// Seconds from the first utterance to the end.
    pub seconds: f64,
    /// First and last utterance.
    pub utterances: (UtteranceSeq, UtteranceSeq),
}
