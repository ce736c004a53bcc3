//! Status of a group and its services, as `whichone status` shows it.

use std::path::PathBuf;

use build_info::BuildInfo;
use serde::{Deserialize, Serialize};

use crate::exit::ProcessExit;

/// A group at one moment.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroupStatus {
    /// Name of the group.
    pub name: String,
    /// State of the group as a whole.
    pub state: GroupState,
    /// The supervisor's process.
    pub supervisor_pid: u32,
    /// The supervisor's version, with its commit.
    pub version: String,
    /// The supervisor's build. None in the status of an earlier version.
    #[serde(default)]
    pub build: Option<BuildInfo>,
    /// Time since the supervisor's start, seconds.
    pub uptime_s: f64,
    /// Life of the journals.
    pub epoch: u64,
    /// The scene's name.
    pub scene: String,
    /// The profile in force.
    pub profile: Option<String>,
    /// The configuration's folder.
    pub config: PathBuf,
    /// Overrides of configuration values: dotted key and value. `None` if the group follows the
    /// configuration of another machine, as a mirror does.
    #[serde(default)]
    pub set: Option<Vec<(String, String)>>,
    /// Processes that services had left behind and that were killed, since the start.
    #[serde(rename = "strays_killed")]
    pub orphans_killed: u32,
    /// The supervisor's own memory, KiB.
    pub rss_kib: Option<u64>,
    /// Processor time that the supervisor has used, seconds.
    pub cpu_s: Option<f64>,
    /// The services, in the order of the configuration.
    pub services: Vec<ServiceStatus>,
}

/// A service at one moment. Properties of a running process are `None` while there is none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ServiceStatus {
    /// Name of the service.
    pub name: String,
    /// Desired state.
    pub wanted: Wanted,
    /// Actual state.
    pub actual: Actual,
    /// The state in one word, for a person.
    #[serde(default)]
    pub state: ServiceState,
    /// Reason for a difference between the two: awaited services, a shortage, cause of a hold.
    pub why: Option<String>,
    /// Process id of the service.
    pub pid: Option<u32>,
    /// Number of the current or last start; 0 before the first.
    pub incarnation: u32,
    /// Time since that start, seconds.
    pub uptime_s: Option<f64>,
    /// Starts after the first.
    pub restarts: u32,
    /// Time since the last beat of its main loop, milliseconds.
    pub beat_age_ms: Option<u64>,
    /// Age of its oldest pending input, milliseconds, as last reported.
    pub input_age_ms: Option<u64>,
    /// Version reported by the service.
    pub version: Option<String>,
    /// Activity reported by the service.
    pub says: Option<String>,
    /// Messages of other processes that it has rejected as impossible since its start.
    #[serde(default)]
    pub rejected: u64,
    /// Messages that it has lost since its start because it did not read them in time. Only readers
    /// of every message count them: the recorder, and the console for live views.
    #[serde(default)]
    pub lost: u64,
    /// Syncs of its journal since its start.
    #[serde(default)]
    pub journal_syncs: u64,
    /// Time that these syncs took, seconds.
    #[serde(default)]
    pub journal_sync_s: f64,
    /// The command that has replaced the configured one.
    pub swapped: Option<Vec<String>>,
    /// End of the previous incarnation.
    pub last_exit: Option<LastExit>,
    /// The last lines of the log of a held service.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub log_tail: Vec<String>,
    /// Resident memory, KiB.
    pub rss_kib: Option<u64>,
    /// Processor time used, seconds.
    pub cpu_s: Option<f64>,
}

impl ServiceStatus {
    /// Returns advice to a person about the state; `None` if none is needed, or the reason has it.
    pub fn help(&self) -> Option<String> {
        let name = &self.name;
        match self.state {
            ServiceState::Held => Some(format!("whichone release {name}")),
            ServiceState::Failed => Some(format!("whichone logs {name}, then start {name}")),
            ServiceState::Short if self.has_own_help() => None,
            ServiceState::Short => Some("free some; it is retried by itself".to_owned()),
            ServiceState::Down => Some(format!("whichone start {name}")),
            ServiceState::Waiting
            | ServiceState::Starting
            | ServiceState::Ready
            | ServiceState::Stopping
            | ServiceState::Restarting => None,
        }
    }

    /// Whether the reason of its state ends with help of its own.
    fn has_own_help(&self) -> bool {
        self.why.as_deref().is_some_and(|why| why.contains("; help: "))
    }

    /// Returns a sentence with reason and remedy if the service is unavailable until a person acts
    /// or a shortage ends; `None` if it works or soon will.
    pub fn unavailable(&self) -> Option<String> {
        let (name, why) = (&self.name, self.why.as_deref());
        if self.state == ServiceState::Short && self.has_own_help() {
            return Some(format!("{name} {}", why.unwrap_or_default()));
        }
        let help = self.help()?;
        Some(match self.state {
            ServiceState::Held => format!("{name} is held by the operator; help: {help}"),
            ServiceState::Short => format!("{name} {}; help: {help}", why.unwrap_or("is short")),
            ServiceState::Failed => {
                format!("{name} has failed: {}; help: {help}", why.unwrap_or("not restarted"))
            }
            _ => format!("{name} is stopped; help: {help}"),
        })
    }
}

/// State of a service in one word: being held is not a failure, nor is waiting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ServiceState {
    /// Not running and not wanted.
    #[default]
    Down,
    /// Waiting for the services that it comes after.
    Waiting,
    /// Running, not ready yet.
    Starting,
    /// Running and ready.
    Ready,
    /// Asked to shut down.
    Stopping,
    /// Ended unexpectedly; restarted in a moment.
    Restarting,
    /// Short of a resource (disk, shared memory, descriptors); retried until there is some.
    Short,
    /// Held by the operator.
    Held,
    /// Given up: it failed too often, or a restart cannot help.
    Failed,
}

impl ServiceState {
    /// The word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Down => "down",
            Self::Waiting => "waiting",
            Self::Starting => "starting",
            Self::Ready => "ready",
            Self::Stopping => "stopping",
            Self::Restarting => "restarting",
            Self::Short => "short",
            Self::Held => "held",
            Self::Failed => "failed",
        }
    }
}

/// The end of an incarnation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LastExit {
    /// Number of the incarnation.
    pub incarnation: u32,
    /// Exit of the process.
    pub exit: ProcessExit,
    /// The missed deadline for which it was stopped, if any.
    pub failure: Option<Failure>,
    /// True if it had to be killed.
    pub killed: bool,
    /// Time since then, seconds.
    pub age_s: f64,
    /// Summary.
    pub text: String,
}

/// State of a group as a whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum GroupState {
    /// Services are being started for the first time.
    #[default]
    Starting,
    /// Every service that is wanted up is ready and short of nothing.
    Ready,
    /// Some service that is wanted up is not ready, or is short of a resource.
    Degraded,
    /// Services are being stopped in order.
    Stopping,
}

/// Desired state of a service.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Wanted {
    /// Running.
    #[default]
    Up,
    /// Not running.
    Down,
}

/// Actual state of a service.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Actual {
    /// Not running; if wanted up, waiting for the services in its `after` list.
    #[default]
    Down,
    /// Running, not ready yet.
    Starting,
    /// Running and ready.
    Ready,
    /// Running, asked to shut down.
    Stopping,
    /// Not running, waiting to be restarted.
    Backoff,
    /// Not running, not restarted until an operator requests it.
    Held,
}

/// Missed deadline for which the supervisor stopped a service.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Failure {
    /// Not ready within the start deadline.
    NotReady,
    /// No beat of its main loop within the watchdog's period.
    NoBeat,
}
