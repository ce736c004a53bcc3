//! Exit codes: part of the contract with the supervisor and with scripts.

use std::process::ExitCode;

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

/// Premature end of a service.
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// The exit code, from which the supervisor decides about a restart.
    pub exit: Exit,
    /// For the log and the operator's status.
    pub message: String,
}

impl Failure {
    /// A failure with its reason.
    pub fn new(exit: Exit, message: impl Into<String>) -> Self {
        Self { exit, message: message.into() }
    }
}

impl From<crate::bus::BusError> for Failure {
    fn from(error: crate::bus::BusError) -> Self {
        let exit = match error {
            crate::bus::BusError::Schema { .. } => Exit::Config,
            crate::bus::BusError::Ipc { .. } => Exit::NotReached,
        };
        Self::new(exit, error.to_string())
    }
}

impl From<crate::bus::PortError> for Failure {
    fn from(error: crate::bus::PortError) -> Self {
        Self::new(Exit::NotReached, error.to_string())
    }
}

impl From<crate::NodeError> for Failure {
    fn from(error: crate::NodeError) -> Self {
        Self::new(Exit::Config, error.to_string())
    }
}
