//! A group of real processes in a home folder of its own, gone when the test ends.

#![expect(clippy::unwrap_used, clippy::print_stderr, reason = "it is part of every test")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value, json};
use service::control::{CallError, Refusal, Reply, Request, call};
use service::group::{GroupName, GroupPaths};
use service::status::Actual;
use service::status::{GroupStatus, ServiceStatus};
use tempfile::TempDir;

/// Only to fail: every wait ends as soon as what it waits for is so.
pub(crate) const PATIENCE: Duration = Duration::from_secs(30);

/// A wait as requests carry it.
pub(crate) const WAIT_MS: u64 = 30_000;

/// A home folder with the description of one group, and its supervisor while that runs.
pub(crate) struct Group {
    home: TempDir,
    pub(crate) paths: GroupPaths,
    supervisor: Option<Child>,
    /// Supervisors before it, which end by themselves and still have to be reaped.
    earlier: Vec<Child>,
}

/// The description of one service whose fixture is called with these words.
pub(crate) fn service(name: &str, words: &[&str]) -> Value {
    let mut command = vec![fixture("fixture_service").display().to_string()];
    command.extend(words.iter().map(|&word| word.to_owned()));
    json!({ "name": name, "command": command })
}

/// `value` with one more field.
pub(crate) fn with(mut value: Value, key: &str, field: Value) -> Value {
    value[key] = field;
    value
}

/// A program of this package's `examples`, which a test build always makes.
pub(crate) fn fixture(name: &str) -> PathBuf {
    let own = std::env::current_exe().unwrap();
    own.parent().and_then(Path::parent).unwrap().join("examples").join(name)
}

/// Waits until `get` has something, and fails with what it was waiting for.
#[track_caller]
pub(crate) fn wait_for<T>(what: &str, mut get: impl FnMut() -> Option<T>) -> T {
    let until = Instant::now() + PATIENCE;
    loop {
        if let Some(found) = get() {
            return found;
        }
        assert!(Instant::now() < until, "waited in vain for: {what}");
        thread::sleep(Duration::from_millis(5));
    }
}

/// Returns true if a process with this number exists and has not ended.
pub(crate) fn is_alive(pid: u32) -> bool {
    let Ok(stat) = fs::read_to_string(format!("/proc/{pid}/stat")) else { return false };
    let state = stat.rsplit_once(") ").map(|(_, rest)| rest.chars().next());
    !matches!(state, Some(Some('Z' | 'X')))
}

pub(crate) fn send(pid: u32, signal: Signal) {
    kill_process(Pid::from_raw(pid.cast_signed()).unwrap(), signal).unwrap();
}

impl Group {
    /// A group of these services that has been started, and nothing more.
    pub(crate) fn start(services: Vec<Value>) -> Self {
        Self::start_with(json!({ "services": services }))
    }

    /// A group of this description that has been started, and nothing more.
    pub(crate) fn start_with(description: Value) -> Self {
        let home = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let name = GroupName::new("lab").unwrap();
        let paths = GroupPaths::in_home(home.path(), &name).unwrap();
        let mut group = Self { home, paths, supervisor: None, earlier: Vec::new() };
        group.describe(&description);
        group.run();
        group
    }

    /// The same, with every service ready.
    pub(crate) fn ready(services: Vec<Value>) -> Self {
        let group = Self::start(services);
        group.done(&Request::WaitReady { wait_ms: WAIT_MS });
        group
    }

    /// Replaces the description.
    pub(crate) fn describe(&self, description: &Value) {
        fs::write(self.home.path().join("group.json"), description.to_string()).unwrap();
    }

    /// Starts a supervisor for the group and waits until it listens.
    pub(crate) fn run(&mut self) {
        let command = self.command();
        self.run_as(command);
    }

    /// Starts this supervisor for the group, which has been stopped, and waits until it listens. A group that cannot
    /// live may be down before it is asked.
    pub(crate) fn run_as(&mut self, mut command: Command) {
        let supervisor = command.spawn().unwrap();
        let pid = supervisor.id();
        self.earlier.extend(self.supervisor.replace(supervisor));
        wait_for("the supervisor to listen", || {
            (self.call(&Request::Ping).is_ok() || !is_alive(pid)).then_some(())
        });
    }

    /// The command that starts a supervisor for the group.
    pub(crate) fn command(&self) -> Command {
        let log = self.home.path().join("supervisor.log");
        let log = fs::OpenOptions::new().append(true).create(true).open(log).unwrap();
        let mut command = Command::new(fixture("fixture_group"));
        command
            .arg("lab")
            .arg(self.home.path().join("group.json"))
            .env("WHICHONE_HOME", self.home.path())
            .env("WHICHONE_LOG", "debug")
            .env_remove("NOTIFY_SOCKET")
            .stdin(Stdio::null())
            .stderr(log);
        command
    }

    pub(crate) fn supervisor_pid(&self) -> u32 {
        self.supervisor.as_ref().unwrap().id()
    }

    /// The supervisor's own log.
    /// Waits until the supervisor has logged a text: it does so a moment after what others see.
    pub(crate) fn wait_for_log(&self, text: &str) {
        wait_for(text, || self.log().contains(text).then_some(()));
    }

    pub(crate) fn log(&self) -> String {
        fs::read_to_string(self.home.path().join("supervisor.log")).unwrap_or_default()
    }

    pub(crate) fn call(&self, request: &Request) -> Result<Reply, CallError> {
        call(&self.paths.control_socket(), request, PATIENCE + PATIENCE)
    }

    #[track_caller]
    pub(crate) fn ask(&self, request: &Request) -> Reply {
        self.call(request).unwrap_or_else(|e| panic!("{request:?}: {e}:\n{}", self.log()))
    }

    #[track_caller]
    pub(crate) fn done(&self, request: &Request) -> String {
        match self.ask(request) {
            Reply::Done { message } => message,
            other => panic!("{request:?}: {other:?}"),
        }
    }

    #[track_caller]
    pub(crate) fn refused(&self, request: &Request) -> Refusal {
        match self.call(request) {
            Err(CallError::Refused(refusal)) => refusal,
            other => panic!("{request:?}: {other:?}"),
        }
    }

    #[track_caller]
    pub(crate) fn status(&self) -> GroupStatus {
        match self.ask(&Request::Status) {
            Reply::Status(status) => *status,
            other => panic!("{other:?}"),
        }
    }

    #[track_caller]
    pub(crate) fn service(&self, name: &str) -> ServiceStatus {
        let found = self.status().services.into_iter().find(|service| service.name == name);
        found.unwrap_or_else(|| panic!("no service {name}"))
    }

    #[track_caller]
    pub(crate) fn pid(&self, name: &str) -> u32 {
        self.service(name).pid.unwrap_or_else(|| panic!("{name} does not run"))
    }

    /// Waits until the service does this.
    #[track_caller]
    pub(crate) fn until(&self, name: &str, actual: Actual) -> ServiceStatus {
        wait_for(&format!("{name} to be {actual:?}"), || {
            Some(self.service(name)).filter(|service| service.actual == actual)
        })
    }

    /// Waits until the service is ready in this incarnation.
    #[track_caller]
    pub(crate) fn until_ready(&self, name: &str, incarnation: u32) -> ServiceStatus {
        wait_for(&format!("{name} to be ready as incarnation {incarnation}"), || {
            Some(self.service(name)).filter(|service| {
                service.actual == Actual::Ready && service.incarnation == incarnation
            })
        })
    }

    /// Returns the lines that the services recorded.
    pub(crate) fn events(&self) -> Vec<String> {
        let text = fs::read_to_string(self.paths.root().join("events")).unwrap_or_default();
        text.lines().map(str::to_owned).collect()
    }

    /// Number of the process that a service says it has left behind.
    #[track_caller]
    pub(crate) fn left_behind(&self) -> u32 {
        wait_for("a service to leave a process behind", || {
            let events = self.events();
            events.iter().find_map(|event| event.split_once("left ")?.1.parse().ok())
        })
    }

    /// Waits for the supervisor's own end.
    #[track_caller]
    pub(crate) fn wait_end(&mut self) -> ExitStatus {
        let mut supervisor = self.supervisor.take().unwrap();
        wait_for("the supervisor to end", || supervisor.try_wait().unwrap())
    }

    /// Checks that a group that is down leaves no processes, files or shared memory.
    #[track_caller]
    pub(crate) fn check_nothing_left(&self) {
        assert!(!self.paths.run().exists(), "run folder");
        let shared = service::shm_cleanup::leftovers(&self.paths);
        assert!(shared.is_empty(), "shared memory: {shared:?}");
        let processes = self.processes();
        assert!(processes.is_empty(), "processes: {processes:?}");
    }

    /// Processes that were started for this group and have not ended.
    pub(crate) fn processes(&self) -> Vec<u32> {
        let home = format!("WHICHONE_HOME={}", self.home.path().display());
        let is_ours = |pid: &u32| {
            let environment = fs::read(format!("/proc/{pid}/environ")).unwrap_or_default();
            environment.split(|&byte| byte == 0).any(|variable| variable == home.as_bytes())
        };
        let entries = fs::read_dir("/proc").unwrap().flatten();
        let pids = entries.filter_map(|entry| entry.file_name().to_str()?.parse().ok());
        pids.filter(is_ours).filter(|&pid| is_alive(pid)).collect()
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        for supervisor in self.earlier.iter_mut().chain(&mut self.supervisor) {
            let _ = supervisor.kill();
            let _ = supervisor.wait();
        }
        for pid in self.processes() {
            let _ = kill_process(Pid::from_raw(pid.cast_signed()).unwrap(), Signal::KILL);
        }
        service::shm_cleanup::remove_leftovers(&self.paths);
        if thread::panicking() {
            eprintln!("--- supervisor\n{}", self.log());
        }
    }
}
