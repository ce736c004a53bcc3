//! Child processes with a deadline.
//!
//! Invariant: no call waits longer than its deadline, and no child outlives its [`ChildProcess`],
//! except when this process is killed; the supervisor then ends the process group, which contains
//! the children.

use std::fmt::Display;
use std::io::{ErrorKind, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Error of running a program.
#[derive(Debug, thiserror::Error)]
pub(crate) enum ProcessError {
    /// The program of this name is not installed.
    #[error("the program {0} is not installed")]
    NotInstalled(String),
    /// The program was not started, exited with an error, or was killed at its deadline.
    #[error("{0}")]
    Failed(String),
}

/// Outcome of a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// The program succeeded.
    Done,
    /// The wait was cancelled and the program killed.
    Cancelled,
}

/// A running program. Dropping it kills and reaps it.
pub(crate) struct ChildProcess {
    pub(crate) program: String,
    pub(crate) child: Child,
}

/// Polling interval.
const POLL_EVERY: Duration = Duration::from_millis(5);
/// Part of the standard error that is kept, bytes; far below the capacity of a pipe.
const STDERR_MAX: u64 = 500;

impl ChildProcess {
    /// Starts a program without input and captures its standard error.
    pub(crate) fn start(mut command: Command) -> Result<Self, ProcessError> {
        command.stdin(Stdio::null()).stderr(Stdio::piped());
        Self::spawn(command)
    }

    /// Starts a program with the input and outputs of the command.
    pub(crate) fn spawn(mut command: Command) -> Result<Self, ProcessError> {
        let program = command.get_program().to_string_lossy().into_owned();
        match command.spawn() {
            Ok(child) => Ok(Self { program, child }),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(ProcessError::NotInstalled(program))
            }
            Err(error) => {
                Err(ProcessError::Failed(format!("{program} cannot be started: {error}")))
            }
        }
    }

    /// Waits for the end. `pause` sleeps for at most the given time and returns whether to cancel.
    pub(crate) fn wait(
        &mut self,
        deadline: Duration,
        mut pause: impl FnMut(Duration) -> bool,
    ) -> Result<End, ProcessError> {
        let start = Instant::now();
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) if status.success() => return Ok(End::Done),
                Ok(Some(status)) => return Err(self.exit_failure(status)),
                Ok(None) => {}
                Err(error) => return Err(self.failure(&error)),
            }
            if start.elapsed() >= deadline {
                self.kill();
                let what = format!("it did not exit within {deadline:?} and was killed");
                return Err(self.failure(&what));
            }
            if pause(POLL_EVERY) {
                self.kill();
                return Ok(End::Cancelled);
            }
        }
    }

    fn failure(&self, why: &dyn Display) -> ProcessError {
        ProcessError::Failed(format!("{} failed: {why}", self.program))
    }

    /// Returns the error of a program that exited, with the beginning of its standard error.
    fn exit_failure(&mut self, status: ExitStatus) -> ProcessError {
        let mut output = Vec::new();
        if let Some(stderr) = self.child.stderr.take() {
            // An unreadable part is omitted from the message.
            let _ = stderr.take(STDERR_MAX).read_to_end(&mut output);
        }
        let mut message = String::from_utf8_lossy(&output).trim().replace('\n', "; ");
        if !message.is_empty() {
            message.insert_str(0, ": ");
        }
        ProcessError::Failed(format!("{} failed ({status}){message}", self.program))
    }

    fn kill(&mut self) {
        // Both fail only if it has exited already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for ChildProcess {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Runs a program to its end and returns its standard output, which must fit into a pipe (64 KiB on
/// Linux).
pub(crate) fn output(mut command: Command, deadline: Duration) -> Result<Vec<u8>, ProcessError> {
    command.stdout(Stdio::piped());
    let mut running = ChildProcess::start(command)?;
    running.wait(deadline, sleep)?;
    let mut output = Vec::new();
    if let Some(mut stdout) = running.child.stdout.take() {
        stdout.read_to_end(&mut output).map_err(|error| running.failure(&error))?;
    }
    Ok(output)
}

/// Runs a program to its end and discards its output.
pub(crate) fn run(mut command: Command, deadline: Duration) -> Result<(), ProcessError> {
    command.stdout(Stdio::null());
    ChildProcess::start(command)?.wait(deadline, sleep).map(|_| ())
}

/// Waits without cancelling.
pub(crate) fn sleep(time: Duration) -> bool {
    thread::sleep(time);
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("sh");
        command.args(["-c", script]);
        command
    }

    const PATIENCE: Duration = Duration::from_secs(5);

    #[test]
    fn child_process_returns_output_or_status_and_standard_error() {
        assert_eq!(output(shell("echo hello"), PATIENCE).unwrap(), b"hello\n");
        let error = run(shell("echo no card >&2; exit 3"), PATIENCE).unwrap_err().to_string();
        assert!(error.contains("exit status: 3") && error.contains("no card"), "{error}");
        let error = run(Command::new("no-such-program-here"), PATIENCE).unwrap_err();
        assert_eq!(error.to_string(), "the program no-such-program-here is not installed");
    }

    #[test]
    fn child_process_is_killed_at_its_deadline_or_on_cancellation() {
        let start = Instant::now();
        let error = run(shell("exec sleep 30"), Duration::from_millis(50)).unwrap_err();
        assert!(error.to_string().contains("did not exit within 50ms"), "{error}");
        let mut running = ChildProcess::start(shell("exec sleep 30")).unwrap();
        assert_eq!(running.wait(Duration::from_secs(20), |_| true).unwrap(), End::Cancelled);
        assert!(running.child.try_wait().unwrap().is_some());
        assert!(start.elapsed() < Duration::from_secs(10));
    }
}
