//! The user at a terminal: `whichone say`, then `whichone await --answer-as`, by the command line's
//! own code. The client dies like every other process; the person starts it again.

use std::collections::VecDeque;

use laboratory::TruthfulUser;
use messages::{
    ActKind, Activity, Injection, Outcome, PresentationState, Presented, PromptId, ReceiptStatus,
    RequestKey, Sound,
};
use scene::Scene;
use service::submission::Submission;
use service::view::{Arrived, Latest};
use service::{Span, Time};
use whichone::verbs::Waiting;

/// Receipts that a new client still gets.
const RECEIPTS: usize = messages::topics::WINDOW;

/// A client that runs for so long without a break has had time to answer.
const TIME_TO_ANSWER: Span = Span::from_ms(3_000);

/// A person who wants one object after another, and their client.
pub struct Client {
    wanted: VecDeque<String>,
    process: Option<Process>,
    /// When the person starts the client again.
    pub(super) restart: Option<Time>,
    /// Whether the current request was submitted as far as the person knows.
    has_asked: bool,
    /// The latest interaction whose end was reported.
    reported: u64,
    /// What has arrived since the last look.
    pub(super) arrived: Arrived,
    /// The latest messages of the writers that live: what a new client gets at once.
    pub(super) history: Arrived,
    /// Keys of all accepted utterances, in order.
    pub accepted: Vec<RequestKey>,
    /// Whether the person has had time to answer since their last accepted words.
    could_answer: bool,
    /// Times that the robot gave up a person who had time to answer.
    pub given_up: u32,
    /// Whether the person regrets the first delivery.
    regrets: bool,
    regret: Option<Regret>,
    /// Objects that the robot has said to have put back.
    pub put_back: u32,
    /// How long after it is announced the person calls the first fetch off, if they do.
    pub(super) calls_off: Option<Span>,
    /// When that fetch was announced.
    announced: Option<Time>,
    /// How long after a question is shown it is answered, by a client that waits for nothing else.
    pub(super) hasty: Option<Span>,
    /// The answers of such a client, each with the prompt that it answers.
    pub answers: Vec<(RequestKey, PromptId)>,
    /// Fetches that the robot has left for the person's word.
    pub left: u32,
}

/// How far a person has come who has what was delivered put back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Regret {
    /// The wish was not submitted as far as the person knows.
    Felt,
    /// It was.
    Said,
}

/// The memory of the client.
struct Process {
    /// When it started, or its last words were accepted.
    quiet_since: Time,
    latest: Latest,
    user: TruthfulUser,
    waiting: Waiting,
    saying: VecDeque<Submission>,
    /// The latest prompt, and since when it is shown.
    shown: (PromptId, Time),
}

impl Client {
    pub(super) fn new(wanted: Vec<String>, regrets: bool) -> Self {
        Self {
            wanted: wanted.into(),
            process: None,
            restart: Some(Time(0)),
            has_asked: false,
            reported: 0,
            arrived: Arrived::default(),
            history: Arrived::default(),
            accepted: Vec::new(),
            could_answer: false,
            given_up: 0,
            regrets,
            regret: None,
            put_back: 0,
            calls_off: None,
            announced: None,
            hasty: None,
            answers: Vec::new(),
            left: 0,
        }
    }

    /// Returns whether the person has everything.
    pub(super) fn is_done(&self) -> bool {
        self.wanted.is_empty()
    }

    /// Returns whether the client has not been shown this prompt.
    pub(super) fn is_new(&self, prompt: u64) -> bool {
        let view = self.history.view.as_ref();
        view.is_none_or(|view| view.prompt != prompt)
    }

    pub(super) fn kill(&mut self, restart: Time) {
        (self.process, self.restart) = (None, Some(restart));
    }

    /// A new topic of speech has no message yet.
    pub(super) fn forget_speech(&mut self) {
        let view = self.history.view.take();
        self.history = Arrived { view, ..Arrived::default() };
    }

    /// Passes on a message of a service. The writer keeps the latest for late readers, whatever the
    /// bus loses.
    pub(super) fn publish(&mut self, copies: usize, put: impl Fn(&mut Arrived)) {
        put(&mut self.history);
        let excess = self.history.receipts.len().saturating_sub(RECEIPTS);
        self.history.receipts.drain(..excess);
        if copies > 0 {
            put(&mut self.arrived);
        }
    }

    /// One look of the client. Returns what it sends, and what the person does for the story.
    pub(super) fn look(&mut self, scene: &Scene, now: Time) -> (Vec<Injection>, Option<String>) {
        let Some(wanted) = self.wanted.front().cloned() else { return Default::default() };
        if self.restart.take_if(|at| *at <= now).is_some() {
            self.start(scene, &wanted, now);
        }
        let arrived = std::mem::take(&mut self.arrived);
        let Some(process) = &mut self.process else { return Default::default() };
        process.latest.update(&arrived);
        for receipt in &arrived.receipts {
            let is_first = process.saying.front().is_some_and(|it| it.key() == receipt.request());
            if is_first {
                assert_eq!(
                    receipt.status,
                    ReceiptStatus::Accepted,
                    "a plain sentence: {receipt:?}"
                );
                self.accepted.push(receipt.request());
                process.saying.pop_front();
                match &mut self.regret {
                    Some(regret) => *regret = Regret::Said,
                    None => self.has_asked = true,
                }
                self.could_answer = false;
                process.quiet_since = now;
            }
        }
        let story = self.next(scene, now);
        let Some(process) = &mut self.process else { return Default::default() };
        let due = process.saying.front_mut().and_then(|submission| submission.due(now)).cloned();
        (due.into_iter().collect(), story)
    }

    fn start(&mut self, scene: &Scene, wanted: &str, now: Time) {
        let user = TruthfulUser::new(scene, wanted, false).expect("an object of the scene");
        self.arrived = self.history.clone();
        self.process = Some(Process {
            quiet_since: now,
            latest: Latest::default(),
            user,
            waiting: Waiting::new(self.reported),
            saying: VecDeque::new(),
            shown: (PromptId(0), now),
        });
    }

    /// Takes in the outcome, or says what there is to say.
    fn next(&mut self, scene: &Scene, now: Time) -> Option<String> {
        if self.regret.is_some() {
            return self.regret(now);
        }
        let process = self.process.as_mut()?;
        if !self.has_asked {
            if process.saying.is_empty() {
                process.say("get me the bowl", now);
                return Some("user: get me the bowl".to_owned());
            }
            return None;
        }
        if let Some(ended) = process.waiting.look(&process.latest) {
            self.reported = ended.interaction.0;
            self.has_asked = false;
            match ended.outcome {
                Outcome::Delivered => {
                    self.wanted.pop_front();
                    self.regret = std::mem::take(&mut self.regrets).then_some(Regret::Felt);
                }
                Outcome::Cancelled => self.left += 1,
                _ => self.given_up += u32::from(self.could_answer),
            }
            if let Some(wanted) = self.wanted.front().cloned() {
                self.start(scene, &wanted, now);
            }
            return Some(format!("user: learns of {:?}, {:?}", ended.outcome, ended.name));
        }
        if self.calls_off_now(now) {
            return Some("user: never mind".to_owned());
        }
        let process = self.process.as_mut()?;
        self.could_answer |= now.since(process.quiet_since) >= TIME_TO_ANSWER;
        let answer = match self.hasty {
            Some(after) => process.hasty_answer(after, now)?,
            None => process.user.answer(&process.latest)?,
        };
        let key = process.say(&answer, now);
        self.answers.push((key, process.latest.prompt()));
        Some(format!("user: {answer} (to {:?})", process.latest.open_question()))
    }
}

impl Client {
    /// Calls the first fetch off when its time has come.
    fn calls_off_now(&mut self, now: Time) -> bool {
        let (Some(after), Some(process)) = (self.calls_off, &mut self.process) else {
            return false;
        };
        let view = process.latest.view.as_ref();
        if view.is_none_or(|view| view.decision != ActKind::Pick) {
            return false;
        }
        let is_due = now >= *self.announced.get_or_insert(now) + after;
        if is_due {
            self.calls_off = None;
            process.say("never mind", now);
        }
        is_due
    }

    /// Has what was delivered put back, and waits until it is.
    fn regret(&mut self, now: Time) -> Option<String> {
        const WISH: &str = "put it back";
        let process = self.process.as_mut()?;
        if self.regret == Some(Regret::Felt) {
            if !process.saying.is_empty() {
                return None;
            }
            process.say(WISH, now);
            return Some(format!("user: {WISH}"));
        }
        let view = process.latest.view.as_ref().filter(|_| process.latest.is_settled())?;
        if view.decision == ActKind::PutBack {
            return None;
        }
        self.put_back += u32::from(view.text.starts_with("I have put"));
        self.regret = None;
        Some(format!("user: learns that {:?}", view.text))
    }
}

impl Process {
    /// The answer to a question that was shown so long ago, whether or not the robot's voice has said it.
    fn hasty_answer(&mut self, after: Span, now: Time) -> Option<String> {
        let prompt = self.latest.view.as_ref()?.prompt;
        if self.shown.0.0 != prompt {
            self.shown = (PromptId(prompt), now);
        }
        if now < self.shown.1 + after {
            return None;
        }
        let state = PresentationState::Ended.code();
        let presented = Presented { prompt, presentation: 1, state, ..Presented::default() };
        let activity = Some(Activity::default());
        let shown = Latest { presented, activity, accepted: 0, ..self.latest.clone() };
        self.user.answer(&shown)
    }

    fn say(&mut self, text: &str, now: Time) -> RequestKey {
        let sound = Sound::Text(text.to_owned());
        let patience = Span(u64::MAX / 2);
        let submission = Submission::new(sound, (now, Time(0)), now, patience);
        let submission = submission.after(self.latest.prompt());
        let key = submission.key();
        self.saying.push_back(submission);
        key
    }
}
