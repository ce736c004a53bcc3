//! Starting a service's process.

use std::ffi::{OsStr, OsString};
use std::fs::File;
use std::io::{self, ErrorKind};
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use rustix::fs::{Access, access};
use rustix::process::Pid;
use thiserror::Error;

use crate::before_exec;
use crate::child::Child;
use crate::lifeline::Lifeline;
use service::exit::ProcessExit;
use service::launch;

/// A program could not be started.
#[derive(Debug, Error)]
pub enum SpawnError {
    /// Empty command.
    #[error("the command is empty")]
    Empty,
    /// Program not found.
    #[error("{0}: no such program")]
    Missing(String),
    /// The program may not be run.
    #[error("{}: not an executable file", .0.display())]
    NotExecutable(PathBuf),
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
            Self::Empty | Self::Missing(_) | Self::NotExecutable(_) => ProcessExit::NotStartable,
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

/// The path of a command's program: searched for beside this program and in `PATH` where it has no
/// slash, else taken as seen from `directory`. One that is absent may be run by the `whichone` beside it.
///
/// # Errors
/// There is none, or it cannot be executed.
pub fn find_program(command: &[String], directory: &Path) -> Result<PathBuf, SpawnError> {
    let program = command.first().filter(|name| !name.is_empty()).ok_or(SpawnError::Empty)?;
    if program.contains('/') {
        let path = directory.join(program);
        return match path.metadata() {
            Ok(meta) if meta.is_file() && is_executable(&path) => Ok(path),
            Ok(_) => Err(SpawnError::NotExecutable(path)),
            Err(_) if launch::host_of(&path).is_some() => Ok(path),
            Err(_) => Err(SpawnError::Missing(path.display().to_string())),
        };
    }
    let own = std::env::current_exe().ok();
    let beside = own.and_then(|own| Some(own.parent()?.join(program)));
    let path = std::env::var_os("PATH").unwrap_or_default();
    beside
        .filter(|path| is_program(path) || launch::host_of(path).is_some())
        .or_else(|| search(program, &path))
        .ok_or_else(|| SpawnError::Missing(program.clone()))
}

fn search(program: &str, path: &OsStr) -> Option<PathBuf> {
    std::env::split_paths(path)
        .map(|folder| folder.join(program))
        .find(|candidate| is_program(candidate))
}

fn is_program(path: &Path) -> bool {
    path.is_file() && is_executable(path)
}

fn is_executable(path: &Path) -> bool {
    access(path, Access::EXEC_OK).is_ok()
}

/// Sets the niceness. One below that of the supervisor needs a permission that few users have.
fn set_niceness(pid: Pid, wanted: i32) {
    let found = rustix::process::getpriority_process(Some(pid));
    if wanted != 0 && found.is_ok_and(|found| found != wanted) {
        tracing::warn!(%pid, wanted, "niceness not permitted; it runs without");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn find(command: &[&str], directory: &Path) -> Result<PathBuf, SpawnError> {
        let command: Vec<String> = command.iter().map(|&part| part.into()).collect();
        find_program(&command, directory)
    }

    #[test]
    fn programs_beside_our_own_need_no_path() {
        let own = std::env::current_exe().unwrap();
        let name = own.file_name().unwrap().to_str().unwrap();
        assert_eq!(find(&[name], Path::new("/")).unwrap(), own);
    }

    #[test]
    fn program_lookup_follows_shell_rules() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("plain"), "").unwrap();
        let anywhere = Path::new("/");
        assert_eq!(find(&["/bin/sh"], anywhere).unwrap(), Path::new("/bin/sh"));
        assert_eq!(find(&["bin/sh", "-c"], anywhere).unwrap(), Path::new("/bin/sh"));
        assert!(find(&["sh"], anywhere).unwrap().is_absolute());
        assert!(matches!(find(&[], anywhere), Err(SpawnError::Empty)));
        assert!(matches!(find(&[""], anywhere), Err(SpawnError::Empty)));
        assert!(matches!(find(&["no-such-program"], anywhere), Err(SpawnError::Missing(_))));
        assert!(matches!(find(&["./none"], anywhere), Err(SpawnError::Missing(_))));
        let found = find(&["./plain"], folder.path());
        assert!(matches!(found, Err(SpawnError::NotExecutable(_))), "{found:?}");
        std::fs::write(folder.path().join("whichone"), "").unwrap();
        let hosted = folder.path().join("./whichone-arm");
        assert_eq!(find(&["./whichone-arm"], folder.path()).unwrap(), hosted);
    }
}
