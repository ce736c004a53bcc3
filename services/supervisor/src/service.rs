//! One service under the supervisor: its successive processes and their notifications.

use std::ffi::OsString;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Duration;

use service::group::{self, GroupPaths};

use crate::Time;
use crate::child::Child;
use crate::configuration::{Log, ServiceSpec};
use crate::lifeline::Lifeline;
use crate::machine::{Effect, Event, Failure};
use crate::notify::{Notification, NotifySocket};
use crate::spawn::{self, SpawnError};
use service::exit::ProcessExit;
use service::log_file;

/// Resources that a service may be short of, as it names them; their figures are added.
pub(crate) const STORAGE: &str = "disk";
pub(crate) const SHARED_MEMORY: &str = "shared memory";

/// A service, whether or not a process of it runs.
#[derive(Debug)]
pub(crate) struct Service {
    pub(crate) spec: ServiceSpec,
    /// A command that replaces the configured one.
    pub(crate) swapped: Option<Command>,
    pub(crate) running: Option<Running>,
    pub(crate) ended: Option<Ended>,
    /// Offset in its log at which the last incarnation began.
    pub(crate) log_from: u64,
}

/// A command and its working folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Command {
    pub(crate) words: Vec<String>,
    pub(crate) directory: PathBuf,
}

/// One incarnation that has a process.
#[derive(Debug)]
pub(crate) struct Running {
    pub(crate) child: Child,
    pub(crate) notify: NotifySocket,
    pub(crate) incarnation: u32,
    pub(crate) since: Time,
    pub(crate) beat: Option<Time>,
    pub(crate) input: Option<(Duration, Time)>,
    pub(crate) version: Option<String>,
    pub(crate) says: Option<String>,
    /// The resource that it says it is short of.
    pub(crate) shortage: Option<String>,
    pub(crate) rejected: u64,
    pub(crate) lost: u64,
    /// Syncs of its journal, and the time that they took.
    pub(crate) syncs: (u64, Duration),
    pub(crate) killed: bool,
}

/// End of the previous incarnation.
#[derive(Clone, Debug)]
pub(crate) struct Ended {
    pub(crate) incarnation: u32,
    pub(crate) exit: ProcessExit,
    pub(crate) failure: Option<Failure>,
    pub(crate) killed: bool,
    pub(crate) at: Time,
    /// Error of the operating system if it could not be started.
    pub(crate) error: Option<String>,
    /// The resource that it was short of, where that was said.
    pub(crate) shortage: Option<String>,
}

/// Environment shared by all services of a group.
#[derive(Debug)]
pub(crate) struct Surroundings {
    pub(crate) paths: GroupPaths,
    pub(crate) lifeline: Lifeline,
    pub(crate) epoch: u64,
    pub(crate) log: Log,
    /// The working folder of configured commands.
    pub(crate) directory: PathBuf,
}

impl Service {
    pub(crate) fn new(spec: ServiceSpec) -> Self {
        Self { spec, swapped: None, running: None, ended: None, log_from: 0 }
    }

    /// Returns true if its program is the one that is shipped.
    pub(crate) fn is_shipped(&self) -> bool {
        self.spec.is_shipped && self.swapped.is_none()
    }

    /// Starts incarnation `incarnation`.
    pub(crate) fn spawn(
        &mut self,
        incarnation: u32,
        around: &Surroundings,
        now: Time,
    ) -> Result<(), ProcessExit> {
        assert!(self.running.is_none(), "{} runs already", self.spec.name);
        match self.try_spawn(incarnation, around, now) {
            Ok(running) => {
                let (service, pid) = (&self.spec.name, running.child.pid());
                tracing::info!(service, incarnation, %pid, "started");
                self.running = Some(running);
                Ok(())
            }
            Err(error) => {
                let exit = error.as_exit();
                let error = error.to_string();
                tracing::error!(service = self.spec.name, incarnation, error, "not started");
                let ended = Ended {
                    incarnation,
                    exit,
                    failure: None,
                    killed: false,
                    at: now,
                    error: Some(error),
                    shortage: None,
                };
                self.ended = Some(ended);
                Err(exit)
            }
        }
    }

    fn try_spawn(
        &mut self,
        incarnation: u32,
        around: &Surroundings,
        now: Time,
    ) -> Result<Running, SpawnError> {
        let path = around.paths.log_file(&self.spec.name);
        let socket = around.paths.notify_socket(&self.spec.name, incarnation);
        let log = self.open_log(&path, &around.log)?;
        self.log_from = log_file::size(&path);
        let notify =
            NotifySocket::bind(&socket).map_err(|error| SpawnError::Io(socket.clone(), error))?;
        let (words, directory) = match &self.swapped {
            Some(command) => (&command.words, &command.directory),
            None => (&self.spec.command, &around.directory),
        };
        let environment = self.environment(incarnation, around);
        let nice = self.spec.nice;
        let child = spawn::spawn(words, directory, environment, log, nice, &around.lifeline)?;
        Ok(Running {
            child,
            notify,
            incarnation,
            since: now,
            beat: None,
            input: None,
            version: None,
            says: None,
            shortage: None,
            rejected: 0,
            lost: 0,
            syncs: (0, Duration::ZERO),
            killed: false,
        })
    }

    /// A service without a log is better than none.
    fn open_log(&self, path: &Path, limits: &Log) -> Result<File, SpawnError> {
        log_file::open(path, limits).or_else(|error| {
            tracing::error!(service = self.spec.name, %error, "it runs without a log");
            let nowhere = Path::new("/dev/null");
            let opened = File::options().append(true).open(nowhere);
            opened.map_err(|error| SpawnError::Io(nowhere.to_owned(), error))
        })
    }

    fn environment(
        &self,
        incarnation: u32,
        around: &Surroundings,
    ) -> Vec<(&'static str, OsString)> {
        let Surroundings { paths, .. } = around;
        let socket = paths.notify_socket(&self.spec.name, incarnation);
        let mut environment: Vec<(&str, OsString)> = vec![
            (group::ENV_GROUP, paths.name().as_str().into()),
            (group::ENV_HOME, paths.home().into()),
            (group::ENV_SERVICE, (&self.spec.name).into()),
            (group::ENV_INCARNATION, incarnation.to_string().into()),
            (group::ENV_EPOCH, around.epoch.to_string().into()),
            (group::ENV_LIFELINE_FD, around.lifeline.descriptor().to_string().into()),
            ("NOTIFY_SOCKET", socket.into()),
        ];
        if let Some(period) = self.spec.watchdog {
            environment.push(("WATCHDOG_USEC", period.as_micros().to_string().into()));
        }
        if std::env::var_os(group::ENV_LOG).is_none() {
            environment.push((group::ENV_LOG, (&around.log.level).into()));
        }
        if around.log.json && std::env::var_os(group::ENV_LOG_FORMAT).is_none() {
            environment.push((group::ENV_LOG_FORMAT, "json".into()));
        }
        environment
    }

    /// Carries out an effect upon the running process.
    pub(crate) fn signal(&mut self, effect: Effect) {
        let Some(running) = &mut self.running else { return };
        let (service, incarnation) = (&self.spec.name, running.incarnation);
        match effect {
            Effect::Kill => tracing::warn!(service, incarnation, "killed: it did not end"),
            Effect::Abort => tracing::warn!(service, incarnation, "aborted: it no longer beats"),
            Effect::Terminate => tracing::info!(service, incarnation, "asked to shut down"),
            Effect::Spawn => {}
        }
        running.killed |= effect == Effect::Kill;
        running.child.signal(effect);
    }

    /// Returns its notifications since the last call as events, and records the others.
    pub(crate) fn listen(&mut self, now: Time) -> Vec<Event> {
        let Some(running) = &mut self.running else { return Vec::new() };
        let mut events = Vec::new();
        for said in running.notify.drain() {
            match said {
                Notification::Ready => {
                    let (service, incarnation) = (&self.spec.name, running.incarnation);
                    let ms = (now - running.since).as_millis();
                    tracing::info!(service, incarnation, ms, "ready");
                    events.push(Event::Ready);
                }
                Notification::Beat => {
                    running.beat = Some(now);
                    events.push(Event::Beat);
                }
                Notification::Extend(by) => events.push(Event::Extend(by)),
                Notification::InputAge(age) => running.input = Some((age, now)),
                Notification::Version(version) => running.version = Some(version),
                Notification::Status(text) => running.says = Some(text),
                Notification::Rejected(count) => running.rejected = count,
                Notification::Lost(count) => running.lost = count,
                Notification::Syncs(count) => running.syncs.0 = count,
                Notification::SyncTime(time) => running.syncs.1 = time,
                Notification::Shortage(shortage) => {
                    if running.shortage != shortage {
                        let (service, incarnation) = (&self.spec.name, running.incarnation);
                        let what = shortage.as_deref().unwrap_or("nothing any more");
                        tracing::warn!(service, incarnation, "short of {what}");
                    }
                    events.push(Event::Short(shortage.is_some()));
                    running.shortage = shortage;
                }
            }
        }
        events
    }

    /// Returns true if a process of it has ended and waits to be reaped.
    pub(crate) fn has_ended(&self) -> bool {
        self.running.as_ref().is_some_and(|running| running.child.has_ended())
    }

    /// Reaps the ended process, with whatever is left of its group, and notes how it ended.
    pub(crate) fn reap(&mut self, failure: Option<Failure>, now: Time) -> Option<ProcessExit> {
        let Running { child, incarnation, killed, shortage, .. } = self.running.take()?;
        let exit = child.reap();
        let ended = Ended { incarnation, exit, failure, killed, at: now, error: None, shortage };
        let (service, text) = (&self.spec.name, ended.text());
        if exit.is_clean() && !killed && failure.is_none() {
            tracing::info!(service, incarnation, "ended: {text}");
        } else {
            tracing::warn!(service, incarnation, "ended: {text}");
        }
        self.ended = Some(ended);
        Some(exit)
    }

    /// The last lines of the last incarnation's log.
    pub(crate) fn log_tail(&self, paths: &GroupPaths) -> Vec<String> {
        log_file::tail(&paths.log_file(&self.spec.name), self.log_from)
    }

    /// Returns the resource that it is short of, or was at its end.
    pub(crate) fn shortage(&self) -> Option<&str> {
        if let Some(running) = &self.running {
            return running.shortage.as_deref();
        }
        let ended = self.ended.as_ref()?;
        let said = ended.shortage.as_deref().or(ended.error.as_deref());
        said.or(match ended.exit {
            ProcessExit::Signal(_) => Some(SHARED_MEMORY),
            _ => Some(STORAGE),
        })
    }

    /// Replaces the current command; `None` restores the configured one.
    pub(crate) fn replace_command(&mut self, command: Option<Command>) -> Option<Command> {
        std::mem::replace(&mut self.swapped, command)
    }
}

impl Running {
    /// Age of its oldest pending input: the reported age plus the time since.
    pub(crate) fn input_age(&self, now: Time) -> Option<Duration> {
        let (age, said) = self.input?;
        // Nothing waited, so nothing has aged.
        Some(if age.is_zero() { age } else { age + now.saturating_sub(said) })
    }
}

impl Ended {
    /// Summary of the exit.
    pub(crate) fn text(&self) -> String {
        let mut text = match &self.error {
            Some(error) => error.clone(),
            None => self.exit.to_string(),
        };
        match self.failure {
            Some(Failure::NotReady) => text.push_str(", was not ready in time"),
            Some(Failure::NoBeat) => text.push_str(", no longer beat"),
            None => {}
        }
        if self.killed {
            text.push_str(", had to be killed");
        }
        text
    }
}
