//! State of the dialogue: everything that must outlive a restart. It is small, so each journal
//! record holds it whole, and recovery reads one record.
//!
//! Journals of earlier versions are read as if they were of this one: an enum gets new variants at
//! its end, and a struct no new field. Further content of a struct becomes a variant of one of its
//! fields ([`Stop`], [`HeldBack`]).

use scene::{ObjectId, Question};
use serde::{Deserialize, Serialize};
use vocabulary::ids::{ActId, InteractionId, PickId, PromptId, UtteranceSeq};
use vocabulary::reaction::Reaction;
use vocabulary::time::Time;
use vocabulary::{ActKind, Action, Attributed, Ended, NamedQuestion, PersonId, PickOutcome, Table};

use super::concede::Conceded;
use super::evidence::Evidence;
use super::hand_over::HandedOver;
use super::held_back::HeldBack;
use super::history::History;
use super::line::{Line, Preface};
use super::people::Users;
use super::put_back::{PuttingBack, WithUser};
use super::stop::{MotionStop, Stop};
use super::utterance::Utterance;
use crate::{Belief, Posterior};

/// The dialogue's state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Key of the scene that the belief is about.
    pub scene_key: u64,
    /// Key of the settings, scene included, under which the state was decided.
    pub settings_key: u64,
    /// Latest utterance that the state includes.
    pub applied: UtteranceSeq,
    /// The objects on the table, if they come from perception.
    pub table: Option<Table>,
    /// Last interaction number assigned.
    pub last_interaction: InteractionId,
    /// Last key given to an order to the arm.
    pub last_order: PickId,
    /// Last prompt number assigned.
    pub last_prompt: PromptId,
    /// The open interaction.
    pub open: Option<Interaction>,
    /// Words of each further requested object, in order.
    pub queue: Vec<Vec<String>>,
    /// The standing decision.
    pub act: Act,
    /// The questions that the latest utterance was attributed to.
    pub attributed: Attributed,
    /// The latest interaction that ended.
    pub ended: Option<Ended>,
    /// The latest delivery, while it can be refused.
    pub handed_over: Option<HandedOver>,
    /// The object handed over last, while it can be put back.
    pub with_user: Option<WithUser>,
    /// The object that goes back to its place.
    pub putting_back: Option<PuttingBack>,
    /// The motion stop.
    pub stop: Stop,
    /// Deliveries by object.
    pub history: History,
    /// Knowledge about speakers.
    pub users: Users,
    /// The user's reaction times as observed so far.
    pub timing: Timing,
}

/// How far the dialogue has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// No interaction is open.
    Idle,
    /// The wanted object is being found out.
    Deciding,
    /// A pick waits for the release of the motion stop, or for a decision about a kept object.
    HeldBack,
    /// The arm has the order to fetch an object, or to leave it.
    Fetching,
}

impl State {
    /// Returns how far the dialogue has come.
    pub fn stage(&self) -> Stage {
        match &self.open {
            None => Stage::Idle,
            Some(open) if open.pick.is_some() => Stage::Fetching,
            Some(open) if open.held_back.is_some() => Stage::HeldBack,
            Some(_) => Stage::Deciding,
        }
    }
}

/// Reaction times of the user. `None` until an answer was observed: the configured one holds then.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Timing {
    /// Time from the end of a spoken question to the first sound of the answer.
    pub spoken: Option<Reaction>,
    /// Time from a question's appearance to the answer typed.
    pub typed: Option<Reaction>,
}

/// Questions and lines of an interaction that are remembered: older ones get no answers.
pub const PROMPTS_MAX: usize = 64;

/// How often a question is asked in an interaction, repetitions after silence not counted.
const ASKED_MAX: usize = 2;

/// Appends an item and drops the oldest beyond the limit.
pub(super) fn push_bounded<T>(items: &mut Vec<T>, item: T) {
    if items.len() >= PROMPTS_MAX {
        items.remove(0);
    }
    items.push(item);
}

/// One interaction in progress.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interaction {
    /// Number of the interaction.
    pub id: InteractionId,
    /// Time at which its first utterance was accepted.
    pub opened: Time,
    /// Posterior over the wanted object, and over the user if the planner uses it.
    pub posterior: Posterior,
    /// Content of the utterances, to be scored again under another scene.
    pub evidence: Vec<Evidence>,
    /// Utterances dropped from `evidence` for lack of room.
    pub forgotten: u32,
    /// The scene's objects when it was last read; empty if they are too many.
    pub objects: Vec<KnownObject>,
    /// Statements of the user about attributes, by name.
    pub conceded: Conceded,
    /// The latest questions asked ([`PROMPTS_MAX`]), so that an answer can be scored against the
    /// one it was meant for.
    pub prompts: Vec<Prompt>,
    /// Number of questions asked, each counted once however often it was repeated.
    pub questions: u32,
    /// Presentations of questions so far.
    pub presentations: u32,
    /// Decisions so far; seeds a planner's random numbers.
    pub step: u32,
    /// Turns in a row without an answer: response windows in silence, words without a meaning.
    pub silences: u32,
    /// First and last utterance.
    pub utterances: (UtteranceSeq, UtteranceSeq),
    /// A decision deferred until the user has finished speaking.
    pub deferred: Option<Deferred>,
    /// The ordered pick.
    pub pick: Option<(PickId, ObjectId)>,
    /// Name of the picked object.
    pub picked: String,
    /// The latest lines said since it was ordered ([`PROMPTS_MAX`]): each can be denied.
    pub announced: Vec<PromptId>,
    /// A pick that waits for the release of the motion stop.
    pub held_back: Option<HeldBack>,
    /// Whether the ordered pick is called off for another object: the interaction continues once
    /// the arm has let go of it.
    pub corrected: bool,
}

impl Interaction {
    /// An interaction in which nothing was said yet.
    pub fn new(id: InteractionId, opened: Time, posterior: Posterior, first: UtteranceSeq) -> Self {
        Self {
            id,
            opened,
            posterior,
            evidence: Vec::new(),
            forgotten: 0,
            objects: Vec::new(),
            conceded: Conceded::default(),
            prompts: Vec::new(),
            questions: 0,
            presentations: 0,
            step: 0,
            silences: 0,
            utterances: (first, first),
            deferred: None,
            pick: None,
            picked: String::new(),
            announced: Vec::new(),
            held_back: None,
            corrected: false,
        }
    }

    /// Returns the belief over the wanted object.
    pub fn belief(&self) -> Belief {
        self.posterior.belief()
    }

    /// Adds a question; the oldest one is dropped for lack of room.
    pub(super) fn add_prompt(&mut self, prompt: Prompt) {
        self.questions += 1;
        push_bounded(&mut self.prompts, prompt);
    }

    /// Returns the questions that were asked as often as one is ([`ASKED_MAX`]); a choice counts
    /// as a question about each of its values. A user who may take a value for another one says the
    /// same again.
    pub(super) fn spent(&self) -> Vec<Question> {
        if self.posterior.said().is_none() {
            return Vec::new();
        }
        let each = |question| match question {
            Question::Choice(k, options) => {
                options.values().iter().map(|v| Question::Attribute(k, *v)).collect()
            }
            Question::None => Vec::new(),
            other => vec![other],
        };
        // The robot may withdraw a question before there was time for an answer.
        let prompts =
            self.prompts.iter().filter(|prompt| prompt.answered.is_some() || prompt.times > 1);
        let all: Vec<Question> = prompts.flat_map(|prompt| each(prompt.question)).collect();
        let asked = |question: &Question| all.iter().filter(|it| *it == question).count();
        all.iter().copied().filter(|question| asked(question) >= ASKED_MAX).collect()
    }

    /// Adds a line said since the pick was ordered; the oldest one is dropped for lack of room.
    pub(super) fn announce(&mut self, line: PromptId) {
        push_bounded(&mut self.announced, line);
    }

    pub(super) fn prompt(&self, id: PromptId) -> Option<&Prompt> {
        self.prompts.iter().find(|prompt| prompt.id == id)
    }

    pub(super) fn prompt_mut(&mut self, id: PromptId) -> Option<&mut Prompt> {
        self.prompts.iter_mut().find(|prompt| prompt.id == id)
    }
}

/// Basis of a decision.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Basis {
    /// The last question that the user had heard completely.
    pub heard: PromptId,
    /// A remark to be said before the next question.
    pub preface: Preface,
    /// The latest utterance.
    pub utterance: UtteranceSeq,
    /// Preference that the user expressed.
    pub preference: Preference,
}

/// Preference of the user for the decision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Preference {
    /// Whatever is best.
    #[default]
    Best,
    /// Anything but the standing question.
    Otherwise,
    /// Any of the objects that are left, at once.
    Any,
}

/// A deferred decision: the user was still speaking when the belief was updated.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Deferred {
    /// Basis of the decision.
    pub basis: Basis,
    /// Since when the decision waits.
    pub since: Time,
}

/// An object of the scene, by name.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KnownObject {
    /// Name of the object.
    pub name: String,
    /// Description, unique in the scene, e.g. `small white bowl in the dishwasher`.
    pub description: String,
}

/// A question put to the user.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Prompt {
    /// Number of the prompt.
    pub id: PromptId,
    /// The question, numbered as in the present scene; `None` if that scene lacks its subject.
    pub question: Question,
    /// The question by names.
    pub named: NamedQuestion,
    /// When the answer to its latest presentation had ended.
    pub answered: Option<Time>,
    /// How often it was put, each time in other words.
    pub times: u32,
}

/// A decision with the reasons for it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Act {
    /// Number of the act.
    pub id: ActId,
    /// Kind of the act.
    pub kind: ActKind,
    /// The line that goes with it, if any.
    pub prompt: PromptId,
    /// Number of the prompt's presentation.
    pub presentation: u32,
    /// The question asked.
    pub question: Question,
    /// The pick ordered.
    pub pick: Option<(PickId, ObjectId)>,
    /// The robot's words.
    pub line: Line,
    /// The utterance that led to the act.
    pub utterance: UtteranceSeq,
    /// Time of the decision.
    pub decided: Time,
    /// Expected discounted return.
    pub value: f64,
    /// The best other actions with their values, best first.
    pub alternatives: Vec<(Action, f64)>,
    /// Expected number of questions still to ask.
    pub expected_questions: f64,
    /// Certified lower and upper bound on the value of the best policy, if the planner has them.
    pub bounds: Option<(f64, f64)>,
}

/// Cause of a change of the state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Cause {
    /// The journal starts here; the state is taken as it is.
    Snapshot,
    /// An utterance.
    Utterance(Utterance),
    /// The response window passed in silence.
    Silence,
    /// The user has finished speaking: a deferred decision can be made.
    Quiet,
    /// The arm has ended the pick.
    PickEnded {
        /// The pick.
        pick: PickId,
        /// Outcome of the pick.
        outcome: PickOutcome,
    },
    /// The service was started with other settings, perhaps with another scene.
    Reconfigured,
    /// The objects on the table are these.
    Objects(Table),
    /// The motion stop was latched, came to rest, or was released.
    MotionStop(MotionStop),
    /// A journal of the group was set aside: every number up to this one is over.
    SetAside(u64),
    /// The arm is at rest after a stop that a user ordered, or has not confirmed it in time.
    StopReport {
        /// Whether the arm has confirmed the stop.
        confirmed: bool,
    },
    /// A person wants to be forgotten.
    Forget(PersonId),
}

/// A journal record: the cause of a change, its time, and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// The cause.
    pub cause: Cause,
    /// The time; the transition depends on no other clock.
    pub at: Time,
    /// State after the event.
    pub state: State,
}
