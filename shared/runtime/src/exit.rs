//! Exit codes, the failures that lead to them, and the exits of other processes: part of the
//! contract with the supervisor and with scripts.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::Path;
use std::process::ExitCode;

use diagnostics::Diagnostics;
use serde::{Deserialize, Serialize};

use crate::bus::{BusError, PortError, SegmentError};
use crate::client::ClientError;
use crate::group::GroupError;
use crate::stop_socket::StopError;

/// Exit code of a program of the group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exit {
    /// Success.
    Ok = 0,
    /// The requested condition was not reached; a retry may succeed.
    NotReached = 1,
    /// Invalid usage.
    Usage = 64,
    /// An invariant is broken: a defect of the program.
    Invariant = 70,
    /// The journal or another file cannot be written.
    Storage = 74,
    /// Configuration, scene or message schema do not fit. A restart does not help.
    Config = 78,
}

impl Exit {
    /// The exit whose code a process of the group ended with; `None` if a signal ended it.
    pub fn of_process(code: Option<i32>) -> Self {
        match code {
            Some(0) => Self::Ok,
            Some(64) => Self::Usage,
            Some(70) => Self::Invariant,
            Some(74) => Self::Storage,
            Some(78) => Self::Config,
            _ => Self::NotReached,
        }
    }

    /// Converts to the exit code of a process.
    pub fn code(self) -> ExitCode {
        ExitCode::from(self as u8)
    }
}

/// Premature end of a service or a verb.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// The exit code, from which the supervisor decides about a restart.
    pub exit: Exit,
    /// For the log, the operator's status and the terminal. Empty if there is nothing to report.
    pub message: String,
}

impl Failure {
    /// Makes a failure with its reason and exit code.
    pub fn new(exit: Exit, message: impl Into<String>) -> Self {
        Self { exit, message: message.into() }
    }

    /// A file that cannot be read or written.
    pub fn file(path: &Path, error: &io::Error) -> Self {
        Self::new(Exit::Storage, format!("{}: {error}", path.display()))
    }

    /// Output that cannot be printed. A closed pipe is the reader's choice: the program ends
    /// silently and with success.
    pub fn output(error: io::Error) -> Self {
        match error.kind() {
            ErrorKind::BrokenPipe => Self::new(Exit::Ok, ""),
            _ => Self::new(Exit::Storage, format!("cannot print: {error}")),
        }
    }
}

impl From<BusError> for Failure {
    fn from(error: BusError) -> Self {
        let exit = match error {
            BusError::Schema { .. } => Exit::Config,
            BusError::Segment {
                cause: SegmentError::Room { .. } | SegmentError::Descriptors { .. },
                ..
            } => Exit::Storage,
            BusError::Segment { .. } | BusError::Ipc { .. } => Exit::NotReached,
        };
        Self::new(exit, error.to_string())
    }
}

impl From<PortError> for Failure {
    fn from(error: PortError) -> Self {
        Self::new(Exit::NotReached, error.to_string())
    }
}

impl From<Diagnostics> for Failure {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::new(Exit::Config, diagnostics.to_string())
    }
}

impl From<GroupError> for Failure {
    fn from(error: GroupError) -> Self {
        Self::new(Exit::Usage, error.to_string())
    }
}

impl From<ClientError> for Failure {
    fn from(error: ClientError) -> Self {
        match error {
            ClientError::Bus(error) => error.into(),
            other => Self::new(Exit::NotReached, other.to_string()),
        }
    }
}

impl From<StopError> for Failure {
    fn from(error: StopError) -> Self {
        Self::new(Exit::NotReached, error.to_string())
    }
}

/// Exit of one incarnation of a service.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ProcessExit {
    /// Exit of the process with the given code.
    Code(i32),
    /// End of the process by the given signal.
    Signal(i32),
    /// The process could not be started; a retry may succeed (e.g. no process slot).
    NotStarted,
    /// The process could not be started; a retry cannot succeed (e.g. no such program).
    NotStartable,
}

impl ProcessExit {
    /// Returns true if a restart of the same command cannot help.
    pub fn is_permanent(self) -> bool {
        match self {
            Self::Code(code) => {
                matches!(Exit::of_process(Some(code)), Exit::Config | Exit::Usage)
            }
            exit => exit == Self::NotStartable,
        }
    }

    /// Returns true if it ended for lack of a resource: storage, shared memory (a page that cannot
    /// be had kills with SIGBUS), descriptors, process slots. The service is not at fault.
    pub fn is_shortage(self) -> bool {
        match self {
            Self::Code(code) => Exit::of_process(Some(code)) == Exit::Storage,
            Self::Signal(signal) => signal == SIGBUS,
            Self::NotStarted => true,
            Self::NotStartable => false,
        }
    }

    /// Returns true if it ended with exit code 0.
    pub fn is_clean(self) -> bool {
        self == Self::Code(0)
    }
}

impl fmt::Display for ProcessExit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Code(78) => write!(f, "exit 78 (configuration or schema refused)"),
            Self::Code(64) => write!(f, "exit 64 (command line refused)"),
            Self::Code(74) => write!(f, "exit 74 (storage)"),
            Self::Signal(SIGBUS) => write!(f, "signal BUS (shared memory is full)"),
            Self::Code(code) => write!(f, "exit {code}"),
            Self::Signal(signal) => match signal_name(signal) {
                Some(name) => write!(f, "signal {name}"),
                None => write!(f, "signal {signal}"),
            },
            Self::NotStarted | Self::NotStartable => write!(f, "could not be started"),
        }
    }
}

/// Ends a process that touches a page of a file or of shared memory which cannot be had.
const SIGBUS: i32 = 7;

/// Names of the signals that end services in practice; the same numbers on every Linux.
fn signal_name(signal: i32) -> Option<&'static str> {
    Some(match signal {
        1 => "HUP",
        2 => "INT",
        3 => "QUIT",
        4 => "ILL",
        6 => "ABRT",
        8 => "FPE",
        9 => "KILL",
        11 => "SEGV",
        13 => "PIPE",
        15 => "TERM",
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Only permanent exits prevent a restart, and only want of a resource is a shortage.
    #[test]
    fn exits_are_permanent_or_shortages_or_neither() {
        use ProcessExit::{Code, NotStartable, NotStarted, Signal};
        for exit in [Code(64), Code(78), NotStartable] {
            assert!(exit.is_permanent() && !exit.is_shortage(), "{exit}");
        }
        for exit in [Code(74), Signal(7), NotStarted] {
            assert!(exit.is_shortage() && !exit.is_permanent(), "{exit}");
        }
        for exit in [Code(0), Code(1), Code(70), Code(75), Signal(9)] {
            assert!(!exit.is_shortage() && !exit.is_permanent(), "{exit}");
        }
    }

    #[test]
    fn exits_are_displayed_with_signal_names() {
        assert_eq!(ProcessExit::Signal(9).to_string(), "signal KILL");
        assert_eq!(ProcessExit::Signal(40).to_string(), "signal 40");
        assert_eq!(ProcessExit::Code(3).to_string(), "exit 3");
    }
}
