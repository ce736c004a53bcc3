use scene::{Intent, Response};
use serde::{Deserialize, Serialize};
use vocabulary::{ActKind, Attributed, Outcome, PickOutcome};

use super::Named;
use crate::view::{ActionView, QuestionView};

/// A record of the policy: why the state of the dialogue changed, and the state after it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PolicyRecord {
    /// Cause of the change.
    pub cause: PolicyCause,
    /// Highest utterance that the state includes.
    pub applied: u64,
    /// The open interaction, 0 for none.
    pub interaction: u64,
    /// Time at which the first utterance was accepted.
    pub opened_ns: Option<u64>,
    /// Questions asked in it, repetitions not counted.
    pub questions: u32,
    /// Probability of each object, by name; empty if no interaction is open.
    pub belief: Named<f64>,
    /// Description of each object, by name; empty if the scene is no longer known.
    pub objects: Named<String>,
    /// Probability that the wanted object is not here.
    pub absent: f64,
    /// The user as far as the planner has learnt about them.
    pub user: Option<UserRecord>,
    /// The decision in force.
    pub decision: DecisionRecord,
    /// The questions that the latest utterance was attributed to.
    pub attributed: Attributed,
    /// Since when a decision waits for the user to finish speaking.
    pub deferred_since_ns: Option<u64>,
    /// Descriptions of the objects that are to be fetched afterwards, in order.
    pub queue: Vec<String>,
    /// The latest interaction that has ended.
    pub ended: Option<EndedRecord>,
    /// The object that was handed over last, while it can be refused.
    pub refusable: Option<String>,
    /// The object that goes back to its place.
    pub putting_back: Option<String>,
    /// Whether the motion stop is latched.
    pub stopped: bool,
}

/// Why the state of the dialogue changed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "type", rename_all = "snake_case")]
pub enum PolicyCause {
    /// The file starts here; the state is taken as it is.
    Snapshot,
    /// An utterance.
    Utterance {
        /// Number of the utterance.
        utterance: u64,
        /// Whether it was typed, or given whole in another way.
        typed: bool,
        /// Name of the person who spoke, if known.
        from: Option<String>,
        /// When the user began to speak, or typed.
        onset_ns: u64,
        /// When the user had finished.
        end_ns: u64,
        /// Time at which the utterance was accepted.
        accepted_ns: u64,
        /// The point that was pointed at, metres, frame `base`.
        gesture_m: Option<[f64; 3]>,
        /// Whether the user was still speaking.
        more: bool,
        /// A word that the scene does not have.
        unknown: Option<String>,
        /// Interpretations as an answer to each question, and to none.
        interpretations: Vec<InterpretationRecord>,
    },
    /// The response window passed in silence.
    Silence,
    /// The user has finished speaking.
    Quiet,
    /// The arm has ended a pick.
    PickEnded {
        /// The pick's interaction.
        interaction: u64,
        /// Attempt of the pick.
        attempt: u32,
        /// Outcome of the pick.
        outcome: PickOutcome,
    },
    /// The service was started with other settings.
    Reconfigured,
    /// The objects on the table changed.
    Objects {
        /// Number of changes so far.
        version: u64,
        /// Names of the objects.
        objects: Vec<String>,
    },
    /// The motion stop was latched; the arm was not at rest yet.
    Stopping,
    /// The motion stop is latched, and the arm came to rest.
    Stopped,
    /// The motion stop was released.
    Released,
    /// A stop that a user ordered was confirmed by the arm, or not in time.
    StopReport {
        /// Whether the stop was confirmed.
        confirmed: bool,
    },
    /// A journal of the group was set aside.
    SetAside {
        /// Every number up to this one is over.
        numbers_over: u64,
    },
    /// A person wanted to be forgotten.
    Forget {
        /// The person's name.
        person: String,
    },
}

/// One way to understand an utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterpretationRecord {
    /// Probability among the interpretations that answer the same question.
    pub weight: f64,
    /// The question that the utterance answers.
    pub answers: Option<PresentationKey>,
    /// Meaning in the scene's words, e.g. `yes · white`; empty if the scene is unknown.
    pub text: String,
    /// The scene's words, as they were said.
    pub base: Vec<String>,
    /// The answer.
    pub response: Response,
    /// The purpose of the utterance.
    pub intent: Intent,
    /// Groups of words; an object that has all words of a group is ruled out.
    pub excluded: Vec<Vec<String>>,
}

/// Key of a presentation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PresentationKey {
    /// Number of the line.
    pub prompt: u64,
    /// Number of the prompt's presentation, from 1.
    pub presentation: u32,
}

/// Key of a pick.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PickKey {
    /// Interaction of the pick.
    pub interaction: u64,
    /// Attempt within the interaction, from 1.
    pub attempt: u32,
    /// Name of the picked object.
    pub object: String,
}

/// Estimated parameters of the user.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct UserRecord {
    /// Probability that a question is answered.
    pub p_l: f64,
    /// Probability that an answer is wrong.
    pub epsilon: f64,
}

/// A decision with its reasons. Values are expected discounted returns, seconds of the user's time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DecisionRecord {
    /// Number of the act.
    pub act: u64,
    /// Kind of the act.
    #[serde(rename = "type")]
    pub kind: ActKind,
    /// Number of the line that goes with it, 0 for none.
    pub prompt: u64,
    /// Number of the prompt's presentation.
    pub presentation: u32,
    /// The line; empty for a silent act, or if its scene is no longer known.
    pub text: String,
    /// The question asked; `None` if its scene is no longer known.
    pub question: Option<QuestionView<String>>,
    /// The pick ordered.
    pub pick: Option<PickKey>,
    /// The utterance that led to the act.
    pub utterance: u64,
    /// Time of the decision.
    pub decided_ns: u64,
    /// Value of the act.
    pub value_s: f64,
    /// Certified lower and upper bound on the best policy's value.
    pub bounds_s: Option<[f64; 2]>,
    /// The best other actions, best first.
    pub alternatives: Vec<AlternativeRecord>,
    /// Expected number of questions still to ask.
    pub expected_questions: f64,
}

/// An action that the planner has weighed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlternativeRecord {
    /// The action.
    pub action: ActionView<String>,
    /// Value of the alternative.
    pub value_s: f64,
}

/// The end of an interaction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EndedRecord {
    /// Number of the interaction.
    pub interaction: u64,
    /// Name of the object that was picked or tried.
    pub object: Option<String>,
    /// Outcome of the interaction.
    pub outcome: Outcome,
    /// Questions asked, repetitions not counted.
    pub questions: u32,
    /// Time from the first utterance to the end.
    pub duration_s: f64,
}
