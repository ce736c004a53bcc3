//! The motion stop's own path: an order outlasts every absence of the arm's service, and resuming is never an accident.

use crate::dashboard::{Terminal, has};
use messages::StopId;
use rustix::process::{Pid, Signal, kill_process};
use serde_json::json;
use service::clock;
use service::stop_socket::{self, RELEASE_PATIENCE, StopError, is_kept};
use std::io::{BufRead, BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;
use whichone_tests::console::Visitor;
use whichone_tests::http_program::Program;
use whichone_tests::motion_watch::MotionWatch;
use whichone_tests::shortage::JointWatch;
use whichone_tests::{Group, run, wait_for};

/// The arm in real time, so that it moves for seconds.
const REAL_TIME: &str = "arm.time_scale=1";

/// The pause before a restart, as long as it is after many crashes in a row.
const LONG_FIRST: &str = "group.restart.backoff_first_ms=10000";
const LONG_MAX: &str = "group.restart.backoff_max_ms=10000";

/// Time after a stop in which no release counts, and some more.
const RELEASED_AFTER: Duration = Duration::from_millis(2_200);

/// `stop-motion` that goes on while the test does something else.
struct StopOrder {
    child: Child,
    warnings: Receiver<String>,
}

impl StopOrder {
    fn give(group: &Group, options: &[&str]) -> Self {
        let mut command = group.command(&["stop-motion", "--json"]);
        command.args(options).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        let lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let (sender, warnings) = channel();
        std::thread::spawn(move || {
            lines.map_while(Result::ok).try_for_each(|line| sender.send(line)).is_ok()
        });
        Self { child, warnings }
    }

    /// Waits for a warning that contains these words.
    fn wait_for_warning(&self, words: &[&str]) {
        let found = || self.warnings.try_iter().find(|line| words.iter().all(|w| line.contains(w)));
        wait_for(&format!("a warning with {words:?}"), 20.0, found);
    }

    /// Waits for the end; returns exit code and output.
    fn end(mut self) -> (Option<i32>, String) {
        let status = wait_for("the end of the order", 60.0, || self.child.try_wait().unwrap());
        let mut text = String::new();
        self.child.stdout.take().unwrap().read_to_string(&mut text).unwrap();
        (status.code(), text)
    }
}

#[test]
fn stop_outlasts_the_longest_restart_of_the_arm() {
    let group = Group::up(&[REAL_TIME, LONG_FIRST, LONG_MAX]);
    let joints = JointWatch::open(&group);
    group.say("get me the clear bowl");
    joints.wait_moving();
    // The first restart has no pause.
    let first = group.incarnation("arm");
    group.signal("arm", Signal::KILL);
    group.wait_for_restart("arm", first);
    joints.wait_moving();
    let before = group.incarnation("arm");
    group.signal("arm", Signal::KILL);
    wait_for("its end", 10.0, || (group.service("arm")["actual"] != "ready").then_some(()));
    let order = StopOrder::give(&group, &[]);
    order.wait_for_warning(&["not confirmed", "not running", "emergency stop", "is repeated"]);
    // The next warning comes three seconds later: the order goes on while the arm's service is away.
    order.wait_for_warning(&["not confirmed", "not running"]);
    assert_eq!(group.incarnation("arm"), before);
    let (code, text) = order.end();
    assert_eq!(code, Some(0), "{text}\n{}", group.logs());
    let state: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&state["stopped"], &state["at_rest"]), (&true.into(), &true.into()));
    // A second order is confirmed by an arm that has not moved since the first one.
    joints.stop(&group);
    group.wait_shown(true);
    group.down();
}

#[test]
fn stop_outlasts_a_hold_of_the_arm_and_ends_only_as_its_giver_wants() {
    let group = Group::up(&[REAL_TIME]);
    let joints = JointWatch::open(&group);
    group.say("get me the clear bowl");
    joints.wait_moving();
    group.must(&["hold", "arm"]);
    wait_for("the hold", 10.0, || (group.service("arm")["actual"] == "held").then_some(()));
    let ended = group.call(&["stop-motion", "--timeout", "4"]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    for words in ["not running", "may still move", "emergency stop", "held", "is repeated"] {
        assert!(ended.stderr.contains(words), "{words}: {}", ended.stderr);
    }
    let interrupted = StopOrder::give(&group, &[]);
    interrupted.wait_for_warning(&["not confirmed"]);
    let pid = Pid::from_child(&interrupted.child);
    kill_process(pid, Signal::INT).unwrap();
    interrupted.wait_for_warning(&["the order is not confirmed", "emergency stop"]);
    assert_eq!(interrupted.end().0, Some(1));
    let order = StopOrder::give(&group, &[]);
    // With the reason, and again and again.
    order.wait_for_warning(&["not confirmed", "held by the operator"]);
    order.wait_for_warning(&["not confirmed", "held by the operator"]);
    group.must(&["release", "arm"]);
    let (code, text) = order.end();
    assert_eq!(code, Some(0), "{text}\n{}", group.logs());
    joints.stop(&group);
    group.wait_shown(true);
    group.down();
}

#[test]
fn stop_outlasts_the_end_of_the_supervisor_and_ends_with_the_group() {
    let group = Group::up(&[REAL_TIME]);
    let joints = JointWatch::open(&group);
    group.say("get me the clear bowl");
    joints.wait_moving();
    let supervisor = group.status()["supervisor_pid"].as_i64().unwrap();
    kill_process(Pid::from_raw(supervisor as i32).unwrap(), Signal::KILL).unwrap();
    // The services end; what the arm answers before counts.
    wait_for("the arm's end", 20.0, || {
        let ended = group.call(&["stop-motion", "--timeout", "0.5"]);
        ended.stderr.contains("not running").then_some(())
    });
    let order = StopOrder::give(&group, &[]);
    order.wait_for_warning(&["not confirmed", "not running"]);
    let ended = group.start_again(&[REAL_TIME]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    assert_eq!(order.end().0, Some(0), "{}", group.logs());
    group.wait_shown(true);
    group.must(&["down"]);
    let ended = group.call(&["stop-motion"]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert!(ended.stderr.contains("is not running"), "{ended:?}");
}

#[test]
fn stop_that_its_giver_no_longer_repeats_is_obeyed_by_the_arm_that_returns() {
    let group = Group::up(&[REAL_TIME]);
    let watch = MotionWatch::start(group.paths());
    for how in ["timeout", "interrupt", "say", "kill"] {
        group.say("get me the clear bowl");
        watch.wait_moving();
        group.must(&["hold", "arm"]);
        wait_for("the hold", 10.0, || (group.service("arm")["actual"] == "held").then_some(()));
        let given = clock::now();
        match how {
            "timeout" => {
                let ended = group.call(&["stop-motion", "--timeout", "0.1"]);
                assert_eq!(ended.code, Some(1), "{ended:?}");
                assert!(ended.stderr.contains("the stop is kept"), "{ended:?}");
            }
            "say" => {
                let mut say = group.command(&["say", "stop"]).spawn().unwrap();
                wait_for("the stop to be kept", 20.0, || is_kept(group.paths()).then_some(()));
                kill_process(Pid::from_child(&say), Signal::INT).unwrap();
                assert_ne!(say.wait().unwrap().code(), Some(0));
            }
            _ => {
                let mut order = StopOrder::give(&group, &[]);
                order.wait_for_warning(&["not confirmed"]);
                let signal = if how == "kill" { Signal::KILL } else { Signal::INT };
                // A giver that is killed has kept its stop since the arm was silent for a quarter of a second.
                wait_for("the stop to be kept", 20.0, || is_kept(group.paths()).then_some(()));
                kill_process(Pid::from_child(&order.child), signal).unwrap();
                assert_ne!(order.child.wait().unwrap().code(), Some(0));
            }
        }
        group.must(&["release", "arm"]);
        watch.wait_stopped(how);
        watch.wait_states(clock::now(), 0.5);
        assert_eq!(watch.movements_since(given), 0, "{how}");
        group.release_stop();
        group.say("never mind");
        wait_for("an idle arm", 30.0, || (watch.status().moving == 0).then_some(()));
    }
    group.down();
}

/// The queue of the arm's socket holds few orders: a release that fills it must not keep a later stop out.
#[test]
fn stop_of_a_hung_arm_counts_before_every_order_that_waited_there() {
    let group = Group::up(&[REAL_TIME]);
    let watch = MotionWatch::start(group.paths());
    group.say("get me the clear bowl");
    watch.wait_moving();
    group.signal("arm", Signal::STOP);
    group.call(&["resume-motion", "--timeout", "0.5"]);
    let given = clock::now();
    let ended = group.call(&["stop-motion", "--timeout", "0.5"]);
    assert!(ended.stderr.contains("the stop is kept"), "{ended:?}");
    group.signal("arm", Signal::CONT);
    watch.wait_stopped("the stop that did not fit");
    let latched = clock::now();
    watch.wait_states(latched, 1.0);
    assert_eq!(watch.movements_since(latched), 0);
    assert!(watch.said_stopped().is_none_or(|said| said > given));
    group.down();
}

#[test]
fn stop_around_the_end_of_a_group_is_kept_for_the_next() {
    let group = Group::up(&[]);
    group.must(&["hold", "arm"]);
    let order = StopOrder::give(&group, &[]);
    order.wait_for_warning(&["not confirmed"]);
    group.must(&["down"]);
    order.wait_for_warning(&["the stop is kept"]);
    assert_eq!(order.end().0, Some(1));
    assert_eq!(group.start_again(&[]).code, Some(0));
    wait_for("the stop", 10.0, || (group.arm()["stopped"] == true).then_some(()));
    group.down();
}

#[test]
fn said_stop_needs_no_speech_service_and_tells_whether_the_arm_stopped() {
    let group = Group::up(&[REAL_TIME]);
    let watch = MotionWatch::start(group.paths());
    for state in ["held", "suspended"] {
        group.say("get me the clear bowl");
        watch.wait_moving();
        match state {
            "held" => drop(group.must(&["hold", "speech"])),
            _ => group.signal("speech", Signal::STOP),
        }
        let ended = group.call(&["say", "stop", "--timeout", "1"]);
        assert_ne!(ended.code, Some(0), "the words are lost: {ended:?}");
        assert!(ended.stderr.contains("the arm is stopped, at rest"), "{state}: {ended:?}");
        watch.wait_stopped(state);
        match state {
            "held" => drop(group.must(&["release", "speech"])),
            _ => group.signal("speech", Signal::CONT),
        }
        group.release_stop();
        group.say("never mind");
    }
    group.down();
}

#[test]
fn latched_stop_survives_a_fresh_start() {
    let mut group = Group::up(&[]);
    group.must(&["down"]);
    assert_eq!(group.start_fresh().code, Some(0));
    assert_eq!(group.arm()["stopped"], false, "it was free");
    group.must(&["stop"]);
    group.must(&["down"]);
    assert_eq!(group.start_fresh().code, Some(0));
    group.wait_shown(true);
    // The old journal cannot be read, or is lost.
    for lose in [|path| std::fs::write(path, "dear diary"), |path| std::fs::remove_file(path)] {
        group.release_stop();
        group.must(&["down"]);
        lose(group.paths().journal_file("arm")).unwrap();
        assert_eq!(group.start_fresh().code, Some(0));
        // Whether it was free is not known.
        group.wait_shown(true);
    }
    group.down();
}

#[test]
fn release_counts_two_seconds_after_any_stop_and_says_so() {
    let group = Group::up(&[]);
    let ended = wait_for("a release that is too early", 20.0, || {
        group.must(&["stop-motion"]);
        Some(group.call(&["resume-motion"])).filter(|it| it.code == Some(1))
    });
    assert!(ended.stderr.contains("less than 2 s before"), "{ended:?}");
    std::thread::sleep(RELEASED_AFTER);
    assert_eq!(group.arm()["stopped"], true, "not released later either");
    let released = group.must(&["resume-motion"]);
    assert!(released.stderr.contains("releasing the stop that was given"), "{released:?}");
    group.wait_shown(false);
    group.down();
}

/// Who begins to release a stop has not seen the one that is given meanwhile.
#[test]
fn release_of_a_stop_that_is_not_the_latest_is_refused_and_leaves_the_arm_stopped() {
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", "see,resume");
    let mut page = group.page(&Visitor::operator(1));
    let mut watch = Terminal::start(&mut group.command(&["watch"]), 110, 32);
    group.must(&["stop-motion"]);
    let seen = page.until_part("arm", |arm| arm["stopped"] == true)["stop"].clone();
    assert!(seen.as_u64() > Some(0), "{seen}");
    watch.wait_for("the stop", |lines| has(lines, "STOPPED"));
    watch.press("rresum");
    watch.wait_for("the word", |lines| has(lines, "Enter: resum_"));
    std::thread::sleep(Duration::from_millis(50));
    group.must(&["stop-motion"]);
    let later = page.until_part("arm", |arm| arm["stop"].as_u64() > seen.as_u64())["stop"].clone();
    std::thread::sleep(RELEASED_AFTER);

    let old = json!({ "stop": seen });
    let refused = program.ask("POST", "/motion/resume", &[], &old.to_string());
    assert_eq!((refused.status, &refused.body["code"]), (409, &json!("other_stop")), "{refused:?}");
    let refused = page.ask("resume", &old);
    assert!(refused["error"].as_str().is_some_and(|why| why.contains("another stop")), "{refused}");
    let stop = StopId(seen.as_u64().unwrap());
    let refused = stop_socket::release(group.paths(), stop, RELEASE_PATIENCE, &mut |_| true);
    assert_eq!(refused, Err(StopError::OtherStop));
    watch.press("e\r");
    watch.wait_for("the refusal", |lines| has(lines, "another stop was given"));
    assert_never_released(&group, "the first stop was seen");

    let unreadable = program.ask("POST", "/motion/resume", &[], r#"{"stop": "last"}"#);
    assert_eq!(unreadable.status, 400, "{unreadable:?}");
    assert_eq!(program.get("/state").body["arm"]["stop"], later);
    let released =
        program.ask("POST", "/motion/resume", &[], &json!({ "stop": later }).to_string());
    assert_eq!(released.status, 200, "{released:?}");
    assert_eq!(page.until_part("arm", |arm| arm["stopped"] == false)["stop"], 0);
    drop((page, watch));
    group.down();
}

/// A container may have a monotonic clock of its own, before or after the machine's.
#[test]
#[ignore = "needs root: makes time namespaces"]
fn stop_and_release_from_another_time_namespace_are_obeyed() {
    let group = Group::up(&[]);
    let program = whichone_tests::program("whichone").display().to_string();
    let within = |offset: &str, verb: &str| {
        let mut command = Command::new("unshare");
        command.env("WHICHONE_HOME", group.paths().home());
        command.env("WHICHONE_GROUP", group.paths().name().as_str());
        command.args(["-T", "--fork", "--monotonic", offset, &program, verb, "--timeout", "20"]);
        let ended = run(&mut command, "", 60.0);
        assert_eq!(ended.code, Some(0), "{offset} {verb}: {ended:?}");
    };
    // The order is confirmed on the stop's own path, and the topic follows.
    let wait_stopped = |is: bool, offset: &str| {
        wait_for(&format!("stopped: {is}, {offset}"), 5.0, || {
            (group.arm()["stopped"] == is).then_some(())
        });
    };
    for offset in ["-50", "3600"] {
        within(offset, "stop-motion");
        wait_stopped(true, offset);
        std::thread::sleep(RELEASED_AFTER);
        within(offset, "resume-motion");
        wait_stopped(false, offset);
        // Orders of both clocks are in one sequence.
        within(offset, "stop-motion");
        group.release_stop();
        wait_stopped(false, offset);
    }
    group.down();
}

/// Presses of a frightened user: their number, and the milliseconds between them.
const RHYTHMS: [(usize, u64); 5] = [(20, 50), (8, 250), (6, 500), (4, 1_000), (3, 2_000)];

/// Fails if the motion stop was ever released.
fn assert_never_released(group: &Group, what: &str) {
    assert_eq!(group.arm()["stopped"], true, "{what}");
    let journal = group.must(&["journal", "arm"]).stdout;
    assert!(journal.contains("motion stop latched"), "{what}: {journal}");
    assert!(!journal.contains("motion stop released"), "{what}: {journal}");
}

#[test]
fn hammered_stop_keys_of_watch_never_release() {
    let group = Group::up(&[REAL_TIME]);
    group.say("get me the clear bowl");
    let mut terminal = Terminal::start(&mut group.command(&["watch"]), 110, 32);
    terminal.wait_for("the keys", |lines| has(lines, "q quit"));
    for (number, (count, every_ms)) in RHYTHMS.into_iter().enumerate() {
        let key = ["s", "\x1b", " ", "\x13", "s\r"][number];
        for _ in 0..count {
            terminal.press(key);
            std::thread::sleep(Duration::from_millis(every_ms));
        }
        wait_for("the stop", 20.0, || (group.arm()["stopped"] == true).then_some(()));
        assert_never_released(&group, &format!("{key:?} every {every_ms} ms"));
    }
    // The typed words are the only way.
    for _ in 0..2 {
        terminal.press("\x1b");
        std::thread::sleep(Duration::from_millis(100));
    }
    std::thread::sleep(RELEASED_AFTER);
    terminal.press("rresume\r");
    terminal.wait_for("the release", |lines| has(lines, "the arm may move"));
    group.wait_shown(false);
    drop(terminal);
    group.down();
}

#[test]
fn hammered_stop_lines_of_chat_never_release_and_are_confirmed_without_speech() {
    let group = Group::up(&[REAL_TIME]);
    group.say("get me the clear bowl");
    // The words reach the arm on the motion stop's own path.
    group.must(&["hold", "speech"]);
    let mut chat = Chat::start(&group);
    for (count, every_ms) in RHYTHMS {
        for _ in 0..count {
            chat.line("stop");
            std::thread::sleep(Duration::from_millis(every_ms));
        }
        wait_for("the stop", 20.0, || (group.arm()["stopped"] == true).then_some(()));
        assert_never_released(&group, &format!("stop every {every_ms} ms"));
    }
    chat.wait_for("the arm is stopped, at rest");
    chat.line("stop\nresume");
    chat.wait_for("stopped just now");
    for words in ["go on", "continue"] {
        chat.line(words);
        chat.wait_for("to let it move, type resume");
    }
    std::thread::sleep(RELEASED_AFTER);
    assert_never_released(&group, "go on");
    chat.line("resume");
    chat.wait_for("the arm may move");
    group.wait_shown(false);
    // Not confirmed is not called stopped.
    group.must(&["hold", "arm"]);
    chat.line("stop");
    chat.wait_for("not confirmed: the arm's service is not running");
    chat.line("quit");
    kill_process(chat.pid(), Signal::INT).unwrap();
    chat.wait_for("the order is not confirmed");
    let ended = wait_for("the end", 20.0, || chat.terminal.child.try_wait().unwrap());
    assert_eq!(ended.code(), Some(1));
    group.down();
}

/// `whichone chat` in a terminal.
struct Chat {
    terminal: Terminal,
    notes: Receiver<String>,
}

impl Chat {
    fn start(group: &Group) -> Self {
        let mut terminal = Terminal::start(&mut group.command(&["chat"]), 110, 32);
        let lines = BufReader::new(terminal.child.stderr.take().unwrap()).lines();
        let (sender, notes) = channel();
        std::thread::spawn(move || {
            lines.map_while(Result::ok).try_for_each(|line| sender.send(line)).is_ok()
        });
        let chat = Self { terminal, notes };
        chat.wait_for("quit ends");
        chat
    }

    fn line(&mut self, text: &str) {
        self.terminal.press(&format!("{text}\n"));
    }

    /// Waits for a note with these words; earlier ones are passed over.
    fn wait_for(&self, words: &str) {
        wait_for(words, 20.0, || self.notes.try_iter().find(|note| note.contains(words)));
    }

    fn pid(&self) -> Pid {
        Pid::from_child(&self.terminal.child)
    }
}
