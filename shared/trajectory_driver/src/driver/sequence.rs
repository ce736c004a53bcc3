//! The windows of one motion, and of those that it flows into.

use manipulation::Trajectory;
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::Window;
use crate::window::{self, EVERY_S, LEAD_S};

/// Latest time in a motion at which its first window may begin, seconds.
const BEGIN_MAX_S: f64 = 0.15;
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
    /// The arm was held up for longer than its windows last.
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

    /// Returns the sequence with a window of this motion.
    pub(super) fn send(
        motion: &Trajectory,
        (t_s, ahead_s): (f64, f64),
        (number, now): (u64, Time),
        joints: usize,
    ) -> Self {
        let part = window::part(motion, t_s + LEAD_S + ahead_s, joints);
        Self {
            window: Window { number, begin_ns: now.ns(), points: part.points },
            path_s: part.path_s,
            is_last: part.is_last,
            at: now,
            t_s,
            duration_s: motion.duration_s(),
            ahead_s,
            is_lost: false,
        }
    }

    /// Decides what is sent now.
    pub(super) fn next(&mut self, motion: &Trajectory, t_s: f64, now: Time) -> Next {
        let passed_s = now.since(self.at).s();
        let is_same = (motion.duration_s() - self.duration_s).abs() < 1e-9 && t_s >= self.t_s;
        if !is_same {
            // A halt, or the motion that this one flows into.
            return Next::Window(0.0);
        }
        if self.is_last || passed_s < EVERY_S - 0.001 {
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

    pub(super) fn age(&self, now: Time) -> Span {
        now.since(self.at)
    }
}

/// Returns whether nothing moves: the arm stands while its fingers do something.
fn is_constant(motion: &Trajectory) -> bool {
    let (start, middle, end) =
        (motion.start(), motion.sample(0.5 * motion.duration_s()).0, motion.end());
    let apart = |q: &[f64; 7]| start.iter().zip(q).any(|(a, b)| (a - b).abs() > 1e-9);
    !apart(&middle) && !apart(&end)
}
