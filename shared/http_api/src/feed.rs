//! The main loop's half: words on their way to the robot, and the newest state.

use std::os::fd::BorrowedFd;
use std::sync::Arc;

use messages::{
    ClientId, Injection, PromptId, Receipt, ReceiptStatus, RequestKey, RobotAct, Sound,
};
use service::bus::EncodedWriter;
use service::submission::Submission;
use service::worker_channel::DeviceReceiver;
use service::{Span, Time};
use tokio::sync::oneshot;

use crate::events::Events;
use crate::state::{Answers, Robot, State};

/// Time for the speech service to accept words.
pub(crate) const PATIENCE: Span = Span::from_ms(8_000);
/// Most requests of one pass; the rest waits for the next.
const REQUESTS_MAX: usize = 64;
/// Most words without a receipt.
const WAITING_MAX: usize = 256;

/// Words to be said to the robot.
#[derive(Debug)]
pub(crate) struct Request {
    pub(crate) key: RequestKey,
    pub(crate) text: String,
    /// Who speaks; empty: nobody in particular.
    pub(crate) from: String,
    /// The latest prompt that the user was shown.
    pub(crate) seen: PromptId,
    pub(crate) answer: oneshot::Sender<Heard>,
}

/// What became of words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Heard {
    /// They are utterance `seq`, which will be applied. It was `known` where an earlier request had the same key.
    Accepted { seq: u64, known: bool },
    /// Other words have this key.
    Conflict(u64),
    /// The speech service refuses them, with its reason.
    Refused(String),
    /// A service does nothing for now, in a sentence.
    Unavailable(String),
    /// No receipt in time, or too much waits.
    Lost(&'static str),
}

#[derive(Debug)]
struct Waiting {
    submission: Submission,
    /// Highest utterance that had been accepted before.
    accepted: u64,
    answer: Option<oneshot::Sender<Heard>>,
}

/// Words without a receipt, and the state. Lives on the console's main thread.
#[derive(Debug)]
pub struct Feed {
    requests: DeviceReceiver<Request>,
    events: Arc<Events>,
    waiting: Vec<Waiting>,
    answers: Answers,
    /// `true` where the state has not been published since.
    is_answered: bool,
}

impl Feed {
    pub(crate) fn new(requests: DeviceReceiver<Request>, events: Arc<Events>) -> Self {
        Self {
            requests,
            events,
            waiting: Vec::new(),
            answers: Answers::default(),
            is_answered: false,
        }
    }

    /// Descriptor that is readable while requests wait.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.requests.fd()
    }

    /// Returns whether words wait for a receipt, so that the next pass should come soon.
    pub fn is_busy(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Takes in an act of the policy.
    pub fn on_act(&mut self, act: &RobotAct) {
        self.is_answered |= self.answers.add(act);
    }

    /// Takes in a receipt of the speech service.
    pub fn on_receipt(&mut self, receipt: &Receipt) {
        let key = receipt.request();
        for waiting in self.waiting.extract_if(.., |it| it.submission.key() == key) {
            let note = || receipt.note.as_str().unwrap_or_default().to_owned();
            let seq = receipt.seq;
            let heard = match receipt.status.get() {
                _ if waiting.submission.conflicts_with(receipt) => Heard::Conflict(seq),
                ReceiptStatus::Accepted => Heard::Accepted { seq, known: seq <= waiting.accepted },
                _ => Heard::Refused(note()),
            };
            waiting.answer(heard);
        }
    }

    /// Takes requests, sends what is due, and gives up what has expired. `accepted` is the highest utterance that is known
    /// to be accepted, `unavailable` why the speech service does nothing for now.
    pub fn pass(
        &mut self,
        writer: &EncodedWriter<Injection>,
        accepted: u64,
        unavailable: impl Fn() -> Option<String>,
        now: Time,
    ) {
        self.requests.clear();
        for _ in 0..REQUESTS_MAX {
            let Some(request) = self.requests.take() else { break };
            self.accept(request, accepted, unavailable(), now);
        }
        for Waiting { submission, .. } in &mut self.waiting {
            if let Some(Err(error)) = submission.due(now).map(|request| writer.send(request)) {
                tracing::debug!(%error, "utterance not sent yet");
            }
        }
        let expired = |it: &mut Waiting| it.submission.is_expired(now);
        for waiting in self.waiting.extract_if(.., expired) {
            waiting.answer(Heard::Lost("the speech service does not answer"));
        }
    }

    fn accept(&mut self, request: Request, accepted: u64, unavailable: Option<String>, now: Time) {
        let Request { key, text, from, seen, answer } = request;
        let submission = Submission::new(Sound::Text(text), (now, Time(0)), now, PATIENCE);
        let submission = submission.after(seen).by(from).under(key);
        let waiting = Waiting { submission, accepted, answer: Some(answer) };
        match unavailable {
            Some(why) => waiting.answer(Heard::Unavailable(why)),
            None if self.waiting.len() >= WAITING_MAX => {
                waiting.answer(Heard::Lost("too many words wait for the speech service"));
            }
            None => self.waiting.push(waiting),
        }
    }

    /// Publishes the state where a message `has_changed` it.
    pub fn publish(&mut self, robot: &Robot<'_>, has_changed: bool) {
        if has_changed || std::mem::take(&mut self.is_answered) {
            self.is_answered = false;
            self.events.publish(State::new(robot, self.answers.clone()));
        }
    }
}

impl Waiting {
    fn answer(mut self, heard: Heard) {
        // Who asked may have gone.
        let _ = self.answer.take().map(|answer| answer.send(heard));
    }
}

/// Returns the key of a request: the same for each repetition of it, in every incarnation of the console. Each token is
/// one client of the speech service.
pub fn request_key(token: &str, key: &str) -> RequestKey {
    let hash = |text: &str| {
        let mut hash = scene::StableHash::default();
        hash.text(text);
        hash.value()
    };
    RequestKey::new(ClientId(hash(&format!("http {token}"))), hash(key))
}
