//! Progress of one order: when it is repeated, when its giver is warned, and when it is over.

use std::io;
use std::thread;

use messages::{MotionInhibit, MotionOrder, StopId};

use super::{RESUME_AFTER, StopClient, StopError, StopOrder, StopState, kept};
use crate::{Span, Time};

/// Interval at which an order is repeated.
pub(super) const RESEND_EVERY: Span = Span::from_ms(10);
/// Time without an answer before the giver is warned; the lack of a process counts at once.
const SILENCE: Span = Span::from_ms(250);
/// Time for an arm that has answered to come to rest, before the giver is warned.
const HALTS_WITHIN: Span = Span::from_ms(1_000);
/// Age from which an answer says nothing about the present.
const ANSWER_AGE_MAX: Span = Span::from_ms(500);
/// Interval between warnings.
const WARN_EVERY: Span = Span::from_ms(3_000);
/// Time that a stop of an arm at rest is given to become durable.
const DURABLE_GRACE: Span = Span::from_ms(500);
/// Time for the robot to be heard, which an arm that has just started needs.
const HEARD_GRACE: Span = Span::from_ms(1_000);
/// Time for a release; a later one would surprise.
pub const RELEASE_PATIENCE: Span = Span::from_ms(5_000);

/// Returns the default time for which an order is repeated: a stop for as long as the group's
/// folder `run` exists, so that no restart of the arm's service nor hold outlasts it.
pub fn default_patience(order: MotionOrder) -> Option<Span> {
    (order == MotionOrder::Resume).then_some(RELEASE_PATIENCE)
}

/// Progress of one order. Callers pass the time: `advance`, then see `result` and `warning`.
#[derive(Debug)]
pub struct Progress {
    order: MotionOrder,
    /// The stop that a release is meant for, 0 for any.
    stop: StopId,
    given: Time,
    /// Time at which it was given first.
    since: Time,
    patience: Option<Span>,
    sent: Option<Time>,
    warned: Option<Time>,
    /// No process listened to the latest repetition.
    is_absent: bool,
    /// The order cannot be sent.
    failure: Option<StopError>,
    /// The latest answer, and when it came.
    state: Option<(StopState, Time)>,
    /// The stop is kept in a file as well.
    is_kept: bool,
    /// Time since which the arm has been stopped and at rest.
    rests_since: Option<Time>,
    /// Time since which the stop has been latched while the robot is not heard.
    unheard_since: Option<Time>,
}

impl Progress {
    /// An order given at `given` and carried out within `patience`, or failed; without `patience`
    /// it is repeated until the arm confirms it, a later order overrules it, or the group ends.
    pub fn new(order: MotionOrder, given: Time, patience: impl Into<Option<Span>>) -> Self {
        Self {
            order,
            stop: StopId(0),
            given,
            since: given,
            patience: patience.into(),
            sent: None,
            warned: None,
            is_absent: false,
            failure: None,
            state: None,
            is_kept: false,
            rests_since: None,
            unheard_since: None,
        }
    }

    /// Names the stop that a release is meant for; 0 stands for any.
    pub fn of(self, stop: StopId) -> Self {
        Self { stop, ..self }
    }

    /// The order.
    pub fn order(&self) -> MotionOrder {
        self.order
    }

    /// Time at which it was given, latest.
    pub fn given(&self) -> Time {
        self.given
    }

    /// Time at which it was given first.
    pub fn since(&self) -> Time {
        self.since
    }

    /// Notes that the same order is given again, at `given`, for `stop`. Deadline and warnings count
    /// from the first time, so that a flood of orders puts off neither.
    pub fn renew(&mut self, given: Time, stop: StopId) {
        (self.given, self.stop) = (given, stop);
        self.sent = None;
        self.forget_answers();
    }

    /// Repeats the order if due, and processes the answers.
    pub fn advance(&mut self, client: &StopClient, now: Time) {
        if self.due(now) {
            let order = StopOrder { stop: self.stop, ..StopOrder::new(self.order, self.given) };
            self.on_sent(&client.send(&order));
        }
        while let Some(state) = client.take() {
            self.on_answer(state, now);
        }
        if self.is_settled(now) {
            if std::mem::take(&mut self.is_kept) {
                kept::forget(&client.paths.kept_stop());
            }
        } else if !self.is_kept
            && self.must_be_kept()
            && (self.is_absent || now.since(self.since) >= SILENCE)
        {
            self.is_kept = true;
            // A disk that hangs must not hold up the repetitions.
            let (paths, given_ns) = (client.paths.clone(), client.machine_ns(self.given));
            let keep = move || kept::keep(&paths, given_ns);
            let _ = thread::Builder::new().name("keep-stop".into()).spawn(keep);
        }
    }

    /// Keeps a stop that no arm is known to have for the arm's return, because its giver ends. A
    /// group that was never started has no arm.
    /// # Errors
    /// It cannot be kept: nothing repeats it any more.
    pub fn leave(&self, client: &StopClient) -> io::Result<()> {
        match self.must_be_kept() && client.paths.root().is_dir() {
            true => kept::keep(&client.paths, client.machine_ns(self.given)),
            false => Ok(()),
        }
    }

    /// Returns whether the order is a stop that no arm is known to have.
    fn must_be_kept(&self) -> bool {
        let is_taken = self.state.is_some_and(|(state, _)| state.stopped);
        self.order == MotionOrder::Stop && !is_taken
    }

    /// Returns whether the order is due, with its time [`Progress::given`]: repeating is harmless.
    pub fn due(&mut self, now: Time) -> bool {
        let is_due = self.sent.is_none_or(|sent| now >= sent + RESEND_EVERY);
        if is_due {
            self.sent = Some(now);
        }
        is_due
    }

    /// Notes the outcome of sending. After its end, the answers of a process do not count.
    pub fn on_sent(&mut self, sent: &Result<(), StopError>) {
        self.is_absent = matches!(sent, Err(StopError::Absent));
        match sent {
            Err(StopError::Absent) => self.forget_answers(),
            Err(error) => self.failure = Some(error.clone()),
            // A failure that has passed must not hide the arm's confirmation.
            Ok(()) => self.failure = None,
        }
    }

    /// Takes in an answer; those to other orders are ignored.
    pub fn on_answer(&mut self, state: StopState, now: Time) {
        if state.given_ns != self.given.ns() {
            return;
        }
        let is_heard = state.is_heard();
        let since = |before: Option<Time>, holds: bool| holds.then(|| before.unwrap_or(now));
        self.rests_since = since(self.rests_since, state.stopped && state.at_rest && is_heard);
        self.unheard_since = since(self.unheard_since, state.stopped && !is_heard);
        self.state = Some((state, now));
    }

    fn forget_answers(&mut self) {
        (self.state, self.rests_since, self.unheard_since) = (None, None, None);
    }

    /// Returns the result once there is one: a stop is latched, at rest and durable, or cannot
    /// become durable; a release is in force.
    ///
    /// # Errors
    /// As [`super::give`].
    pub fn result(&self, now: Time) -> Option<Result<StopState, StopError>> {
        if let Some(failure) = &self.failure {
            return Some(Err(failure.clone()));
        }
        let is_late = self.patience.is_some_and(|patience| now.since(self.since) >= patience);
        let lasts = |since: Option<Time>, span| since.is_some_and(|since| now.since(since) >= span);
        let state = self.state.map(|(state, _)| state);
        let done = state.filter(|state| match self.order {
            MotionOrder::Resume => !state.stopped,
            MotionOrder::Stop => {
                self.rests_since.is_some()
                    && (state.durable || is_late || lasts(self.rests_since, DURABLE_GRACE))
            }
        });
        if let Some(state) = done {
            return Some(Ok(state));
        }
        let is_other = |state: StopState| state.stop > StopId(0) && state.stop != self.stop;
        if self.stop > StopId(0) && state.is_some_and(is_other) {
            return Some(Err(StopError::OtherStop));
        }
        if state.is_some_and(|state| self.is_overruled(&state)) {
            return Some(Err(StopError::Overruled));
        }
        let is_too_soon = |state: StopState| Time(state.in_force_ns) + RESUME_AFTER > self.given;
        if self.order == MotionOrder::Resume && state.is_some_and(is_too_soon) {
            return Some(Err(StopError::TooSoon));
        }
        if self.order == MotionOrder::Stop && lasts(self.unheard_since, HEARD_GRACE) {
            return Some(Err(StopError::Unheard));
        }
        is_late.then(|| Err(self.why(now)))
    }

    /// Returns whether the order needs no repetition: it is final, or a later one is in force.
    pub fn is_settled(&self, now: Time) -> bool {
        match self.result(now) {
            Some(Ok(state)) => state.durable,
            Some(Err(error)) => error == StopError::Overruled,
            None => false,
        }
    }

    fn is_overruled(&self, state: &StopState) -> bool {
        let is_contrary = state.stopped != (self.order == MotionOrder::Stop);
        is_contrary && state.in_force_ns > self.given.ns()
    }

    /// Returns a warning for the giver if one is due: soon after the order, and every few seconds
    /// while it is not confirmed.
    pub fn warning(&mut self, now: Time) -> Option<StopError> {
        let is_due = match self.warned {
            Some(warned) => now >= warned + WARN_EVERY,
            None => {
                let patience = self.state.map_or(SILENCE, |_| HALTS_WITHIN);
                self.is_absent || now.since(self.since) >= patience
            }
        };
        if !is_due || self.rests_since.is_some() {
            return None;
        }
        self.warned = Some(now);
        Some(self.why(now))
    }

    /// Returns why the order is not confirmed.
    pub fn why(&self, now: Time) -> StopError {
        let waited_s = now.since(self.since).s();
        let is_recent = |(_, at): &(StopState, Time)| now.since(*at) < ANSWER_AGE_MAX;
        match self.state.filter(is_recent).map(|(state, _)| state) {
            None if self.is_absent => StopError::Absent,
            None => StopError::Silent(waited_s),
            Some(state) if state.stopped != (self.order == MotionOrder::Stop) => {
                StopError::NotTaken(waited_s, state.inhibit)
            }
            Some(state) if !state.is_heard() => StopError::Unheard,
            Some(_) => StopError::Moving(waited_s),
        }
    }
}

impl StopState {
    /// Returns false if the robot is silent: its being at rest is then an assumption.
    pub fn is_heard(&self) -> bool {
        !matches!(self.inhibit, MotionInhibit::Unheard | MotionInhibit::Stale)
    }
}
