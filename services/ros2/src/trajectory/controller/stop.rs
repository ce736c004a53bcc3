//! A stop: every goal is cancelled, again and again, until the controller has answered and the joints are measured to
//! stand; a goal that holds the arm goes beside it.

use service::{Span, Time};
use trajectory_driver::JointMeasurement;

/// Interval of requests to cancel.
const CANCEL_EVERY: Span = Span::from_ms(50);
/// Interval of goals that hold the arm, while it moves.
const HOLD_EVERY: Span = Span::from_ms(100);
/// Duration of such a goal, seconds.
pub(super) const HOLD_S: f64 = 0.2;
/// Age beyond which a joint state proves nothing.
const STALE: Span = Span::from_ms(150);
/// Joint states in a row in which the joints must stand after the controller's answer.
const STILL_MIN: u32 = 3;
/// Time for which they must stand in them: joints that turn back stand for a moment too.
const STILL_FOR: Span = Span::from_ms(100);
/// Time for which they must stand without an answer: longer than any window lasts.
const STILL_WITHOUT: Span = Span::from_ms(750);

/// Return codes of a request to cancel that say that every goal is being cancelled, or over.
const NONE: i8 = 0;
const TERMINATED: i8 = 3;

/// A stop under way.
#[derive(Debug)]
pub(super) struct Stop {
    /// Number of the arm's order; 0 for one of the bridge's own.
    pub(super) number: u64,
    /// When the controller has answered.
    answered: Option<Time>,
    cancelled: Option<Time>,
    held: Option<Time>,
    /// The latest joint state, and how many in a row stood since the answer.
    still: (u64, u32),
    /// Since when the joints are measured to stand.
    still_since: Option<Time>,
}

/// What a stop asks for.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Wants {
    pub(super) cancels: bool,
    /// Where the arm is to be held.
    pub(super) holds_at: Option<Vec<f64>>,
    pub(super) is_done: bool,
}

impl Stop {
    pub(super) fn new(number: u64) -> Self {
        Self {
            number,
            answered: None,
            cancelled: None,
            held: None,
            still: (0, 0),
            still_since: None,
        }
    }

    /// Takes in the answer to a request to cancel; `has_active` says whether a goal is known to be under way.
    pub(super) fn on_answer(&mut self, code: i8, has_active: bool, now: Time) {
        if [NONE, TERMINATED].contains(&code) || !has_active {
            self.answered.get_or_insert(now);
        }
    }

    pub(super) fn advance(
        &mut self,
        joints: Option<&JointMeasurement>,
        still_rad_s: f64,
        now: Time,
    ) -> Wants {
        let fresh = joints.filter(|it| now.since(Time(it.at_ns)) <= STALE);
        let moving = fresh.filter(|it| it.qd.iter().any(|v| v.abs() >= still_rad_s));
        match fresh {
            Some(joints) => self.count(joints.at_ns, moving.is_some()),
            None => self.still_since = None,
        }
        let is_held = self.held.is_some_and(|at| now.since(at) < Span::from_s(HOLD_S));
        let stood = self.still_since.is_some_and(|since| now.since(since) > STILL_WITHOUT);
        if !is_held && (self.has_stood() || stood) {
            return Wants { is_done: true, ..Wants::default() };
        }
        let due = |last: Option<Time>, every| last.is_none_or(|at| now.since(at) >= every);
        let cancels = due(self.cancelled, CANCEL_EVERY);
        if cancels {
            self.cancelled = Some(now);
        }
        let holds_at = moving.filter(|_| due(self.held, HOLD_EVERY)).map(|joints| joints.q.clone());
        if holds_at.is_some() {
            self.held = Some(now);
        }
        Wants { cancels, holds_at, is_done: false }
    }

    /// Returns whether the joints have stood for long enough since the answer, by the times of joint states.
    fn has_stood(&self) -> bool {
        let (latest, count) = self.still;
        let since =
            self.still_since.zip(self.answered).map(|(still, answered)| still.max(answered));
        count >= STILL_MIN && since.is_some_and(|since| Time(latest).since(since) >= STILL_FOR)
    }

    fn count(&mut self, at_ns: u64, is_moving: bool) {
        let (latest, count) = self.still;
        let counts = self.answered.is_some_and(|answered| at_ns > answered.ns());
        if at_ns != latest {
            self.still = (at_ns, if counts && !is_moving { count + 1 } else { 0 });
            self.still_since = (!is_moving).then(|| self.still_since.unwrap_or(Time(at_ns)));
        }
    }
}
