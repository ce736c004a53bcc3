//! The robot as programs see it, and what it answers to an utterance.
//!
//! Pure.

use messages::{ActKind, ArmStatus, MotionInhibit, PickPhase, PolicyView, RobotAct, Service};
use scene::{Question, Scene};
use serde::{Deserialize, Serialize};
use service::status::{Actual, GroupStatus, ServiceState};
use service::view::{Latest, QuestionView};
use std::collections::BTreeMap;
use vocabulary::Outcome;
use vocabulary::named::options;

/// The robot in a word; of several that hold, the first.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Word {
    /// The motion stop is latched.
    Stopped,
    /// A service that the dialogue needs is away, or the robot is not heard.
    #[default]
    Disconnected,
    /// Someone or something holds it: an operator holds a service, or the robot cannot move.
    Held,
    /// The arm fetches an object, or puts it back.
    Fetching,
    /// A question waits for its answer.
    Asking,
    /// None of these.
    Idle,
}

/// The robot at one moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub(crate) struct State {
    pub(crate) state: Word,
    /// Why it is disconnected or held, with help where there is some.
    pub(crate) why: Option<String>,
    /// The open request, 0 for none.
    pub(crate) interaction: u64,
    /// Who made it; empty: nobody in particular.
    pub(crate) from: String,
    /// Highest utterance that the belief holds.
    pub(crate) utterance: u64,
    /// The robot's latest line.
    pub(crate) text: String,
    /// Its prompt, 0 for none.
    pub(crate) prompt: u64,
    /// Whether that line waits for an answer.
    pub(crate) expects_answer: bool,
    pub(crate) question: Option<QuestionView<String>>,
    /// Answers that fit.
    pub(crate) options: Vec<String>,
    /// Questions asked in the open request.
    pub(crate) questions: u32,
    /// Probability of each object.
    pub(crate) belief: BTreeMap<String, f64>,
    pub(crate) arm: Option<ArmState>,
    /// The request that ended last.
    pub(crate) ended: Option<EndedState>,
    #[serde(skip)]
    pub(crate) inner: Inner,
}

/// What the acts of the policy answer.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Answers {
    /// The highest utterance that an act answers.
    utterance: u64,
    /// The latest line that gives up an object while its request goes on, and the utterance that it answers. The question
    /// after it may replace it before anybody has looked.
    given_up: (u64, String),
}

/// What replies are made of, and programs do not see.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Inner {
    /// The policy has published something, and the arm.
    pub(crate) is_known: bool,
    decision: ActKind,
    /// First and last utterance of the latest interaction.
    utterances: (u64, u64),
    answers: Answers,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct ArmState {
    phase: PickPhase,
    object: Option<String>,
    moving: bool,
    stopped: bool,
    /// The stop in force, 0 for none: a release names it.
    stop: u64,
    /// Expected seconds until the object is handed over, 0 where nothing is fetched.
    remaining_s: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct EndedState {
    pub(crate) interaction: u64,
    pub(crate) object: Option<String>,
    pub(crate) outcome: Outcome,
    pub(crate) questions: u32,
    pub(crate) seconds: f64,
}

/// What the robot answers to an utterance.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Reply {
    pub(crate) kind: Kind,
    pub(crate) text: String,
    /// Whether the robot waits for an answer: keep a microphone open.
    pub(crate) expects_answer: bool,
    pub(crate) question: Option<QuestionView<String>>,
    pub(crate) options: Vec<String>,
    pub(crate) prompt: u64,
    pub(crate) interaction: u64,
    /// How the request ended of which the utterance was part.
    pub(crate) ended: Option<EndedState>,
}

/// The kind of a reply.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Kind {
    /// A question, or a line that waits for a yes.
    Question,
    /// The arm is ordered to fetch an object, or to put it back.
    Fetching,
    /// A line that waits for nothing.
    Line,
    /// The request has ended.
    Ended,
    /// The robot says nothing.
    Silent,
    /// The robot has not answered yet.
    Pending,
    /// The arm is stopped and at rest.
    Stopped,
}

/// The messages of which a state is made.
#[derive(Clone, Copy, Debug)]
pub struct Robot<'a> {
    /// The scene of the dialogue.
    pub scene: &'a Scene,
    /// The latest messages.
    pub latest: &'a Latest,
    /// The supervisor's status, once there was one.
    pub group: Option<&'a GroupStatus>,
}

impl Answers {
    /// Takes in an act. Returns whether it answers an utterance that none has answered.
    pub(crate) fn add(&mut self, act: &RobotAct) -> bool {
        let is_new = act.utterance > self.utterance;
        self.utterance = self.utterance.max(act.utterance);
        if act.kind == ActKind::Cancel && act.interaction != 0 {
            self.given_up = (act.utterance, act.text.as_str().unwrap_or_default().to_owned());
        }
        is_new
    }
}

impl State {
    /// Makes the state.
    pub(crate) fn new(robot: &Robot<'_>, answers: Answers) -> Self {
        let Robot { scene, latest, group } = robot;
        let arm = latest.arm.as_ref();
        let view = latest.view.as_ref().filter(|view| view.scene_key == scene.key());
        let (state, why) = word(view, arm, *group);
        let nothing =
            Self { state, why, arm: arm.map(|arm| arm_state(scene, arm)), ..Self::default() };
        let Some(view) = view else { return nothing };
        let expects_answer = expects_answer(view);
        let fitting = expects_answer.then(|| options(scene, view.question)).into_iter().flatten();
        let names = scene.objects().iter().map(|object| object.name.clone());
        Self {
            interaction: view.interaction,
            from: view.from.clone(),
            utterance: view.applied,
            text: view.text.clone(),
            prompt: view.prompt,
            expects_answer,
            question: QuestionView::new(scene, view.question).filter(|_| expects_answer),
            options: fitting.map(str::to_owned).collect(),
            questions: view.questions,
            belief: names.zip(view.belief.iter().copied()).collect(),
            ended: view.last.as_ref().map(|last| EndedState {
                interaction: last.interaction.0,
                object: last.name.clone(),
                outcome: last.outcome,
                questions: last.questions,
                seconds: last.seconds,
            }),
            inner: Inner {
                is_known: arm.is_some(),
                decision: view.decision,
                utterances: view.utterances,
                answers,
            },
            ..nothing
        }
    }

    /// Returns whether the utterance was applied, and an act answers it.
    pub(crate) fn answers(&self, utterance: u64) -> bool {
        self.utterance >= utterance && self.inner.answers.utterance >= utterance
    }

    /// Returns whether the robot has said that it gives up an object, and goes on with a question.
    pub(crate) fn is_on_the_way(&self) -> bool {
        self.inner.decision == ActKind::Cancel && self.interaction != 0
    }

    /// Returns the reply to an utterance that was applied, said while the request `open` was, 0 for none. Without an act that
    /// answers it, the robot is silent unless its question stands. Where the robot gives up an object and goes on with a
    /// question, both lines are one reply.
    pub(crate) fn reply(&self, utterance: u64, open: u64) -> Reply {
        let (first, last) = self.inner.utterances;
        // Words that withdraw a request are not counted as a part of it.
        let is_part = |ended: &EndedState| {
            (first..=last).contains(&utterance) || (open != 0 && ended.interaction == open)
        };
        let ended = self.ended.clone().filter(|ended| self.interaction == 0 && is_part(ended));
        let is_fetching = match self.inner.decision {
            ActKind::Pick => self.interaction != 0,
            ActKind::PutBack => true,
            _ => false,
        };
        let kind = match self {
            _ if self.expects_answer => Kind::Question,
            _ if is_fetching => Kind::Fetching,
            _ if ended.is_some() => Kind::Ended,
            _ if self.answers(utterance) && !self.text.is_empty() => Kind::Line,
            _ => Kind::Silent,
        };
        let is_silent = kind == Kind::Silent;
        let (given_up_at, given_up) = &self.inner.answers.given_up;
        let goes_on = *given_up_at == utterance && !self.text.contains(given_up.as_str());
        let text = if goes_on { format!("{given_up} {}", self.text) } else { self.text.clone() };
        Reply {
            kind,
            text: if is_silent { String::new() } else { text },
            expects_answer: self.expects_answer,
            question: self.question.clone(),
            options: self.options.clone(),
            prompt: if is_silent { 0 } else { self.prompt },
            interaction: self.interaction,
            ended,
        }
    }
}

impl Reply {
    /// Makes a reply without a line of the dialogue.
    pub(crate) fn plain(kind: Kind, text: &str) -> Self {
        Self {
            kind,
            text: text.to_owned(),
            expects_answer: false,
            question: None,
            options: Vec::new(),
            prompt: 0,
            interaction: 0,
            ended: None,
        }
    }
}

/// A question, or "Say yes, and I will get the white bowl."
fn expects_answer(view: &PolicyView) -> bool {
    let confirms = view.decision == ActKind::Say && view.question != Question::None;
    view.interaction != 0 && (view.decision == ActKind::Ask || confirms)
}

fn word(
    view: Option<&PolicyView>,
    arm: Option<&ArmStatus>,
    group: Option<&GroupStatus>,
) -> (Word, Option<String>) {
    let because = |word, why: &str| (word, Some(why.to_owned()));
    if arm.is_some_and(|arm| arm.stopped != 0) {
        return (Word::Stopped, None);
    }
    let names = Service::DIALOGUE.map(Service::name);
    let needed = group.iter().flat_map(|group| &group.services);
    let mut needed = needed.filter(|service| names.contains(&service.name.as_str()));
    if let Some(away) = needed.find(|service| service.actual != Actual::Ready) {
        let word = if away.state == ServiceState::Held { Word::Held } else { Word::Disconnected };
        let soon = || format!("{} is {}", away.name, away.state.word());
        return (word, Some(away.unavailable().unwrap_or_else(soon)));
    }
    let (Some(view), Some(arm)) = (view, arm) else {
        return because(Word::Disconnected, "the dialogue has not begun yet");
    };
    match arm.hindrance.get() {
        MotionInhibit::None => {}
        MotionInhibit::Unheard | MotionInhibit::Stale => {
            return because(Word::Disconnected, "the robot is not heard");
        }
        inhibit => return because(Word::Held, held(inhibit)),
    }
    let is_fetching = matches!(view.decision, ActKind::Pick | ActKind::PutBack | ActKind::Cancel);
    let word = match () {
        () if is_busy(arm) || (is_fetching && view.interaction != 0) => Word::Fetching,
        () if expects_answer(view) => Word::Asking,
        () => Word::Idle,
    };
    (word, None)
}

fn held(inhibit: MotionInhibit) -> &'static str {
    match inhibit {
        MotionInhibit::Stopped => "the robot's emergency stop holds",
        MotionInhibit::Error => "a part of the robot has a fault",
        MotionInhibit::Disabled => "the robot's motors are off",
        MotionInhibit::Gripper => "a gripper has a fault",
        _ => "a gripper is being calibrated",
    }
}

fn is_busy(arm: &ArmStatus) -> bool {
    !matches!(arm.phase.get(), PickPhase::Idle | PickPhase::Done)
}

fn arm_state(scene: &Scene, arm: &ArmStatus) -> ArmState {
    let object = scene.objects().get(arm.object as usize).filter(|_| is_busy(arm));
    ArmState {
        phase: arm.phase.get(),
        object: object.map(|object| object.name.clone()),
        moving: arm.moving != 0,
        stopped: arm.stopped != 0,
        stop: arm.stop,
        remaining_s: arm.remaining_s,
    }
}

#[cfg(test)]
mod tests;
