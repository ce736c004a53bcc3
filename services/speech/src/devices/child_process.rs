//! Child processes with a deadline.
//!
//! Invariant: no call waits longer than its deadline, and no child outlives its [`ChildProcess`],
//! except when this process is killed; the supervisor then ends the process group, which contains the
//! children.

use std::io::{ErrorKind, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Error of running a program.
#[derive(Debug, thiserror::Error)]
pub enum ProcessError {
    /// Not installed.
    #[error("the program {program} is not installed")]
    NotInstalled {
        /// Name of the program.
        program: String,
    },
    /// Not started.
    #[error("{program} cannot be started: {source}")]
    NotStarted {
        /// Name of the program.
        program: String,
        /// Reason.
        source: std::io::Error,
    },
    /// Killed at its deadline.
    #[error("{program} did not exit within {deadline:?} and was killed")]
    Overdue {
        /// Name of the program.
        program: String,
        /// The deadline.
        deadline: Duration,
    },
    /// Exited with an error.
    #[error("{program} failed ({status}): {message}")]
    Failed {
        /// Name of the program.
        program: String,
        /// Exit status.
        status: ExitStatus,
        /// Beginning of its standard error.
        message: String,
    },
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
    program: String,
    child: Child,
}

/// Polling interval.
const POLL_EVERY: Duration = Duration::from_millis(5);
/// Part of the standard error that is kept, bytes; far below the capacity of a pipe.
const STDERR_MAX: u64 = 500;

impl ChildProcess {
    /// Starts a program without input and captures its standard error.
    pub(crate) fn start(mut command: Command) -> Result<Self, ProcessError> {
        let program = command.get_program().to_string_lossy().into_owned();
        command.stdin(Stdio::null()).stderr(Stdio::piped());
        match command.spawn() {
            Ok(child) => Ok(Self { program, child }),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(ProcessError::NotInstalled { program })
            }
            Err(source) => Err(ProcessError::NotStarted { program, source }),
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
                Ok(Some(status)) => return Err(self.failure(status)),
                Ok(None) => {}
                Err(source) => {
                    let program = self.program.clone();
                    return Err(ProcessError::NotStarted { program, source });
                }
            }
            if start.elapsed() >= deadline {
                self.kill();
                return Err(ProcessError::Overdue { program: self.program.clone(), deadline });
            }
            if pause(POLL_EVERY) {
                self.kill();
                return Ok(End::Cancelled);
            }
        }
    }

    fn failure(&mut self, status: ExitStatus) -> ProcessError {
        let mut output = Vec::new();
        if let Some(stderr) = self.child.stderr.take() {
            // An unreadable part is omitted from the message.
            let _ = stderr.take(STDERR_MAX).read_to_end(&mut output);
        }
        let message = String::from_utf8_lossy(&output).trim().replace('\n', "; ");
        ProcessError::Failed { program: self.program.clone(), status, message }
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
        let program = running.program.clone();
        stdout
            .read_to_end(&mut output)
            .map_err(|source| ProcessError::NotStarted { program, source })?;
    }
    Ok(output)
}

/// Runs a program to its end and discards its output.
pub(crate) fn run(mut command: Command, deadline: Duration) -> Result<(), ProcessError> {
    command.stdout(Stdio::null());
    ChildProcess::start(command)?.wait(deadline, sleep).map(|_| ())
}

fn sleep(time: Duration) -> bool {
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
        assert!(matches!(error, ProcessError::Overdue { .. }), "{error}");
        let mut running = ChildProcess::start(shell("exec sleep 30")).unwrap();
        assert_eq!(running.wait(Duration::from_secs(20), |_| true).unwrap(), End::Cancelled);
        assert!(running.child.try_wait().unwrap().is_some());
        assert!(start.elapsed() < Duration::from_secs(10));
    }
}
