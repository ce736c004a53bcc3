//! Errors of the verbs.

use std::io;

use diagnostics::Diagnostics;
use service::bus::{BusError, PortError};
use service::client::ClientError;
use service::control::{CallError, Refusal};
use service::exit::{Exit, Failure};
use service::group::GroupError;
use service::launch::LaunchError;

/// Result of a verb: its exit code, or an error to print.
pub type Outcome = Result<Exit, CliError>;

/// Error of a verb.
#[derive(Debug, thiserror::Error)]
pub enum CliError {
    /// A message for people, with an exit code for scripts.
    #[error(transparent)]
    Failure(#[from] Failure),
    /// Failed output: a closed pipe is not a failure, anything else is.
    #[error("cannot print: {0}")]
    Output(io::Error),
}

impl CliError {
    /// CliError with its exit code and reason.
    pub fn new(exit: Exit, reason: impl Into<String>) -> Self {
        Self::Failure(Failure::new(exit, reason))
    }

    /// A file that cannot be read or written.
    pub fn file(path: &std::path::Path, error: &io::Error) -> Self {
        Self::new(Exit::Storage, format!("{}: {error}", path.display()))
    }
}

impl From<ClientError> for CliError {
    fn from(error: ClientError) -> Self {
        match error {
            ClientError::Bus(error) => error.into(),
            other => Self::new(Exit::NotReached, other.to_string()),
        }
    }
}

impl From<BusError> for CliError {
    fn from(error: BusError) -> Self {
        Self::Failure(error.into())
    }
}

impl From<PortError> for CliError {
    fn from(error: PortError) -> Self {
        Self::Failure(error.into())
    }
}

impl From<GroupError> for CliError {
    fn from(error: GroupError) -> Self {
        Self::new(Exit::Usage, error.to_string())
    }
}

impl From<CallError> for CliError {
    fn from(error: CallError) -> Self {
        Self::new(Exit::NotReached, error.to_string())
    }
}

impl From<LaunchError> for CliError {
    fn from(error: LaunchError) -> Self {
        Self::new(error.exit(), error.to_string())
    }
}

impl From<Refusal> for CliError {
    fn from(refusal: Refusal) -> Self {
        let details = refusal.details.iter().map(|line| format!("\n  {line}"));
        let exit = refusal.exit();
        Self::new(exit, details.fold(refusal.message, |text, line| text + &line))
    }
}

impl From<Diagnostics> for CliError {
    fn from(diagnostics: Diagnostics) -> Self {
        Self::new(Exit::Config, diagnostics.to_string())
    }
}
