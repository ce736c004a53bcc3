//! State of one service's machine.

use std::time::Duration;

use super::{Actual, HeldBecause};
use crate::Time;

/// See [`Actual`]; here with what each state needs to be left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum State {
    Down,
    Starting {
        since: Time,
    },
    Ready {
        since: Time,
    },
    Stopping {
        since: Time,
        step: Step,
        why: Why,
        ready_for: Option<Duration>,
    },
    /// `short`: for want of a resource.
    Backoff {
        short: bool,
    },
    Held(HeldBecause),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Terminating,
    Aborting,
    Killing,
}

/// Reason for stopping; determines the interpretation of the exit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Why {
    Asked,
    Hold,
    Failed,
}

impl State {
    pub(super) fn actual(self) -> Actual {
        match self {
            Self::Down => Actual::Down,
            Self::Starting { .. } => Actual::Starting,
            Self::Ready { .. } => Actual::Ready,
            Self::Stopping { .. } => Actual::Stopping,
            Self::Backoff { .. } => Actual::Backoff,
            Self::Held(_) => Actual::Held,
        }
    }

    /// Returns the time for which it has been ready, if it is.
    pub(super) fn ready_for(self, now: Time) -> Option<Duration> {
        match self {
            Self::Ready { since } => Some(now.saturating_sub(since)),
            _ => None,
        }
    }
}
