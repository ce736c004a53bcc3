//! Check that a previous supervisor of the group and all its processes have ended.

use std::fs::File;
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use rustix::process::{Pid, PidfdFlags, Signal, getpid, pidfd_open, pidfd_send_signal};
use service::control::{Request, call};
use service::group::{ENV_GROUP, ENV_HOME, ENV_INCARNATION, GroupPaths};
use thiserror::Error;

use crate::lifeline::is_free;
use crate::procfs::{self, Process};

/// Timeout for the end of killed processes.
const KILL_PATIENCE: Duration = Duration::from_secs(5);

/// Timeout for the end of a supervisor that was killed: the kernel releases what it held only
/// some time after the signal. It is also how long one that is stopped may take to answer.
const RELEASE_PATIENCE: Duration = Duration::from_secs(3);

/// Polling interval.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Failure to take over the group.
#[derive(Debug, Error)]
pub enum PreviousRunError {
    /// Another supervisor is running the group of this name; its process, if it has written it down
    /// yet.
    #[error("group {} is already running{}", .0, with_pid(.1))]
    Running(String, Option<u32>),
    /// Processes of a previous run survive SIGKILL.
    #[error("processes of a previous run of the group do not end: {}", .0.join(", "))]
    Undying(Vec<String>),
    /// A lock file cannot be used.
    #[error("{}: {}", .0.display(), .1)]
    Io(PathBuf, io::Error),
}

fn with_pid(pid: &Option<u32>) -> String {
    pid.map(|pid| format!(" (supervisor {pid})")).unwrap_or_default()
}

/// Locks the group for this process, for as long as the file is kept open.
pub(crate) fn take_group(paths: &GroupPaths) -> Result<File, PreviousRunError> {
    let path = paths.supervisor_lock();
    let failed = |error| PreviousRunError::Io(path.clone(), error);
    let mut file = safe_files::open_lock(&path).map_err(failed)?;
    let until = Instant::now() + RELEASE_PATIENCE;
    loop {
        match flock(&file, FlockOperation::NonBlockingLockExclusive) {
            Err(Errno::WOULDBLOCK) if Instant::now() < until && !answers(paths) => {
                thread::sleep(LOOK_EVERY);
            }
            Err(Errno::WOULDBLOCK) => {
                let mut text = String::new();
                let read = file.read_to_string(&mut text);
                let pid = read.ok().and_then(|_| text.trim().parse().ok());
                return Err(PreviousRunError::Running(paths.name().to_string(), pid));
            }
            taken => {
                taken.map_err(|error| failed(error.into()))?;
                break;
            }
        }
    }
    let write = |file: &mut File| -> io::Result<()> {
        file.set_len(0)?;
        file.rewind()?;
        writeln!(file, "{}", std::process::id())
    };
    write(&mut file).map_err(failed)?;
    Ok(file)
}

/// Returns true if a supervisor of the group answers: it is alive, and holds the lock for good.
fn answers(paths: &GroupPaths) -> bool {
    call(&paths.control_socket(), &Request::Ping, RELEASE_PATIENCE).is_ok()
}

/// Waits until every process of an earlier supervisor has ended, and kills those that take longer
/// than `patience`. Returns the lock that the services of this one are to share.
pub(crate) fn await_end(paths: &GroupPaths, patience: Duration) -> Result<File, PreviousRunError> {
    let path = paths.alive_lock();
    let failed = |error| PreviousRunError::Io(path.clone(), error);
    let alive = safe_files::open_lock(&path).map_err(failed)?;
    if is_free(&alive) {
        return Ok(alive);
    }
    tracing::warn!(left = ?names(&leftovers(paths)), "waiting for services of a previous run");
    if wait(&alive, patience) {
        return Ok(alive);
    }
    let left = leftovers(paths);
    tracing::warn!(left = ?names(&left), "killing services of a previous run");
    left.iter().for_each(|process| kill(process.pid, paths));
    if wait(&alive, KILL_PATIENCE) {
        return Ok(alive);
    }
    Err(PreviousRunError::Undying(names(&leftovers(paths))))
}

fn wait(alive: &File, patience: Duration) -> bool {
    let until = Instant::now() + patience;
    while Instant::now() < until {
        if is_free(alive) {
            return true;
        }
        thread::sleep(LOOK_EVERY);
    }
    false
}

/// Processes that belong to a group's services.
fn leftovers(paths: &GroupPaths) -> Vec<Process> {
    let lock = paths.alive_lock();
    let lock = lock.canonicalize().unwrap_or(lock);
    let all = procfs::processes().into_iter();
    all.filter(|process| process.pid != getpid() && is_of(process.pid, paths, &lock)).collect()
}

/// A process belongs to the group if a supervisor gave it the environment that says so, or if it
/// holds the lock that only services inherit: it may have lost one of them, hardly both.
fn is_of(pid: Pid, paths: &GroupPaths, lock: &Path) -> bool {
    let environment = procfs::environment(pid);
    let is = |key, value: &std::ffi::OsStr| environment.get(key) == Some(value);
    let marked = environment.get(ENV_INCARNATION).is_some()
        && is(ENV_GROUP, paths.name().as_str().as_ref())
        && is(ENV_HOME, paths.home().as_os_str());
    marked || procfs::has_open(pid, lock)
}

/// Kills a process of the group. It is checked again once its descriptor is open, so that a reused
/// pid is never hit.
fn kill(pid: Pid, paths: &GroupPaths) {
    let Ok(pidfd) = pidfd_open(pid, PidfdFlags::empty()) else { return };
    let lock = paths.alive_lock();
    if is_of(pid, paths, &lock.canonicalize().unwrap_or(lock)) {
        // It may have ended meanwhile.
        let _ = pidfd_send_signal(&pidfd, Signal::KILL);
    }
}

fn names(processes: &[Process]) -> Vec<String> {
    processes.iter().map(|process| format!("{} ({})", process.name, process.pid)).collect()
}

#[cfg(test)]
mod tests {
    use service::group::GroupName;

    use super::*;

    #[test]
    fn group_lock_is_exclusive() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        std::fs::create_dir_all(paths.root()).unwrap();
        let first = take_group(&paths).unwrap();
        let error = take_group(&paths).unwrap_err().to_string();
        let me = std::process::id();
        assert_eq!(error, format!("group lab is already running (supervisor {me})"));
        drop(first);
        take_group(&paths).unwrap();
    }
}
