//! The serialisable view of a group, shown by `whichone watch --json` and the console's page.
//!
//! One struct per section, made from the messages that arrived last. `tests/golden/view.json` holds
//! an example, so that a change of a key is seen.

mod dialogue;
mod latest;
mod lines;
mod table;
mod understood;

use messages::{
    ArmStatus, EarState, Hearing, MicrophoneState, MotionInhibit, PickOutcome, PickPhase, Task,
};
use scene::Scene;
use serde::Serialize;

pub use dialogue::{AlternativeView, DeliveryView, DialogueView, EndedView, UserView};
pub use latest::{Arrived, Latest, LatestTopics, PromptId, drain, quiet};
pub use lines::Lines;
pub use table::TableScene;
pub use understood::{Answered, Meaning, Readings, Understood};
pub use vocabulary::named::{ActionView, QuestionView};

use crate::Time;

/// A group at one moment.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct View<'a, Group> {
    /// Belief and decision of the policy; `None` before its first publication.
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
    /// Speaker of the line.
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

/// State of the arm.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ArmView<'a> {
    /// The interaction that its pick belongs to, 0 for none.
    pub interaction: u64,
    /// The pick's attempt within the interaction.
    pub attempt: u32,
    /// Name of the object that it picks or picked.
    pub object: Option<&'a str>,
    /// Whether it is fetched or put back.
    pub task: Task,
    /// Phase of the pick.
    pub phase: PickPhase,
    /// Outcome of the latest pick.
    pub outcome: PickOutcome,
    /// True if a joint moves.
    pub moving: bool,
    /// True if the motion stop is latched.
    pub stopped: bool,
    /// The stop in force, 0 for none: a release names it.
    pub stop: u64,
    /// Condition that inhibits motion.
    pub hindrance: MotionInhibit,
    /// Time left until the pick is done, seconds.
    pub remaining_s: f64,
    /// True if it points at an object.
    pub aimed: bool,
}

impl<'a> ArmView<'a> {
    /// Makes the view of a status; objects by their names in `scene`.
    pub fn new(scene: &'a Scene, arm: &ArmStatus) -> Self {
        let object = scene.objects().get(arm.object as usize).filter(|_| arm.interaction != 0);
        Self {
            interaction: arm.interaction,
            attempt: arm.attempt,
            object: object.map(|object| object.name.as_str()),
            task: arm.task.get(),
            phase: arm.phase.get(),
            outcome: arm.outcome.get(),
            moving: arm.moving != 0,
            stopped: arm.stopped != 0,
            stop: arm.stop,
            hindrance: arm.hindrance.get(),
            remaining_s: rounded(arm.remaining_s, 1),
            aimed: arm.aimed_act != 0,
        }
    }
}

/// Quality of the microphone signal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HearingView<'a> {
    /// State of the microphone.
    pub microphone: MicrophoneState,
    /// State of the recogniser.
    pub recogniser: EarState,
    /// Loudness, dB of full scale.
    pub level_db: f32,
    /// Signal-to-noise ratio of the latest utterance, dB; `None` before the first measurement.
    pub snr_db: Option<f32>,
    /// Sounds that wait for recognition.
    pub pending: u32,
    /// Restarts of the microphone's program.
    pub restarts: u32,
    /// Utterances that were lost.
    pub dropped: u32,
    /// The microphone's program, or why there is none.
    pub note: &'a str,
}

impl<'a> HearingView<'a> {
    /// Makes the view of a message, levels to whole decibels.
    pub fn new(hearing: &'a Hearing) -> Self {
        Self {
            microphone: hearing.microphone.get(),
            recogniser: hearing.ear.get(),
            level_db: hearing.level_db.round(),
            snr_db: (hearing.measured != 0).then(|| hearing.snr_db.round()),
            pending: hearing.pending,
            restarts: hearing.restarts,
            dropped: hearing.dropped,
            note: hearing.note.as_str().unwrap_or_default(),
        }
    }
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
