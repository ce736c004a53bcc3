//! Starting a service's process.

use std::ffi::OsString;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use rustix::process::Pid;
use thiserror::Error;

use crate::before_exec;
use crate::child::Child;
use crate::lifeline::Lifeline;
use service::exit::ProcessExit;
use service::launch;
use service::program::{ProgramError, find_program};

/// A program could not be started.
#[derive(Debug, Error)]
pub enum SpawnError {
    /// There is no such program.
    #[error(transparent)]
    Program(#[from] ProgramError),
    /// Error of the operating system with a file.
    #[error("{}: {}", .0.display(), .1)]
    Io(PathBuf, io::Error),
}

impl SpawnError {
    /// Converts the error to an exit of the service, which determines if a retry may succeed.
    pub(crate) fn as_exit(&self) -> ProcessExit {
        match self {
            Self::Io(_, error) => match error.kind() {
                ErrorKind::NotFound | ErrorKind::PermissionDenied => ProcessExit::NotStartable,
                ErrorKind::InvalidInput | ErrorKind::ArgumentListTooLong => {
                    ProcessExit::NotStartable
                }
                _ => ProcessExit::NotStarted,
            },
            Self::Program(_) => ProcessExit::NotStartable,
        }
    }
}

/// Starts a process that leads its own process group; `log` receives its standard output and error.
pub(crate) fn spawn(
    words: &[String],
    directory: &Path,
    environment: Vec<(&str, OsString)>,
    log: File,
    nice: i32,
    lifeline: &Lifeline,
) -> Result<Child, SpawnError> {
    let program = find_program(words, directory)?;
    let failed = |error| SpawnError::Io(program.clone(), error);
    let mut command = launch::command(&program);
    command
        .args(&words[1..])
        .current_dir(directory)
        // Meant for the supervisor itself, where an init system has started it.
        .env_remove("WATCHDOG_PID")
        .env_remove("WATCHDOG_USEC")
        .envs(environment)
        .stdin(Stdio::null())
        .stdout(log.try_clone().map_err(failed)?)
        .stderr(log)
        .process_group(0);
    before_exec::prepare(&mut command, lifeline.inherited(), nice);
    let started = command.spawn().map_err(failed)?;
    // The handle is dropped without a wait: the child is reaped through its pidfd.
    let pid = Pid::from_child(&started);
    let child = Child::new(pid).map_err(failed)?;
    set_niceness(pid, nice);
    Ok(child)
}

/// Sets the niceness. One below that of the supervisor needs a permission that few users have.
fn set_niceness(pid: Pid, wanted: i32) {
    let found = rustix::process::getpriority_process(Some(pid));
    if wanted != 0 && found.is_ok_and(|found| found != wanted) {
        tracing::warn!(%pid, wanted, "niceness not permitted; it runs without");
    }
}
