//! Specification of a group: its services in order, and their limits.

use std::time::Duration;

pub use config::{Log, Restart, RestartLimits};

/// A group as configured, checked: names are unique, `after` names exist and form no cycle
/// (see [`Schedule::new`](crate::schedule::Schedule::new)).
#[derive(Clone, Debug, PartialEq)]
pub struct GroupSpec {
    /// Services in the order of the configuration.
    pub services: Vec<ServiceSpec>,
    /// Limits and backoff of restarts.
    pub restart: RestartLimits,
    /// Logs of the services.
    pub log: Log,
}

/// One service as configured.
#[derive(Clone, Debug, PartialEq)]
pub struct ServiceSpec {
    /// Unique name, e.g. `grounding`.
    pub name: String,
    /// Program and arguments. A program without a slash is looked for in `PATH`.
    pub command: Vec<String>,
    /// Services that must be ready before this one is started for the first time.
    pub after: Vec<String>,
    /// True if the whole group stops in order when this service is given up.
    pub critical: bool,
    /// Time from start to `READY=1`.
    pub start_deadline: Duration,
    /// Maximum time between two heartbeats once ready; `None` disables the watchdog.
    pub watchdog: Option<Duration>,
    /// Time from the request to stop to the kill.
    pub stop_deadline: Duration,
    /// Scheduling niceness, −20 … 19.
    pub nice: i32,
    /// Exits that are followed by a restart.
    pub restart: Restart,
    /// Everything of the configuration that this service reads, in a form that differs exactly
    /// when it has to be restarted to take notice.
    pub fingerprint: String,
}
