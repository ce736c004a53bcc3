//! Everything that the policy must not forget. It is small, so each journal record holds it whole,
//! and recovery reads one record.

use crate::evidence::Evidence;
use crate::history::History;
use dialogue::Belief;
use dialogue::NamedQuestion;
use dialogue::user_model::Reaction;
use dialogue::user_model::{Joint, Person};
use messages::{
    ActId, ActKind, Ended, InteractionId, Interpretation, PickId, PickOutcome, PromptId,
    UtteranceSeq,
};
use scene::{ObjectId, Question};
use serde::{Deserialize, Serialize};
use service::Time;

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
    /// How soon this person answers, as far as that was seen.
    pub timing: Timing,
}

/// How soon a person answers. None until an answer was seen: then what is configured holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// From the end of a spoken question to the first sound of the answer.
    pub spoken: Option<Reaction>,
    /// From a question's appearance to the answer typed.
    pub typed: Option<Reaction>,
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
    /// A decision that waits until the person has ended.
    pub held: Option<Held>,
    /// The pick that was ordered.
    pub pick: Option<(PickId, ObjectId)>,
    /// Name of the object that it picks.
    pub picked: String,
    /// Picks ordered so far.
    pub picks: u32,
    /// Whether the ordered pick is called off for another object: then the interaction goes on when
    /// the arm has left it.
    pub corrected: bool,
}

/// A decision that waits: the person spoke on while the belief took in what was said before.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Held {
    /// The last question that the person had heard whole.
    pub heard: PromptId,
    /// What is to be said before the next question.
    pub preface: String,
    /// The latest utterance that the decision rests on.
    pub utterance: UtteranceSeq,
    /// Since when it waits.
    pub since: Time,
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
    pub asked: NamedQuestion,
    /// When what was said to it had ended, since it was last asked.
    pub answered: Option<Time>,
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
    /// Nobody speaks any more: what was held can be decided.
    Quiet,
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
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    /// Its number.
    pub seq: UtteranceSeq,
    /// The latest questions whose sound had begun when it was accepted, newest first.
    pub asked: Vec<Asking>,
    /// Whether it was typed, or given whole in another way; else it was spoken into a microphone.
    pub typed: bool,
    /// When the person began to speak, or typed.
    pub onset: Time,
    /// When the person had ended.
    pub end: Time,
    /// When it was accepted.
    pub accepted: Time,
    /// What it may mean as an answer to each of these questions, and to none.
    pub meant: Vec<Interpretation>,
    /// A word that the scene does not have; may be empty.
    pub unknown: String,
    /// The point that the person points at, metres, frame `base`.
    pub gesture: Option<[f64; 3]>,
    /// Whether the person speaks on, or more that was said is being recognised.
    pub more: bool,
}

/// A question as it was put to the person, once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Asking {
    /// Its prompt.
    pub prompt: PromptId,
    /// When its sound began.
    pub began: Time,
    /// When its sound ended or was broken off, if it has.
    pub ended: Option<Time>,
    /// Whether it was said to its end.
    pub whole: bool,
}

impl Heard {
    /// The last question that the person had heard whole before beginning to speak.
    pub fn heard_whole(&self) -> PromptId {
        let whole = |asking: &&Asking| asking.whole && asking.ended <= Some(self.onset);
        self.asked.iter().find(whole).map_or(PromptId(0), |asking| asking.prompt)
    }
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
