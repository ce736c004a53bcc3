//! One interaction as the history shows it.

use messages::{Outcome, PickOutcome, Source};
use serde::{Deserialize, Serialize};
use service::journal_record::{ArmCause, DecisionRecord, PickRecord};
use service::view::{Answered, Meaning};

/// An interaction from its first words to its end; without an end while it is open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interaction {
    pub interaction: u64,
    /// When its first words were accepted, milliseconds since 1970; `None` if that is not known.
    pub unix_ms: Option<u64>,
    /// False if its beginning is in no journal any more.
    pub whole: bool,
    /// The objects of the beliefs: all of a small scene, of a large one those that were likely in
    /// some moment.
    pub objects: Vec<Labelled>,
    /// Events in the order of time.
    pub moments: Vec<Moment>,
    /// Moments left out for lack of room.
    #[serde(default)]
    pub left_out: u32,
    pub end: Option<End>,
}

/// An object.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Labelled {
    pub name: String,
    /// Description, unique among the objects.
    pub label: String,
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moment {
    /// Time since the interaction's first words, milliseconds.
    pub after_ms: u64,
    pub event: Event,
    /// Belief and decision after it; `None` if it changed neither.
    pub thought: Option<Thought>,
}

/// Kind of event.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum Event {
    /// An utterance.
    Heard(Heard),
    /// The response window passed in silence.
    Silence,
    /// The user finished speaking.
    Quiet,
    /// The arm ended a pick.
    PickEnded { outcome: PickOutcome },
    /// Other settings came into force.
    Reconfigured,
    /// The objects on the table changed.
    Objects,
    /// The motion stop was latched.
    Stopped,
    /// The arm confirmed a stop that the user ordered.
    StopConfirmed,
    /// The arm did not confirm it in time.
    StopUnconfirmed,
    /// The motion stop was released.
    Released,
    /// A journal was set aside, or its file began.
    Recovered,
    /// A step of the arm.
    Arm { cause: ArmCause, pick: PickRecord },
}

/// An utterance with its understood meaning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    pub utterance: u64,
    /// The words; empty if they are in no journal any more.
    pub text: String,
    pub source: Option<Source>,
    /// Probability of the words among all that may have been said.
    pub confidence: Option<f64>,
    pub snr_db: Option<f32>,
    /// Possible meanings, most likely first.
    pub readings: Vec<Meaning>,
    /// The questions that it answers, most probable first.
    pub answers: Vec<Answered>,
}

/// Belief and decision.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Thought {
    /// Probability of each object of the interaction; later ones are missing at the end.
    pub belief: Vec<f64>,
    /// Probability that the wanted object is not here.
    pub absent: f64,
    pub decision: DecisionRecord,
}

/// The end of an interaction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct End {
    pub outcome: Outcome,
    /// Name and description of the object that was picked or tried.
    pub object: Option<Labelled>,
    pub questions: u32,
    pub duration_s: f64,
}

/// An entry of the list of interactions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    pub interaction: u64,
    pub unix_ms: Option<u64>,
    /// The first words.
    pub text: String,
    pub end: Option<End>,
}

impl Interaction {
    /// Returns the interaction's entry in the list.
    pub fn summary(&self) -> Summary {
        let heard = self.moments.iter().find_map(|moment| match &moment.event {
            Event::Heard(heard) if !heard.text.is_empty() => Some(heard.text.clone()),
            _ => None,
        });
        Summary {
            interaction: self.interaction,
            unix_ms: self.unix_ms,
            text: heard.unwrap_or_default(),
            end: self.end.clone(),
        }
    }
}
