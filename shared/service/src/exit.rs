//! Exit codes and failures of the group's programs, and the failures that only this crate knows.

pub use runtime::exit::{Exit, Failure, ProcessExit};

use crate::NodeError;
use crate::control::{CallError, Refusal};
use crate::launch::LaunchError;

impl From<NodeError> for Failure {
    fn from(error: NodeError) -> Self {
        Self::new(Exit::Config, error.to_string())
    }
}

impl From<CallError> for Failure {
    fn from(error: CallError) -> Self {
        match error {
            CallError::Refused(refusal) => refusal.into(),
            other => Self::new(Exit::NotReached, other.to_string()),
        }
    }
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Self {
        let details = refusal.details.iter().map(|line| format!("\n  {line}"));
        let exit = refusal.exit();
        Self::new(exit, details.fold(refusal.message, |text, line| text + &line))
    }
}

impl From<LaunchError> for Failure {
    fn from(error: LaunchError) -> Self {
        match error {
            LaunchError::Call(error) => error.into(),
            other => Self::new(other.exit(), other.to_string()),
        }
    }
}
