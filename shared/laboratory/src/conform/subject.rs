//! The process under test, as its supervisor sees it: notifications, signals, exit.

use std::fs::File;
use std::io::{self, ErrorKind};
use std::os::unix::net::UnixDatagram;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process_group};
use service::exit::{Exit, Failure, ProcessExit};
use service::program::find_program;
use service::{group, launch};

use super::bench::{Bench, EPOCH};

/// Maximum time between two heartbeats, as given to the service: the group's default.
pub(super) const WATCHDOG: Duration = Duration::from_secs(3);
/// Interval at which it is looked at.
const LOOK_EVERY: Duration = Duration::from_millis(5);
/// Largest datagram.
const DATAGRAM_BYTES_MAX: usize = 4096;

/// One start of the service.
pub(super) struct Subject {
    child: Child,
    socket: UnixDatagram,
    path: PathBuf,
    pub(super) incarnation: u32,
    started: Instant,
    /// Time from the start to readiness.
    pub(super) ready: Option<Duration>,
    /// When it has beaten since it is ready.
    pub(super) beats: Vec<Instant>,
    exit: Option<ExitStatus>,
}

impl Subject {
    /// Starts the command as this incarnation of the service.
    pub(super) fn start(
        bench: &Bench,
        command: &[String],
        incarnation: u32,
    ) -> Result<Self, Failure> {
        let path = bench.paths.notify_socket(bench.service.name(), incarnation);
        let failed = |error: io::Error| Failure::file(&path, &error);
        let socket = UnixDatagram::bind(&path).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        let log = bench.log_file();
        let open = File::options().create(true).append(true).open(&log);
        let open = open.map_err(|error| Failure::file(&log, &error))?;
        let log = open.try_clone().map_err(|error| Failure::file(&log, &error))?;
        let program = find_program(command, Path::new("."))
            .map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
        let child = launch::command(program)
            .args(&command[1..])
            .env(group::ENV_GROUP, bench.paths.name().as_str())
            .env(group::ENV_HOME, bench.paths.home())
            .env(group::ENV_SERVICE, bench.service.name())
            .env(group::ENV_INCARNATION, incarnation.to_string())
            .env(group::ENV_EPOCH, EPOCH.0.to_string())
            .env(group::ENV_LIFELINE_FD, bench.lifeline().to_string())
            .env("NOTIFY_SOCKET", &path)
            .env("WATCHDOG_USEC", WATCHDOG.as_micros().to_string())
            .env_remove("WATCHDOG_PID")
            .stdin(Stdio::null())
            .stdout(open)
            .stderr(log)
            .process_group(0)
            .spawn()
            .map_err(|error| Failure::new(Exit::Usage, format!("{}: {error}", command[0])))?;
        let started = Instant::now();
        let (ready, beats, exit) = (None, Vec::new(), None);
        Ok(Self { child, socket, path, incarnation, started, ready, beats, exit })
    }

    /// Reads its notifications, and looks whether it has ended.
    pub(super) fn look(&mut self) {
        let mut bytes = [0; DATAGRAM_BYTES_MAX];
        loop {
            match self.socket.recv(&mut bytes) {
                Ok(read) => self.hear(&String::from_utf8_lossy(&bytes[..read])),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
        if self.exit.is_none() {
            self.exit = self.child.try_wait().ok().flatten();
        }
    }

    fn hear(&mut self, datagram: &str) {
        for line in datagram.lines() {
            match line {
                "READY=1" if self.ready.is_none() => self.ready = Some(self.started.elapsed()),
                "WATCHDOG=1" if self.ready.is_some() => self.beats.push(Instant::now()),
                _ => {}
            }
        }
    }

    /// Waits until `fact` is true. Returns whether that was within `patience` and before its end.
    pub(super) fn wait(
        &mut self,
        patience: Duration,
        mut fact: impl FnMut(&mut Self) -> bool,
    ) -> bool {
        let until = Instant::now() + patience;
        loop {
            self.look();
            if fact(self) {
                return true;
            }
            if self.exit.is_some() || Instant::now() >= until {
                return false;
            }
            std::thread::sleep(LOOK_EVERY);
        }
    }

    /// Returns how it has ended, if it has.
    pub(super) fn exit(&mut self) -> Option<ProcessExit> {
        self.look();
        let status = self.exit?;
        Some(match (status.code(), status.signal()) {
            (Some(code), _) => ProcessExit::Code(code),
            (None, signal) => ProcessExit::Signal(signal.unwrap_or_default()),
        })
    }

    /// Waits for the process's end.
    pub(super) fn await_exit(&mut self, patience: Duration) -> Option<ProcessExit> {
        let until = Instant::now() + patience;
        loop {
            if let Some(exit) = self.exit() {
                return Some(exit);
            }
            if Instant::now() >= until {
                return None;
            }
            std::thread::sleep(LOOK_EVERY);
        }
    }

    /// Asks the process to end.
    pub(super) fn terminate(&self) {
        self.signal(Signal::TERM);
    }

    /// Kills it with whatever it has started, and reaps it.
    pub(super) fn kill(&mut self) {
        self.signal(Signal::KILL);
        if self.exit.is_none() {
            self.exit = self.child.wait().ok();
        }
    }

    fn signal(&self, signal: Signal) {
        // Reaped: its number may be another process's by now.
        if self.exit.is_none() {
            let _ = kill_process_group(Pid::from_child(&self.child), signal);
        }
    }
}

impl Drop for Subject {
    fn drop(&mut self) {
        self.kill();
        let _ = std::fs::remove_file(&self.path);
    }
}
