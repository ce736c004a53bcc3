//! The words of the state machine: what is wanted, what is, what happened, what to do about it.

use std::fmt;
use std::time::Duration;

use crate::configuration::{Restart, RestartLimits, ServiceSpec};
use service::exit::ProcessExit;

/// Input of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// It is wanted up, once the services that it comes after are ready.
    Start,
    /// The services that it comes after are ready.
    Admit,
    /// It is wanted down, now.
    Stop,
    /// It is wanted down; if it runs, its turn to stop comes later.
    Retire,
    /// It is wanted up, in a new incarnation, now.
    Restart,
    /// It is to be kept from running until released.
    Hold,
    /// Lifts a hold of the operator or the supervisor.
    Release,
    /// It said that it is ready.
    Ready,
    /// Its main loop went round.
    Beat,
    /// It asks for this much more time for what it does.
    Extend(Duration),
    /// It says that it is short of a resource, or no longer is.
    Short(bool),
    /// Its process has been reaped (or could not be made).
    Exited(ProcessExit),
    /// Time has passed.
    Clock,
}

/// Output of the machine, to be carried out by the supervisor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// Start a new incarnation.
    Spawn,
    /// Ask it to end: TERM, then CONT, since a stopped process would keep TERM pending.
    Terminate,
    /// Make it abort, so that it leaves a trace of where it was stuck: ABRT, then CONT.
    Abort,
    /// Kill its process group.
    Kill,
}

/// Reason for holding a service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldBecause {
    /// An operator wants it so.
    Operator,
    /// Its last exit says that another start cannot help.
    Permanent(ProcessExit),
    /// It ended this often within the window.
    TooOften(u32),
    /// So many starts in a row were not ready in time.
    NeverReady(u32),
    /// It failed, and its restart policy is `never`.
    Policy,
}

impl fmt::Display for HeldBecause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Operator => write!(f, "held by the operator"),
            Self::Permanent(exit) => write!(f, "{exit}"),
            Self::TooOften(exits) => write!(f, "{exits} exits in a short time"),
            Self::NeverReady(starts) => write!(f, "{starts} starts, none ready in time"),
            Self::Policy => write!(f, "its restart policy is never"),
        }
    }
}

/// The deadlines and limits that a machine keeps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Time from start to ready.
    pub start: Duration,
    /// Longest silence between beats once ready.
    pub watchdog: Option<Duration>,
    /// Time from the request to stop to the kill.
    pub stop: Duration,
    /// Exits that are followed by a restart.
    pub restart: Restart,
    /// Limits and backoff of restarts.
    pub restart_limits: RestartLimits,
}

impl Limits {
    /// Those of a service in a group with these restart limits.
    pub fn of(service: &ServiceSpec, restart_limits: RestartLimits) -> Self {
        Self {
            start: service.start_deadline,
            watchdog: service.watchdog,
            stop: service.stop_deadline,
            restart: service.restart,
            restart_limits,
        }
    }
}
