//! Everything that the policy must not forget. It is small, so each journal record holds it whole,
//! and recovery reads one record.

use crate::evidence::{Asked, Evidence};
use crate::history::History;
use dialogue::Belief;
use dialogue::person::{Joint, Person};
use node::Time;
use protocol::{ActId, ActKind, Ended, InteractionId, PickId, PickOutcome, PromptId, UtteranceSeq};
use scene::{ObjectId, Question, Reading};
use serde::{Deserialize, Serialize};

/// The dialogue's state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Key of the scene that the belief is about.
    pub scene_key: u64,
    /// Key of the settings, scene included, that the state was decided under.
    pub settings_key: u64,
    /// Highest utterance that the state holds.
    pub applied: UtteranceSeq,
    /// Last interaction number given.
    pub last_interaction: InteractionId,
    /// Last prompt number given.
    pub last_prompt: PromptId,
    /// The open interaction.
    pub open: Option<Interaction>,
    /// The decision that stands.
    pub act: Act,
    /// The latest interaction that ended.
    pub ended: Option<Ended>,
    /// How often objects were delivered.
    pub history: History,
    /// What earlier interactions have told about the person, where the planner makes use of it.
    pub person: Option<Person>,
}

/// One fetch in progress.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Interaction {
    /// Its number.
    pub id: InteractionId,
    /// When its first utterance was accepted.
    pub opened: Time,
    /// The belief as log weights, in the scene's order; one more where the wanted object may not be
    /// here.
    pub belief: Vec<f64>,
    /// The belief together with what is learned about the person, where the planner makes use of it.
    pub joint: Option<Joint>,
    /// What was said, so that it can be scored again under another scene.
    pub evidence: Vec<Evidence>,
    /// Utterances that did not fit into `evidence` any more.
    pub forgotten: u32,
    /// The objects as they were when they were last looked at; empty where they are too many.
    pub objects: Vec<Known>,
    /// Every question asked, so that an answer can be scored against the one that was heard.
    pub prompts: Vec<Prompt>,
    /// How often the robot asked, repetitions included.
    pub presentations: u32,
    /// Decisions so far; seeds what is random in a planner.
    pub step: u32,
    /// Response windows in a row that passed in silence.
    pub silences: u32,
    /// First and last utterance.
    pub utterances: (UtteranceSeq, UtteranceSeq),
    /// The pick that was ordered.
    pub pick: Option<(PickId, ObjectId)>,
    /// Name of the object that it picks.
    pub picked: String,
}

/// An object that a dialogue is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Known {
    /// Its name.
    pub name: String,
    /// How it is told from the others, e.g. `small white bowl in the dishwasher`.
    pub words: String,
}

impl Interaction {
    /// The belief.
    ///
    /// # Panics
    /// Where the weights are none. They come from a belief, or from a journal that was checked when
    /// it was recovered.
    pub fn belief(&self) -> Belief {
        Belief::from_log(self.belief.clone()).expect("the weights of a belief")
    }
}

/// A question that was asked.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Prompt {
    /// Its number.
    pub id: PromptId,
    /// What was asked.
    pub asked: Asked,
    /// Whether something was said to it.
    pub answered: bool,
}

/// A decision with its reasons.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Act {
    /// Its number.
    pub id: ActId,
    /// What kind.
    pub kind: ActKind,
    /// What is said, if anything is.
    pub prompt: PromptId,
    /// Which presentation of the prompt.
    pub presentation: u32,
    /// What is asked.
    pub question: Question,
    /// What is picked.
    pub pick: Option<(PickId, ObjectId)>,
    /// The words.
    pub text: String,
    /// The utterance that led to it.
    pub utterance: UtteranceSeq,
    /// When it was decided.
    pub decided: Time,
    /// Expected discounted return.
    pub value: f64,
    /// The best other actions and their values.
    pub alternatives: Vec<(String, f64)>,
    /// Expected number of questions still to ask.
    pub expected_questions: f64,
    /// Certified lower and upper bound on what the best policy is worth, where the planner has them.
    pub bounds: Option<(f64, f64)>,
}

impl Default for Act {
    fn default() -> Self {
        Self {
            id: ActId(0),
            kind: ActKind::Wait,
            prompt: PromptId(0),
            presentation: 0,
            question: Question::None,
            pick: None,
            text: String::new(),
            utterance: UtteranceSeq(0),
            decided: Time(0),
            value: 0.0,
            alternatives: Vec::new(),
            expected_questions: 0.0,
            bounds: None,
        }
    }
}

/// Why the state changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Cause {
    /// The journal begins anew here; the state is to be taken as it is.
    Snapshot,
    /// An utterance was understood.
    Utterance(Heard),
    /// The response window passed and nobody spoke.
    Silence,
    /// The arm has ended the pick.
    PickEnded {
        /// Which pick.
        pick: PickId,
        /// How.
        outcome: PickOutcome,
    },
    /// The service was started with other settings, perhaps with another scene.
    Reconfigured,
}

/// An utterance as it was understood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    /// Its number.
    pub seq: UtteranceSeq,
    /// The last question that the person had heard whole.
    pub prompt: PromptId,
    /// When it was accepted.
    pub accepted: Time,
    /// What it may mean, with probabilities that sum to 1.
    pub readings: Vec<(f64, Reading)>,
    /// A word that the scene does not have; may be empty.
    pub unknown: String,
    /// The point that the person points at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Seconds from the end of that question to the beginning of the utterance, where both are
    /// known.
    pub reaction_s: Option<f64>,
}

/// A journal record: why the state changed, when, and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// Why.
    pub cause: Cause,
    /// When; the transition depends on no other clock.
    pub at: Time,
    /// The state after it.
    pub state: State,
}
