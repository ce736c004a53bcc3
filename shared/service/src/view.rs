//! The serialisable view of a group: `whichone watch --json` prints it, the console's page shows it.
//!
//! One struct per section, made from the messages that arrived last. `tests/golden/view.json` holds
//! an example, so that a change of a key is seen.

mod arm;
mod dialogue;
mod hearing;
mod latest;

use serde::Serialize;

pub use arm::ArmView;
pub use dialogue::{ActionView, AlternativeView, DialogueView, EndedView, QuestionView, UserView};
pub use hearing::HearingView;
pub use latest::{Arrived, Latest, LatestTopics, PromptId, drain, quiet};

use crate::Time;

/// A group at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct View<'a, Group> {
    /// Belief and decision of the policy; none before its first publication.
    pub dialogue: Option<DialogueView<'a>>,
    /// The latest lines of the dialogue, oldest first.
    pub said: Vec<SaidView<'a>>,
    /// Quality of the microphone signal.
    pub hearing: Option<HearingView<'a>>,
    /// State of the arm.
    pub arm: Option<ArmView<'a>>,
    /// The supervisor's status of the group.
    pub group: Option<&'a Group>,
}

/// A line of the dialogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct SaidView<'a> {
    /// Its speaker.
    pub who: Speaker,
    /// The words.
    pub text: &'a str,
}

/// Speaker of a line of the dialogue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Speaker {
    /// A user, to the robot.
    Person,
    /// The robot.
    Robot,
    /// A person, but presumably not to the robot.
    Unmeant,
    /// No one: a note about an event.
    System,
}

/// Milliseconds of the monotonic clock, as programs and pages get times.
pub fn ms(at: Time) -> f64 {
    at.ns() as f64 / 1e6
}

fn rounded(number: f64, digits: i32) -> f64 {
    let scale = 10_f64.powi(digits);
    (number * scale).round() / scale
}

#[cfg(test)]
mod tests;
