//! The windows of one motion, and of those that it flows into.

use manipulation::Trajectory;
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::Window;
use crate::window::{self, EVERY_S, FIRST_PATH_S, LEAD_S, PATH_S};

/// Latest time in a motion at which its first window may begin, seconds.
const BEGIN_MAX_S: f64 = 0.15;
/// Time in which the controller accepts a window. Those that come later than its predecessor lasts would make the arm
/// catch up: controllers limit no speed.
const ACCEPT_WITHIN: Span = Span::from_ms(250);
/// Largest step of a joint from one window to the next, radians: the arm would catch up within the lead.
const STEP_MAX_RAD: f64 = 0.02;
/// Time by which the controller may be ahead of the arm before a window allows for it, seconds.
const AHEAD_SLACK_S: f64 = 0.005;

/// The latest window of a motion.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Sequence {
    window: Window,
    /// Length of its part of the motion, seconds.
    path_s: f64,
    is_last: bool,
    /// When it was made.
    at: Time,
    /// Time in the motion that it was made at.
    t_s: f64,
    /// Duration of that motion, seconds.
    duration_s: f64,
    /// Time by which the controller is ahead of the arm, which was held up, seconds.
    ahead_s: f64,
    /// The oldest window that the controller has not accepted yet, and when it was made.
    unaccepted: Option<(u64, Time)>,
    /// Whether the controller has accepted any.
    is_accepted: bool,
    /// The arm was held up for longer than its windows last, or the controller does not accept them.
    is_lost: bool,
}

/// What is to be sent.
pub(super) enum Next {
    /// Nothing.
    Nothing,
    /// A window so many seconds ahead of the arm's own time.
    Window(f64),
}

impl Sequence {
    /// Returns whether the windows of a motion may begin here: it begins at rest, and moves at all.
    pub(super) fn may_begin(motion: &Trajectory, t_s: f64) -> bool {
        t_s <= BEGIN_MAX_S && window::is_still(&motion.state(0.0)) && !is_constant(motion)
    }

    /// Returns the sequence that begins with a window of this motion, `t_s` into it.
    pub(super) fn begin(
        motion: &Trajectory,
        t_s: f64,
        (number, now): (u64, Time),
        joints: usize,
    ) -> Self {
        let mut begun = Self {
            window: Window::default(),
            path_s: 0.0,
            is_last: false,
            at: now,
            t_s,
            duration_s: 0.0,
            ahead_s: 0.0,
            unaccepted: None,
            is_accepted: false,
            is_lost: false,
        };
        begun.send(motion, (t_s, 0.0), (number, now), joints);
        begun
    }

    /// Replaces the window by one of this motion, `ahead_s` ahead of the arm's own time.
    pub(super) fn send(
        &mut self,
        motion: &Trajectory,
        (t_s, ahead_s): (f64, f64),
        (number, now): (u64, Time),
        joints: usize,
    ) {
        let path_s = if self.is_accepted { PATH_S } else { FIRST_PATH_S };
        let part = window::part(motion, (t_s + LEAD_S + ahead_s, path_s), joints);
        if let Some(expected) = self.expected(now + Span::from_s(LEAD_S))
            && furthest(&expected, &part.points[0].q) > STEP_MAX_RAD
        {
            self.is_lost = true;
            return;
        }
        self.window = Window { number, begin_ns: now.ns(), points: part.points };
        (self.path_s, self.is_last) = (part.path_s, part.is_last);
        (self.at, self.t_s, self.duration_s, self.ahead_s) =
            (now, t_s, motion.duration_s(), ahead_s);
        self.unaccepted.get_or_insert((number, now));
    }

    /// Returns where the window has the joints at a time; `None` before the first one.
    pub(super) fn expected(&self, at: Time) -> Option<Vec<f64>> {
        let points = &self.window.points;
        let t_s = (at.ns() as f64 - self.window.begin_ns as f64) * 1e-9;
        let Some(next) = points.iter().position(|point| point.t_s > t_s) else {
            return points.last().map(|point| point.q.clone());
        };
        let (before, after) = (&points[next.saturating_sub(1)], &points[next]);
        let span_s = after.t_s - before.t_s;
        let share = if span_s > 0.0 { (t_s - before.t_s) / span_s } else { 1.0 };
        Some(before.q.iter().zip(&after.q).map(|(a, b)| a + share * (b - a)).collect())
    }

    /// Takes in the newest window that the controller has accepted.
    pub(super) fn on_accepted(&mut self, accepted: u64) {
        if self.unaccepted.is_some_and(|(oldest, _)| accepted >= oldest) {
            self.is_accepted = true;
            self.unaccepted = (accepted < self.number()).then_some((accepted + 1, self.at));
        }
    }

    /// Decides what is sent now.
    pub(super) fn next(&mut self, motion: &Trajectory, t_s: f64, now: Time) -> Next {
        let passed_s = now.since(self.at).s();
        self.is_lost |= self.unaccepted.is_some_and(|(_, at)| now.since(at) > ACCEPT_WITHIN);
        if self.is_lost {
            return Next::Nothing;
        }
        let is_same = (motion.duration_s() - self.duration_s).abs() < 1e-9 && t_s >= self.t_s;
        if !is_same {
            // A halt begins at the arm's own time; the motion that this one flows into goes on from its end.
            let over_s = self.t_s + self.ahead_s + passed_s - self.duration_s;
            let flows = over_s > -2.0 * EVERY_S && t_s <= passed_s;
            return Next::Window(if flows { over_s - t_s } else { 0.0 });
        }
        if self.is_last || !self.is_accepted || passed_s < EVERY_S - 0.001 {
            return Next::Nothing;
        }
        if passed_s > self.path_s {
            self.is_lost = true;
            return Next::Nothing;
        }
        // The arm's own time stands still with its process; the controller's does not.
        let behind_s = self.t_s + self.ahead_s + passed_s - t_s;
        let ahead_s = if behind_s > self.ahead_s + AHEAD_SLACK_S { behind_s } else { self.ahead_s };
        Next::Window(ahead_s)
    }

    pub(super) fn window(&self) -> &Window {
        &self.window
    }

    pub(super) fn number(&self) -> u64 {
        self.window.number
    }

    /// Returns whether the motion ends in this window.
    pub(super) fn is_complete(&self) -> bool {
        self.is_last
    }

    pub(super) fn is_lost(&self) -> bool {
        self.is_lost
    }
}

/// Returns whether nothing moves: the arm stands while its fingers do something.
fn is_constant(motion: &Trajectory) -> bool {
    let (start, middle, end) =
        (motion.start(), motion.sample(0.5 * motion.duration_s()).0, motion.end());
    let apart = |q: &[f64; 7]| start.iter().zip(q).any(|(a, b)| (a - b).abs() > 1e-9);
    !apart(&middle) && !apart(&end)
}

/// Returns by how much two postures differ at most, radians.
fn furthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
