//! The control protocol between operators and the supervisor.
//!
//! One connection to the group's control socket carries one request and one reply, each a JSON
//! object on a line of its own. A request that waits is answered once: as soon as its condition
//! holds, can no longer hold, or its timeout has passed.

use std::path::PathBuf;

use crate::exit::Exit;
use serde::{Deserialize, Serialize};

use crate::status::GroupStatus;

pub use client::{CallError, PendingReply, call, send};
pub use watch::{Watched, watch_supervisor};

mod client;
mod watch;

/// Maximum size of a request, bytes; the longest part is the command line of a swap.
pub const REQUEST_BYTES_MAX: usize = 64 << 10;

/// A request of an operator. With `wait_ms` of 0 it is answered at once.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "verb", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Request {
    /// A liveness check. Answered by [`Reply::Done`].
    Ping,
    /// The state of the group. Answered by [`Reply::Status`].
    Status,
    /// Waits until every service that is wanted up is ready.
    WaitReady {
        /// Timeout, milliseconds.
        wait_ms: u64,
    },
    /// Wants a service up; lifts a hold.
    Start(Target),
    /// Wants a service down.
    Stop(Target),
    /// Stops a service, if it runs, and starts it.
    Restart {
        /// Name of the service.
        service: String,
        /// True to restore the configured command of a swapped service.
        #[serde(default)]
        original: bool,
        /// Timeout for the readiness of the new incarnation, milliseconds.
        wait_ms: u64,
    },
    /// Stops a service and keeps it from running until it is released.
    Hold(Target),
    /// Lifts a hold, an operator's or the supervisor's own.
    Release(Target),
    /// Replaces a service's program; the old one is put back if the new one does not become ready
    /// within the service's start deadline. Answered when that is decided.
    Swap {
        /// The service's name.
        service: String,
        /// Program and arguments.
        command: Vec<String>,
        /// Working folder of the command: the caller's own.
        directory: PathBuf,
    },
    /// Reloads the configuration and restarts the affected services. Answered by
    /// [`Reply::Reloaded`].
    Reload {
        /// Timeout for their readiness, milliseconds.
        wait_ms: u64,
    },
    /// Reloads the configuration with another scene, which stays in force for later reloads until
    /// the group ends. Answered by [`Reply::Reloaded`].
    UseScene {
        /// As `group.scene`: the name of a scene of the configuration, or a path from its folder.
        scene: String,
        /// Timeout for the readiness of the restarted services, milliseconds.
        wait_ms: u64,
    },
    /// Stops the group in order. Answered by [`Reply::Down`] when nothing of it is left.
    Down,
}

/// The service that a request is about.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Name of the service.
    pub service: String,
    /// Timeout for its end, or for its readiness if it is wanted up, milliseconds.
    pub wait_ms: u64,
}

impl Target {
    /// A service by its name, and the timeout.
    pub fn new(service: &str, wait_ms: u64) -> Self {
        Self { service: service.to_owned(), wait_ms }
    }
}

/// An answer of the supervisor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "reply", rename_all = "kebab-case")]
pub enum Reply {
    /// The request is fulfilled or under way.
    Done {
        /// The result, in a sentence.
        message: String,
    },
    /// See [`Request::Status`].
    Status(Box<GroupStatus>),
    /// The new configuration is in force.
    Reloaded {
        /// Services restarted because of the change.
        restarted: Vec<String>,
    },
    /// The group is down.
    Down(DownReport),
    /// The request is rejected.
    Refused(Refusal),
}

/// Report on the end of a group.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct DownReport {
    /// Services that did not end when asked and were killed.
    pub killed: Vec<String>,
    /// Processes that services had left behind and that were killed.
    #[serde(rename = "strays")]
    pub orphans: Vec<String>,
    /// Files in shared memory that had to be removed by name.
    pub leftovers: Vec<String>,
    /// Time from the request to the end, seconds.
    pub seconds: f64,
}

/// Reason for which a request is not fulfilled.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Refusal {
    /// Kind of the refusal.
    pub kind: RefusalKind,
    /// The reason, in a sentence.
    pub message: String,
    /// More lines: problems of a configuration, or the tail of a log.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub details: Vec<String>,
}

/// Kinds of refusals.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RefusalKind {
    /// An invalid request: no such service, no such program.
    Usage,
    /// An invalid configuration.
    Config,
    /// A file cannot be written.
    Storage,
    /// The awaited condition was not reached, or the change was rolled back.
    NotReached,
}

impl Refusal {
    /// A refusal without further lines.
    pub fn new(kind: RefusalKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into(), details: Vec::new() }
    }

    /// The exit code that a command line ends with.
    pub fn exit(&self) -> Exit {
        match self.kind {
            RefusalKind::Usage => Exit::Usage,
            RefusalKind::Config => Exit::Config,
            RefusalKind::Storage => Exit::Storage,
            RefusalKind::NotReached => Exit::NotReached,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check_line(request: Request, line: &str) {
        assert_eq!(serde_json::to_string(&request).unwrap(), line);
        assert_eq!(serde_json::from_str::<Request>(line).unwrap(), request);
    }

    #[test]
    fn control_requests_are_plain_json_lines() {
        check_line(Request::Ping, r#"{"verb":"ping"}"#);
        check_line(Request::WaitReady { wait_ms: 5000 }, r#"{"verb":"wait-ready","wait_ms":5000}"#);
        let line = r#"{"verb":"hold","service":"arm","wait_ms":0}"#;
        check_line(Request::Hold(Target::new("arm", 0)), line);
        check_line(
            Request::Swap {
                service: "grounding".into(),
                command: vec!["python3".into(), "grounding.py".into()],
                directory: "/home/me".into(),
            },
            r#"{"verb":"swap","service":"grounding","command":["python3","grounding.py"],"directory":"/home/me"}"#,
        );
        check_line(
            Request::UseScene { scene: "tools".into(), wait_ms: 9 },
            r#"{"verb":"use-scene","scene":"tools","wait_ms":9}"#,
        );
    }

    #[test]
    fn control_requests_with_spelling_errors_are_rejected() {
        let wrong = [
            r#"{"verb":"strat"}"#,
            r#"{"verb":"stop"}"#,
            "{",
            r#"{"verb":"stop","service":"arm","wait_ms":0,"now":1}"#,
        ];
        for line in wrong {
            let error = serde_json::from_str::<Request>(line).unwrap_err().to_string();
            assert!(!error.is_empty(), "{line}");
        }
    }
}
