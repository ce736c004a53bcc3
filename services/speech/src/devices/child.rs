//! Helper programs with a deadline.
//!
//! Invariant: no call waits longer than its deadline, and no child outlives the value that stands
//! for it, except when this process itself is killed; the supervisor then ends the process group,
//! to which the children belong.

use std::io::{ErrorKind, Read};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// Why a helper program did not do its work.
#[derive(Debug, thiserror::Error)]
pub enum ChildError {
    /// The program is not installed.
    #[error("the program {program} is not installed")]
    NotInstalled {
        /// Its name.
        program: String,
    },
    /// The system would not start it.
    #[error("{program} could not be started: {source}")]
    NotStarted {
        /// Its name.
        program: String,
        /// The system's reason.
        source: std::io::Error,
    },
    /// It ran longer than it may and was killed.
    #[error("{program} did not end within {deadline:?} and was killed")]
    Overdue {
        /// Its name.
        program: String,
        /// How long it may run.
        deadline: Duration,
    },
    /// It ended with an error.
    #[error("{program} failed ({status}): {message}")]
    Failed {
        /// Its name.
        program: String,
        /// How it ended.
        status: ExitStatus,
        /// The first lines of what it wrote to its standard error.
        message: String,
    },
}

/// How a program ended that was waited for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// By itself, successfully.
    Done,
    /// Killed because the wait was called off.
    CalledOff,
}

/// A running program; dropping it kills and reaps it.
pub(crate) struct Running {
    program: String,
    child: Child,
}

/// How often a running program is looked at. Speech is waited for in tenths of a second.
const LOOK: Duration = Duration::from_millis(5);
/// How much of a program's complaints is kept, in bytes; far below what a pipe holds.
const COMPLAINT_MAX: u64 = 500;

impl Running {
    /// Starts a program without input whose complaints are kept.
    pub(crate) fn start(mut command: Command) -> Result<Self, ChildError> {
        let program = command.get_program().to_string_lossy().into_owned();
        command.stdin(Stdio::null()).stderr(Stdio::piped());
        match command.spawn() {
            Ok(child) => Ok(Self { program, child }),
            Err(error) if error.kind() == ErrorKind::NotFound => {
                Err(ChildError::NotInstalled { program })
            }
            Err(source) => Err(ChildError::NotStarted { program, source }),
        }
    }

    /// Waits for the end. `pause` sleeps for the given time or less and tells whether to call it
    /// off.
    pub(crate) fn wait(
        &mut self,
        deadline: Duration,
        mut pause: impl FnMut(Duration) -> bool,
    ) -> Result<End, ChildError> {
        let start = Instant::now();
        loop {
            match self.child.try_wait() {
                Ok(Some(status)) if status.success() => return Ok(End::Done),
                Ok(Some(status)) => return Err(self.failure(status)),
                Ok(None) => {}
                Err(source) => {
                    let program = self.program.clone();
                    return Err(ChildError::NotStarted { program, source });
                }
            }
            if start.elapsed() >= deadline {
                self.kill();
                return Err(ChildError::Overdue { program: self.program.clone(), deadline });
            }
            if pause(LOOK) {
                self.kill();
                return Ok(End::CalledOff);
            }
        }
    }

    fn failure(&mut self, status: ExitStatus) -> ChildError {
        let mut said = Vec::new();
        if let Some(stderr) = self.child.stderr.take() {
            // What cannot be read is left out of the message.
            let _ = stderr.take(COMPLAINT_MAX).read_to_end(&mut said);
        }
        let message = String::from_utf8_lossy(&said).trim().replace('\n', "; ");
        ChildError::Failed { program: self.program.clone(), status, message }
    }

    fn kill(&mut self) {
        // Both fail only if it has ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        self.kill();
    }
}

/// Runs a program to its end and returns what it wrote to its standard output, which must fit into
/// a pipe (64 KiB on Linux).
pub(crate) fn output(mut command: Command, deadline: Duration) -> Result<Vec<u8>, ChildError> {
    command.stdout(Stdio::piped());
    let mut running = Running::start(command)?;
    running.wait(deadline, sleep)?;
    let mut said = Vec::new();
    if let Some(mut stdout) = running.child.stdout.take() {
        let program = running.program.clone();
        stdout
            .read_to_end(&mut said)
            .map_err(|source| ChildError::NotStarted { program, source })?;
    }
    Ok(said)
}

/// Runs a program to its end, without its output.
pub(crate) fn run(mut command: Command, deadline: Duration) -> Result<(), ChildError> {
    command.stdout(Stdio::null());
    Running::start(command)?.wait(deadline, sleep).map(|_| ())
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

    #[test]
    fn output_is_returned() {
        let said = output(shell("echo hello"), Duration::from_secs(5)).unwrap();
        assert_eq!(said, b"hello\n");
    }

    #[test]
    fn failure_tells_status_and_complaint() {
        let error = run(shell("echo no card >&2; exit 3"), Duration::from_secs(5)).unwrap_err();
        let text = error.to_string();
        assert!(text.contains("exit status: 3") && text.contains("no card"), "{text}");
    }

    #[test]
    fn an_unknown_program_is_named() {
        let error = run(Command::new("no-such-program-here"), LOOK).unwrap_err();
        assert_eq!(error.to_string(), "the program no-such-program-here is not installed");
    }

    #[test]
    fn a_program_past_its_deadline_is_killed() {
        let start = Instant::now();
        let error = run(shell("exec sleep 30"), Duration::from_millis(50)).unwrap_err();
        assert!(matches!(error, ChildError::Overdue { .. }), "{error}");
        assert!(start.elapsed() < Duration::from_secs(10));
    }

    #[test]
    fn a_wait_can_be_called_off() {
        let mut running = Running::start(shell("exec sleep 30")).unwrap();
        let end = running.wait(Duration::from_secs(20), |_| true).unwrap();
        assert_eq!(end, End::CalledOff);
        assert!(running.child.try_wait().unwrap().is_some());
    }
}
