//! Every way to stop the arm in every state of the group: a stop that was accepted is followed by a latch, and
//! nothing moves after "stopped" was shown or said.

#![allow(clippy::print_stdout, reason = "the pairs that were tried, for the log")]

use messages::MotionOrder;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::{Value as Json, json};
use service::stop_socket;
use service::{Span, Time, clock};
use std::io::{BufRead, BufReader, Write};
use std::process::Stdio;
use std::thread::{self, Scope, ScopedJoinHandle};
use std::time::{Duration, Instant};
use whichone_tests::console::Visitor;
use whichone_tests::motion_watch::MotionWatch;
use whichone_tests::shortage::{SmallDisk, SmallGroup};
use whichone_tests::{Group, program, run, wait_for};

/// Real time, so that there is a motion to be stopped; restarts that back off as on a robot.
const SETTINGS: [&str; 2] = ["arm.time_scale=1.0", "group.restart.backoff_max_ms=2000"];
/// Length of an outage after the stop was given, unless the way ends before.
const OUTAGE: Duration = Duration::from_millis(1_500);
/// Time in which nothing may move after a stop, seconds.
const REST_S: f64 = 1.0;

/// A way to give a stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    CommandLine,
    Words,
    Chat,
    Page,
    /// What the clients in Rust and C call.
    Socket,
    Python,
}

const WAYS: [Way; 6] =
    [Way::CommandLine, Way::Words, Way::Chat, Way::Page, Way::Socket, Way::Python];

/// State of the group while a stop is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum During {
    Nothing,
    ArmKilled,
    ArmRestarted,
    ArmHeld,
    ArmSwapped,
    ArmInBackoff,
    SupervisorKilled,
    /// A process does not run, and continues later.
    Suspended(&'static str),
    FullDisk,
    /// A second stop and a release come at the same time.
    Race,
}

const STATES: [During; 12] = [
    During::Nothing,
    During::ArmKilled,
    During::ArmRestarted,
    During::ArmHeld,
    During::ArmSwapped,
    During::ArmInBackoff,
    During::SupervisorKilled,
    During::Suspended("policy"),
    During::Suspended("speech"),
    During::Suspended("console"),
    During::FullDisk,
    During::Race,
];

/// What a way reported of its order.
#[derive(Clone, Debug)]
struct Report {
    /// The order was accepted: it must be carried out.
    is_accepted: bool,
    /// When the way reported that the arm is stopped.
    stopped: Option<Time>,
    text: String,
}

impl Way {
    fn give(self, group: &Group) -> Report {
        match self {
            Self::CommandLine => confirmed(&group.call(&["stop-motion"])),
            Self::Words => accepted(&group.call(&["say", "stop"])),
            Self::Chat => by_chat(group),
            Self::Page => by_page(group),
            Self::Socket => by_socket(group),
            Self::Python => by_python(group),
        }
    }

    /// Returns whether this machine has what the way needs.
    fn is_here(self) -> bool {
        self != Self::Python || std::env::var_os("WHICHONE_PYTHON").is_some()
    }
}

fn accepted(ended: &whichone_tests::Ended) -> Report {
    let text = format!("{}{}", ended.stdout, ended.stderr);
    Report { is_accepted: ended.code == Some(0), stopped: None, text }
}

fn confirmed(ended: &whichone_tests::Ended) -> Report {
    let report = accepted(ended);
    Report { stopped: report.is_accepted.then(clock::now), ..report }
}

/// A user at a terminal, who types "stop" and waits for the robot's report.
fn by_chat(group: &Group) -> Report {
    let mut command = group.command(&["chat"]);
    let mut chat = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let mut keys = chat.stdin.take().unwrap();
    keys.write_all(b"stop\n").unwrap();
    let mut lines = BufReader::new(chat.stdout.take().unwrap()).lines().map_while(Result::ok);
    let line = lines.find(|line| line.contains("I have stopped"));
    let stopped = line.is_some().then(clock::now);
    keys.write_all(b"quit\n").unwrap();
    let text = format!("{line:?}, {:?}", chat.wait());
    Report { is_accepted: stopped.is_some(), stopped, text }
}

/// A page repeats a stop over every connection until it is confirmed, as its scripts do.
fn by_page(group: &Group) -> Report {
    let until = Instant::now() + Duration::from_secs(60);
    loop {
        let mut page = group.page(&Visitor::operator(1));
        let id = page.begin("stop", &Json::Null);
        while page.closed.is_none() && Instant::now() < until {
            page.look();
            let answer = page.messages.iter().find(|message| message["id"] == id).cloned();
            let is_confirmed = |answer: &Json| answer["ok"] == true;
            if let Some(answer) = answer.filter(is_confirmed) {
                let text = answer.to_string();
                return Report { is_accepted: true, stopped: Some(clock::now()), text };
            }
            // A stop that is late stays with the console, which shows when it is confirmed.
            let arm = page.parts.get("arm").filter(|arm| arm["stopped"] == true);
            let motion = page.parts.get("motion").filter(|motion| motion["unconfirmed"].is_null());
            if let Some((arm, _)) = arm.zip(motion) {
                return Report { is_accepted: true, stopped: None, text: arm.to_string() };
            }
        }
        assert!(Instant::now() < until, "no confirmation on the page");
    }
}

fn by_socket(group: &Group) -> Report {
    let patience = Span::from_s(60.0);
    let stopped = stop_socket::give(group.paths(), MotionOrder::Stop, patience, &mut |_| true);
    let (is_accepted, text) = (stopped.is_ok(), format!("{stopped:?}"));
    Report { is_accepted, stopped: is_accepted.then(clock::now), text }
}

fn by_python(group: &Group) -> Report {
    let python =
        std::env::var_os("WHICHONE_PYTHON").expect("a Python with the package's dependencies");
    let mut command = std::process::Command::new(python);
    command.args(["-c", "import sys, whichone\nwhichone.Client(sys.argv[1]).stop()"]);
    command.arg(group.paths().name().as_str()).env("WHICHONE_HOME", group.paths().home());
    command.env("PYTHONPATH", concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/sdk/python"));
    confirmed(&run(&mut command, "", 60.0))
}

/// A group with an arm that moves, in which stops are given.
struct Trial {
    group: Group,
    watch: MotionWatch,
    disk: Option<SmallDisk>,
}

impl Trial {
    fn begin(group: Group, disk: Option<SmallDisk>) -> Self {
        let watch = MotionWatch::start(group.paths());
        Self { group, watch, disk }
    }

    fn run_all(&self, pairs: &[(Way, During)]) {
        for (way, during) in pairs {
            let begun = Instant::now();
            self.run(*way, *during);
            println!("{way:?} during {during:?}: stopped, {:.1} s", begun.elapsed().as_secs_f64());
        }
    }

    /// Gives a stop while the arm fetches, checks its effect, and lets the arm go on.
    fn run(&self, way: Way, during: During) {
        let what = format!("{way:?} during {during:?}");
        let Self { group, watch, .. } = self;
        group.say("get me the clear bowl");
        watch.wait_moving();
        watch.clear();
        let report = self.give(way, during);
        let logs = || format!("{what}: {report:?}: {}\n{}", report.text, group.logs());
        assert!(report.is_accepted, "not accepted: {}", logs());
        if during != During::Race {
            watch.wait_stopped(&what);
            let rests = clock::now();
            watch.wait_states(rests, REST_S);
            assert_eq!(
                watch.movements_since(rests),
                0,
                "it moves after it was stopped: {}",
                logs()
            );
        }
        let shown = report.stopped.into_iter().chain(watch.said_stopped());
        if let Some(shown) = shown.min().filter(|_| during != During::Race) {
            assert_eq!(watch.movements_since(shown), 0, "it moves after \"stopped\": {}", logs());
        }
        if matches!(way, Way::Words | Way::Chat) && during != During::Race {
            wait_for("the robot's report", 10.0, || watch.said_stopped());
        }
        self.finish();
    }

    /// Releases the stop and has the arm give up what it fetches.
    fn finish(&self) {
        self.group.must(&["resume-motion"]);
        self.group.say("never mind");
        wait_for("an idle arm", 30.0, || {
            let status = self.watch.status();
            let rests = status.stopped == 0 && status.moving == 0;
            let is_over = self.group.dialogue()["interaction"].as_u64() == Some(0);
            (rests && is_over).then_some(())
        });
    }

    /// Gives the stop in that state of the group, which ends soon after.
    fn give(&self, way: Way, during: During) -> Report {
        thread::scope(|scope| {
            let group = &self.group;
            let give = move || way.give(group);
            match during {
                During::Nothing => give(),
                During::ArmKilled => {
                    group.signal("arm", Signal::KILL);
                    give()
                }
                During::ArmRestarted => {
                    while_done(scope, give, || drop(group.call(&["restart", "arm"])))
                }
                During::ArmHeld => {
                    group.must(&["hold", "arm"]);
                    let giving = scope.spawn(give);
                    outage(&giving);
                    group.must(&["release", "arm"]);
                    joined(giving)
                }
                During::ArmSwapped => {
                    let arm = program("whichone-arm").display().to_string();
                    let report = while_done(scope, give, || {
                        drop(group.call(&["swap", "arm", "--", &arm]));
                    });
                    group.must(&["restart", "arm", "--original"]);
                    report
                }
                During::ArmInBackoff => {
                    (0..4).for_each(|_| self.kill_ready_arm());
                    give()
                }
                During::SupervisorKilled => {
                    let pid = group.status()["supervisor_pid"].as_i64().expect("its pid");
                    let pid = Pid::from_raw(i32::try_from(pid).unwrap()).unwrap();
                    kill_process(pid, Signal::KILL).unwrap();
                    while_done(scope, give, || {
                        let ended = group.start_again(&SETTINGS);
                        assert_eq!(ended.code, Some(0), "{ended:?}");
                    })
                }
                During::Suspended(service) => {
                    group.signal(service, Signal::STOP);
                    let giving = scope.spawn(give);
                    outage(&giving);
                    group.signal(service, Signal::CONT);
                    joined(giving)
                }
                During::FullDisk => {
                    let disk = self.disk.as_ref().expect("a small disk");
                    disk.fill();
                    let giving = scope.spawn(give);
                    outage(&giving);
                    disk.free();
                    joined(giving)
                }
                During::Race => {
                    let release = scope.spawn(|| group.call(&["resume-motion"]));
                    let second = scope.spawn(|| group.call(&["stop-motion"]));
                    let report = give();
                    joined(release);
                    joined(second);
                    // Which order was the latest is chance, and an overruled one says so.
                    Report { is_accepted: true, ..report }
                }
            }
        })
    }

    fn kill_ready_arm(&self) {
        wait_for("a ready arm", 10.0, || {
            let arm = self.group.service("arm");
            let pid = arm["pid"].as_i64().filter(|_| arm["state"] == "ready")?;
            kill_process(Pid::from_raw(i32::try_from(pid).ok()?)?, Signal::KILL).ok()
        });
    }
}

/// Waits until the way has ended, or the outage is over.
fn outage(giving: &ScopedJoinHandle<'_, Report>) {
    let until = Instant::now() + OUTAGE;
    while !giving.is_finished() && Instant::now() < until {
        thread::sleep(Duration::from_millis(20));
    }
}

/// Gives the stop while `done` runs.
fn while_done<'scope>(
    scope: &'scope Scope<'scope, '_>,
    give: impl FnOnce() -> Report + Send + 'scope,
    done: impl FnOnce(),
) -> Report {
    let giving = scope.spawn(give);
    done();
    joined(giving)
}

fn joined<T>(thread: ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// Runs these pairs in one group.
fn run_all(pairs: &[(Way, During)]) {
    let trial = Trial::begin(Group::up(&SETTINGS), None);
    trial.run_all(pairs);
    trial.group.verify_journals();
    drop(trial.watch);
    trial.group.down();
}

/// Runs these ways in a group whose disk is full while the stop is given.
fn run_on_a_full_disk(ways: &[Way]) {
    let SmallGroup { group, disk } = SmallGroup::up(&SETTINGS);
    let trial = Trial::begin(group, Some(disk));
    let pairs: Vec<_> = ways.iter().map(|way| (*way, During::FullDisk)).collect();
    trial.run_all(&pairs);
    drop(trial.watch);
    trial.group.down();
    drop(trial.disk);
}

fn here() -> impl Iterator<Item = Way> {
    WAYS.into_iter().filter(|way| way.is_here())
}

/// Each way once, and each state once.
#[test]
fn each_way_stops_the_arm_and_each_state_lets_it_be_stopped() {
    let states = STATES.into_iter().filter(|during| *during != During::FullDisk);
    let ways: Vec<Way> = here().collect();
    // Words first: the arm's outages are theirs.
    let order = [Way::Words, Way::Words, Way::Chat, Way::Words];
    let of = |n: usize| order.get(n).copied().unwrap_or(ways[n % ways.len()]);
    let pairs: Vec<(Way, During)> = states.enumerate().map(|(n, during)| (of(n), during)).collect();
    let missing = ways.iter().filter(|way| pairs.iter().all(|(used, _)| used != *way));
    let missing = missing.map(|way| (*way, During::Nothing));
    let pairs: Vec<_> = pairs.iter().copied().chain(missing).collect();
    run_all(&pairs);
}

/// Every way in every state.
#[test]
#[ignore = "it takes minutes"]
fn every_way_stops_the_arm_in_every_state() {
    let states = STATES.into_iter().filter(|during| *during != During::FullDisk);
    let pairs: Vec<_> = states.flat_map(|during| here().map(move |way| (way, during))).collect();
    run_all(&pairs);
}

mod as_root {
    use super::*;

    #[test]
    fn words_stop_the_arm_on_a_full_disk() {
        run_on_a_full_disk(&[Way::Words]);
    }

    #[test]
    #[ignore = "it takes a minute"]
    fn every_way_stops_the_arm_on_a_full_disk() {
        run_on_a_full_disk(&here().collect::<Vec<_>>());
    }
}

/// The words of the smallest case: nothing fails, and the arm's service is away.
#[test]
fn said_stop_waits_for_an_arm_that_is_held() {
    let trial = Trial::begin(Group::up(&SETTINGS), None);
    trial.group.say("get me the clear bowl");
    trial.watch.wait_moving();
    trial.group.must(&["hold", "arm"]);
    trial.watch.clear();
    trial.group.say("stop");
    wait_for("the robot's warning", 10.0, || {
        trial.watch.line().contains("has not confirmed the stop").then_some(())
    });
    assert_eq!(trial.watch.said_stopped(), None);
    trial.group.must(&["release", "arm"]);
    trial.watch.wait_stopped("the arm's latch");
    wait_for("the robot's report", 10.0, || trial.watch.said_stopped());
    let answer = trial.group.call(&["watch", "--once", "--json"]).json();
    assert_eq!(answer["arm"]["stopped"], json!(true), "{answer}");
    trial.group.down();
}
