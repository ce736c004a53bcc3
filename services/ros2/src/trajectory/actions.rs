//! Requests to an action server, its answers, and whether it lives.

use service::{Span, Time};

/// Identity of a goal.
pub type GoalId = [u8; 16];

/// Something that is asked of an action server.
#[derive(Clone, Debug, PartialEq)]
pub enum Request<G> {
    /// Carry out a goal.
    Goal(GoalId, G),
    /// Tell the end of a goal.
    Result(GoalId),
    /// Cancel every goal, whoever's it is.
    CancelAll,
    /// Cancel a goal that does not exist: a server that lives says so.
    Probe(GoalId),
}

/// An answer of an action server to one of these requests, not to those of others.
#[derive(Clone, Debug, PartialEq)]
pub enum Answer<R> {
    /// Whether a goal is accepted.
    Accepted(GoalId, bool),
    /// Status and result of a goal that has ended.
    Ended(GoalId, i8, R),
    /// Return code of a request to cancel every goal.
    Cancelled(i8),
    /// A probe has come back.
    Probed,
    /// The statuses of all goals, of others too.
    Statuses(Vec<(GoalId, i8)>),
}

/// Statuses of goals.
pub mod status {
    /// Accepted, not begun.
    pub const ACCEPTED: i8 = 1;
    /// Being cancelled.
    pub const CANCELING: i8 = 3;
    /// Reached.
    pub const SUCCEEDED: i8 = 4;
    /// Cancelled.
    pub const CANCELED: i8 = 5;
    /// Aborted.
    pub const ABORTED: i8 = 6;

    /// Returns whether a goal of this status is not over.
    pub fn is_active(status: i8) -> bool {
        (ACCEPTED..=CANCELING).contains(&status)
    }
}

/// Makes identities of goals, by which those of an earlier process are recognised.
#[derive(Clone, Debug)]
pub struct Identity {
    /// The group.
    group: [u8; 8],
    /// The process.
    life: [u8; 4],
    count: u32,
}

impl Identity {
    /// Returns the identity of a group's process, which `began` at a time that no other one began at.
    pub fn new(group: u64, began: Time) -> Self {
        let life = (began.ns() / 1_000_000) as u32;
        Self { group: group.to_be_bytes(), life: life.to_be_bytes(), count: 0 }
    }

    /// Returns the identity of another goal.
    pub fn next_goal(&mut self) -> GoalId {
        self.count = self.count.wrapping_add(1);
        let mut id = [0; 16];
        id[..8].copy_from_slice(&self.group);
        id[8..12].copy_from_slice(&self.life);
        id[12..].copy_from_slice(&self.count.to_be_bytes());
        id
    }

    /// Returns whether a goal is of this group.
    pub fn is_of_group(&self, id: &GoalId) -> bool {
        id[..8] == self.group
    }

    /// Returns whether a goal is of this process.
    pub fn is_own(&self, id: &GoalId) -> bool {
        self.is_of_group(id) && id[8..12] == self.life
    }
}

/// Interval of probes of a server that is asked nothing else.
const PROBE_EVERY: Span = Span::from_ms(500);
/// Age of the latest answer beyond which a server is probed.
const QUIET: Span = Span::from_ms(1_000);
/// Age of the latest answer beyond which a server is silent.
const SILENT: Span = Span::from_ms(2_500);

/// Whether an action server lives: nothing else tells that it is there.
#[derive(Clone, Debug)]
pub struct Liveness {
    /// Longest time to the answer to a goal.
    within: Span,
    heard: Option<Time>,
    probed: Option<Time>,
    /// The oldest goal that waits for its answer.
    asked: Option<Time>,
}

impl Liveness {
    /// Returns the liveness of a server before its first answer; to a goal it is to answer `within` a time.
    pub fn new(within: Span) -> Self {
        Self { within, heard: None, probed: None, asked: None }
    }

    /// Takes in any answer to a request. Statuses are none: those of a server that hangs are still delivered.
    pub fn on_answer(&mut self, now: Time) {
        self.heard = Some(now);
        if self.is_overdue(now) {
            // The goal was lost, and the server lives.
            self.asked = None;
        }
    }

    fn is_overdue(&self, now: Time) -> bool {
        self.asked.is_some_and(|asked| now.since(asked) > self.within)
    }

    /// Takes in that a goal was sent.
    pub fn on_goal(&mut self, now: Time) {
        self.asked.get_or_insert(now);
    }

    /// Takes in the answer to a goal.
    pub fn on_accepted(&mut self) {
        self.asked = None;
    }

    /// Returns whether a probe is due, and counts it as sent.
    pub fn probes(&mut self, now: Time) -> bool {
        let is_quiet = self.heard.is_none_or(|heard| now.since(heard) > QUIET);
        let is_due = (is_quiet || self.is_overdue(now))
            && self.probed.is_none_or(|at| now.since(at) >= PROBE_EVERY);
        if is_due {
            self.probed = Some(now);
        }
        is_due
    }

    /// Returns whether the server has ever answered.
    pub fn is_heard(&self) -> bool {
        self.heard.is_some()
    }

    /// Returns whether a server that has answered before does not any more.
    pub fn is_silent(&self, now: Time) -> bool {
        self.heard.is_some_and(|heard| now.since(heard) > SILENT) || self.is_overdue(now)
    }
}
