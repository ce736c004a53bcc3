//! A process group for one test: its own name, home and shared memory.

use crate::command::{Ended, program, run};
use crate::{BUSY, wait_for, wait_for_or_none};
use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use service::group::{ENV_GROUP, ENV_HOME, GroupName, GroupPaths};
use std::collections::HashSet;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::mpsc;

/// Timeout of a call of the command line, seconds.
const CALL_S: f64 = 120.0;
/// Timeout of the end of groups, seconds.
const DOWN_S: f64 = 10.0;
/// Timeout of a pick, seconds: on a busy machine the arm of a physics engine may have to halt and begin again.
const PICK_S: f64 = 180.0;

/// The setting of a group to which a test speaks. Groups for which a test sets nothing of speech have no recogniser: to
/// load its model takes most of the processor time of a start.
pub const EARS: &str = "speech.recogniser=auto";

static NUMBER: AtomicU32 = AtomicU32::new(0);

/// A running group. Dropping it stops it; [`Group::down`] also checks that nothing is left.
#[derive(Debug)]
pub struct Group {
    home: tempfile::TempDir,
    paths: GroupPaths,
    config: PathBuf,
    is_up: bool,
}

/// The repository's own configuration.
fn shipped_config() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../config")
}

impl Group {
    /// Creates a group on the shipped configuration, without starting it.
    pub fn new() -> Self {
        Self::with_config(shipped_config())
    }

    /// Creates a group on its own configuration, without starting it.
    pub fn with_config(config: PathBuf) -> Self {
        Self::at(tempfile::Builder::new().prefix("wo").tempdir(), config)
    }

    /// Creates a group with the journals of a folder below `tests/fixtures/groups`, which know it by the name `old`.
    pub fn with_journals_of(folder: &str) -> Self {
        let home = tempfile::Builder::new().prefix("wo").tempdir();
        let group = Self::named("old", home, shipped_config());
        let fixture = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/groups").join(folder);
        let root = group.paths.root();
        let copied = Command::new("cp").arg("-r").arg(fixture.join(".")).arg(root).status();
        assert!(copied.is_ok_and(|status| status.success()), "{}", fixture.display());
        group
    }

    fn at(home: std::io::Result<tempfile::TempDir>, config: PathBuf) -> Self {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        Self::named(&format!("{}{number}", name_prefix(std::process::id())), home, config)
    }

    fn named(name: &str, home: std::io::Result<tempfile::TempDir>, config: PathBuf) -> Self {
        let home = home.expect("a temporary folder");
        let name = GroupName::new(name).expect("an allowed name");
        let paths = GroupPaths::in_home(home.path(), &name).expect("a short path");
        Self { home, paths, config, is_up: false }
    }

    /// Starts a group with the profile for tests and these overrides (`key=value`) until it is ready.
    pub fn up(settings: &[&str]) -> Self {
        Self::new().started(settings)
    }

    /// As [`Group::up`], with its home on a memory file system, where a sync costs nothing.
    pub fn up_in_memory(settings: &[&str]) -> Self {
        let home = tempfile::Builder::new().prefix("wo").tempdir_in("/dev/shm");
        Self::at(home, shipped_config()).started(settings)
    }

    fn started(mut self, settings: &[&str]) -> Self {
        let ended = self.start(settings);
        assert_eq!(ended.code, Some(0), "{ended:?}\n{}", self.logs());
        self
    }

    /// Starts the group with the profile for tests and waits until it is ready or rejected.
    pub fn start(&mut self, settings: &[&str]) -> Ended {
        let options: Vec<&str> = settings.iter().flat_map(|setting| ["--set", *setting]).collect();
        self.start_with(&options)
    }

    /// As [`Group::start`], in a new epoch: journals of earlier runs are kept beside it.
    pub fn start_fresh(&mut self) -> Ended {
        self.start_with(&["--fresh"])
    }

    /// Starts a group again whose supervisor was killed.
    pub fn start_again(&self, settings: &[&str]) -> Ended {
        let options: Vec<&str> = settings.iter().flat_map(|setting| ["--set", *setting]).collect();
        self.launch(&options)
    }

    fn start_with(&mut self, options: &[&str]) -> Ended {
        let ended = self.launch(options);
        self.is_up = ended.code == Some(0);
        ended
    }

    fn launch(&self, options: &[&str]) -> Ended {
        let config = self.config.display().to_string();
        let mut words = vec!["up", "--detach", "--wait", "ready", "--timeout", "90", "--config"];
        words.extend([config.as_str(), "--profile", "ci"]);
        if !options.iter().any(|option| option.starts_with("speech.")) {
            words.extend(["--set", "speech.recogniser=none"]);
        }
        words.extend(options);
        self.call(&words)
    }

    /// Paths of the group.
    pub fn paths(&self) -> &GroupPaths {
        &self.paths
    }

    /// `whichone WORDS…` for this group.
    pub fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(program("whichone"));
        command.env(ENV_HOME, self.home.path()).env(ENV_GROUP, self.paths.name().as_str());
        command.args(words);
        command
    }

    /// Runs `whichone WORDS…` for this group to its end.
    pub fn call(&self, words: &[&str]) -> Ended {
        run(&mut self.command(words), "", CALL_S)
    }

    /// As [`Group::call`], for calls that must succeed.
    pub fn must(&self, words: &[&str]) -> Ended {
        let ended = self.call(words);
        assert_eq!(ended.code, Some(0), "whichone {words:?}: {ended:?}\n{}", self.logs());
        ended
    }

    /// Releases the motion stop, as soon as a release counts.
    pub fn release_stop(&self) {
        wait_for("the release", 20.0, || {
            let ended = self.call(&["resume-motion"]);
            let is_early = ended.stderr.contains("less than 2 s before");
            assert!(is_early || ended.code == Some(0), "{ended:?}\n{}", self.logs());
            (!is_early).then_some(())
        });
    }

    /// Submits a typed utterance.
    pub fn say(&self, text: &str) {
        self.must(&["say", text]);
    }

    /// Waits for the interaction's outcome; with `answer_as`, a user who wants that object answers
    /// meanwhile.
    pub fn await_pick(&self, answer_as: Option<&str>) -> Value {
        let timeout = PICK_S.to_string();
        let mut words = vec!["await", "pick", "--json", "--timeout", &timeout];
        words.extend(answer_as.iter().flat_map(|object| ["--answer-as", object]));
        run(&mut self.command(&words), "", PICK_S + CALL_S).json()
    }

    /// Asks for "the bowl" (or what `request` says) as a user who wants `object`, and returns the
    /// outcome.
    pub fn fetch(&self, request: &str, object: &str) -> Value {
        self.say(request);
        self.await_pick(Some(object))
    }

    /// As [`Group::fetch`], calling `then` once the arm has been ordered to pick.
    pub fn fetch_while(&self, request: &str, object: &str, then: impl FnOnce()) -> Value {
        std::thread::scope(|scope| {
            let mut user = None;
            let begin = || {
                self.say(request);
                user = Some(scope.spawn(|| self.await_pick(Some(object))));
            };
            self.follow_from("the decision to pick", 20.0, begin, decision("pick"));
            then();
            user.expect("it has begun").join().expect("the user gets an outcome")
        })
    }

    /// The arm's state, as `watch` shows it.
    pub fn arm(&self) -> Value {
        self.shown("arm")
    }

    /// The dialogue's state, as `watch` shows it.
    pub fn dialogue(&self) -> Value {
        self.shown("dialogue")
    }

    /// A part of the state, which `watch` lacks while its service is late.
    fn shown(&self, part: &str) -> Value {
        wait_for(part, 10.0, || {
            let mut state = self.must(&["watch", "--once", "--json"]).json();
            Some(state[part].take()).filter(|part| !part.is_null())
        })
    }

    /// Waits until the arm shows that it is stopped, or free: an order is confirmed a moment before.
    pub fn wait_shown(&self, stopped: bool) {
        let shown = || (self.arm()["stopped"] == stopped).then_some(());
        wait_for(&format!("stopped: {stopped}"), 20.0, shown);
    }

    /// Follows the group's state, as `watch` shows it, until `fact` returns a value, and returns it. One program
    /// follows: on a busy machine one that is started for each look would miss what is short.
    ///
    /// # Panics
    /// As [`wait_for`].
    pub fn follow<T>(&self, what: &str, seconds: f64, fact: impl Fn(&mut Value) -> Option<T>) -> T {
        self.follow_from(what, seconds, || {}, fact)
    }

    /// As [`Group::follow`], from before `begin` is called: it misses nothing that this causes, however soon it is
    /// over.
    ///
    /// # Panics
    /// As [`wait_for`].
    pub fn follow_from<T>(
        &self,
        what: &str,
        seconds: f64,
        begin: impl FnOnce(),
        fact: impl Fn(&mut Value) -> Option<T>,
    ) -> T {
        let mut watch = self.command(&["watch", "--json"]);
        let watch = watch.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
        let mut watch = watch.unwrap_or_else(|e| panic!("whichone watch: {e}"));
        let lines = BufReader::new(watch.stdout.take().expect("piped")).lines();
        let (sender, states) = mpsc::channel();
        let reader = std::thread::spawn(move || {
            let states = lines.map_while(Result::ok).map(|line| serde_json::from_str(&line));
            states.map_while(Result::ok).try_for_each(|state| sender.send(state)).is_ok()
        });
        let mut first = wait_for_or_none(seconds, || states.try_recv().ok());
        begin();
        let found = wait_for_or_none(seconds, || {
            first.take().into_iter().chain(states.try_iter()).find_map(|mut it| fact(&mut it))
        });
        watch.kill().expect("a child of ours");
        watch.wait().expect("a child of ours");
        drop(states);
        reader.join().expect("a reader of ours");
        found.unwrap_or_else(|| panic!("{what}: not within {BUSY} × {seconds} s\n{}", self.logs()))
    }

    /// Waits until the standing decision is `kind` (`ask`, `pick`, …) and returns the dialogue.
    pub fn wait_for_decision(&self, kind: &str) -> Value {
        self.follow(&format!("the decision to {kind}"), 20.0, decision(kind))
    }

    /// The operator's status.
    pub fn status(&self) -> Value {
        self.call(&["status", "--json"]).json()
    }

    /// The status of one service.
    pub fn service(&self, name: &str) -> Value {
        let status = self.status();
        let services = status["services"].as_array().unwrap_or_else(|| panic!("{status}"));
        let service = services.iter().find(|service| service["name"] == name);
        service.unwrap_or_else(|| panic!("no {name} in {status}")).clone()
    }

    /// The process of a service that is up.
    pub fn pid(&self, service: &str) -> Pid {
        wait_for(&format!("pid of {service}"), 10.0, || {
            let pid = self.service(service)["pid"].as_i64()?;
            Pid::from_raw(i32::try_from(pid).ok()?)
        })
    }

    /// Sends a signal to a service.
    pub fn signal(&self, service: &str, signal: Signal) {
        // A process that has just ended needs no signal.
        let _ = kill_process(self.pid(service), signal);
    }

    /// Waits until a service is ready in another incarnation than `before`.
    pub fn wait_for_restart(&self, service: &str, before: u64) {
        wait_for(&format!("restart of {service}"), 15.0, || {
            let now = self.service(service);
            let incarnation = now["incarnation"].as_u64()?;
            (incarnation > before && now["actual"] == "ready").then_some(())
        });
    }

    /// The number of a service's start.
    pub fn incarnation(&self, service: &str) -> u64 {
        self.service(service)["incarnation"].as_u64().expect("a service that was started")
    }

    /// Has something happen to the simulated robot, or to the objects on its table.
    pub fn drill(&self, words: &[&str]) {
        self.must(&[&["baxter"], words].concat());
    }

    /// Checks the journals as an operator would.
    pub fn verify_journals(&self) {
        self.must(&["journal", "--verify"]);
    }

    /// Waits until the log of a service, or of the supervisor, has these words, and returns it: lines are written
    /// in the background.
    ///
    /// # Panics
    /// As [`wait_for`].
    pub fn wait_for_log(&self, of: &str, words: &str) -> String {
        let log = || std::fs::read_to_string(self.paths.log_file(of)).unwrap_or_default();
        wait_for(&format!("{words:?} in the log of {of}"), 10.0, || {
            Some(log()).filter(|log| log.contains(words))
        })
    }

    /// Returns the ends of the logs, for a failed test.
    pub fn logs(&self) -> String {
        let Ok(entries) = std::fs::read_dir(self.paths.log()) else { return String::new() };
        let files = entries.filter_map(Result::ok).map(|entry| entry.path());
        let tail = |path: PathBuf| {
            let text = std::fs::read_to_string(&path).unwrap_or_default();
            let lines: Vec<&str> = text.lines().collect();
            let end = lines[lines.len().saturating_sub(25)..].join("\n");
            format!("--- {}\n{end}\n", path.display())
        };
        files.filter(|path| path.is_file()).map(tail).collect()
    }

    /// Stops the group and checks that it leaves no process, no shared memory, no socket.
    pub fn down(mut self) {
        self.must(&["down"]);
        self.is_up = false;
        assert!(!self.paths.run().exists(), "run/ is left: {:?}", self.paths.run());
        let left = service::shm_cleanup::leftovers(&self.paths);
        assert!(left.is_empty(), "shared memory is left: {left:?}");
        let processes = self.processes();
        assert!(processes.is_empty(), "processes are left: {processes:?}");
    }

    /// Command lines of this group's processes.
    pub fn processes(&self) -> Vec<String> {
        let named = |pid: Pid| {
            let line = std::fs::read(format!("/proc/{}/cmdline", pid.as_raw_nonzero()));
            String::from_utf8_lossy(&line.unwrap_or_default()).replace('\0', " ")
        };
        self.pids().into_iter().map(named).filter(|line| !line.is_empty()).collect()
    }

    /// Processes of this group: those with its home in their environment.
    fn pids(&self) -> Vec<Pid> {
        let mark = format!("{ENV_HOME}={}", self.home.path().display());
        pids_with(|entry| entry == mark.as_bytes())
    }

    /// Processes of all groups that a process has started.
    pub fn pids_started_by(process: u32) -> Vec<Pid> {
        let mark = format!("{ENV_GROUP}={}", name_prefix(process));
        pids_with(|entry| entry.starts_with(mark.as_bytes()))
    }

    /// Ends the processes of every group that this process has started, and those that they start meanwhile.
    pub(crate) fn end_all() {
        let pids = || Self::pids_started_by(std::process::id());
        let end = |signal| {
            let mut signalled = HashSet::new();
            wait_for_or_none(DOWN_S, || {
                let pids = pids();
                let new = pids.iter().filter(|pid| signalled.insert(**pid));
                new.for_each(|pid| _ = kill_process(*pid, signal));
                pids.is_empty().then_some(())
            })
        };
        let _ = end(Signal::TERM).or_else(|| end(Signal::KILL));
    }
}

/// The dialogue, where the standing decision is of that kind.
fn decision(kind: &str) -> impl Fn(&mut Value) -> Option<Value> {
    move |state| Some(state["dialogue"].take()).filter(|dialogue| dialogue["decision"] == kind)
}

/// What the names of a process's groups begin with.
fn name_prefix(process: u32) -> String {
    format!("t{process}-")
}

/// Processes that have such an entry in their environment.
fn pids_with(is_of_group: impl Fn(&[u8]) -> bool) -> Vec<Pid> {
    let Ok(entries) = std::fs::read_dir("/proc") else { return Vec::new() };
    let has_entry = |pid: &Pid| {
        let path = format!("/proc/{}/environ", pid.as_raw_nonzero());
        std::fs::read(path).unwrap_or_default().split(|&b| b == 0).any(&is_of_group)
    };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let pids = names.filter_map(|name| Pid::from_raw(name.parse().ok()?));
    pids.filter(has_entry).collect()
}

impl Default for Group {
    fn default() -> Self {
        Self::new()
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        if self.is_up {
            let _ = self.command(&["down"]).output();
            // A group that did not stop would start its services again and again without its folder.
            for pid in self.pids() {
                let _ = kill_process(pid, Signal::KILL);
            }
        }
    }
}
