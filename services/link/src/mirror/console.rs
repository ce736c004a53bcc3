//! The console of a mirrored group: a child process that is started again when it ends.

use std::fs::OpenOptions;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use messages::{Epoch, Service};
use rustix::io::FdFlags;
use rustix::pipe::{PipeFlags, pipe_with};
use rustix::process::{Pid, Signal, kill_process};
use service::group::{self, GroupPaths};
use service::launch;
use std::os::fd::{AsRawFd, OwnedFd};

/// Pause before the console is started again.
const PAUSE: Duration = Duration::from_secs(2);
/// Time for its end, before it is killed.
const PATIENCE: Duration = Duration::from_secs(5);

/// The console's process.
pub(super) struct Console {
    paths: GroupPaths,
    epoch: Epoch,
    incarnation: u32,
    child: Option<Child>,
    started: Option<Instant>,
    /// The console reads as its end of file that this process is gone.
    lifeline: (OwnedFd, OwnedFd),
}

impl Console {
    pub(super) fn new(paths: &GroupPaths, epoch: Epoch) -> std::io::Result<Self> {
        let lifeline = pipe_with(PipeFlags::CLOEXEC)?;
        rustix::io::fcntl_setfd(&lifeline.0, FdFlags::empty())?;
        let paths = paths.clone();
        Ok(Self { paths, epoch, incarnation: 0, child: None, started: None, lifeline })
    }

    /// Starts the console if it does not run.
    pub(super) fn keep(&mut self) {
        if let Some(child) = &mut self.child {
            match child.try_wait() {
                Ok(None) => return,
                Ok(Some(status)) => {
                    tracing::warn!(%status, "the console has ended; starting it again")
                }
                Err(error) => tracing::warn!(%error, "the console's state is not known"),
            }
            self.child = None;
        }
        if self.started.is_some_and(|at| at.elapsed() < PAUSE) {
            return;
        }
        self.started = Some(Instant::now());
        self.incarnation += 1;
        match self.start() {
            Ok(child) => self.child = Some(child),
            Err(error) => tracing::warn!(%error, "the console does not start; trying again"),
        }
    }

    /// Returns the console's process, while there is one.
    pub(super) fn pid(&self) -> Option<u32> {
        self.child.as_ref().map(Child::id)
    }

    fn start(&self) -> std::io::Result<Child> {
        let log = self.paths.log_file(Service::Console.name());
        let log = OpenOptions::new().create(true).append(true).open(log)?;
        launch::command(launch::program_of(Service::Console.name()))
            .env(group::ENV_GROUP, self.paths.name().as_str())
            .env(group::ENV_HOME, self.paths.home())
            .env(group::ENV_SERVICE, Service::Console.name())
            .env(group::ENV_EPOCH, self.epoch.to_string())
            .env(group::ENV_INCARNATION, self.incarnation.to_string())
            .env(group::ENV_LIFELINE_FD, self.lifeline.0.as_raw_fd().to_string())
            .env_remove("NOTIFY_SOCKET")
            .env_remove("WATCHDOG_USEC")
            .stdin(Stdio::null())
            .stdout(log.try_clone()?)
            .stderr(log)
            .spawn()
    }
}

impl Drop for Console {
    fn drop(&mut self) {
        let Some(mut child) = self.child.take() else { return };
        // Not reaped yet: the number is still its own.
        let _ = kill_process(Pid::from_child(&child), Signal::TERM);
        let until = Instant::now() + PATIENCE;
        while Instant::now() < until {
            if !matches!(child.try_wait(), Ok(None)) {
                return;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = child.kill();
        let _ = child.wait();
    }
}
