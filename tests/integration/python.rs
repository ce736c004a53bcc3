//! The Python package: its example grounders in the grounding service's place, its client, and its own tests.

use std::process::Command;

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::{Ended, Group, program, run};

use crate::swap::swap;

/// The package's folder.
const PACKAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/sdk/python");
/// Timeout of a program in Python, seconds.
const PATIENCE_S: f64 = 90.0;

/// The Python interpreter that has the iceoryx2 wheel: `$WHICHONE_PYTHON`, else `python3`.
fn python() -> String {
    std::env::var("WHICHONE_PYTHON").unwrap_or_else(|_| "python3".to_owned())
}

/// The path of an example.
fn example(name: &str) -> String {
    format!("{PACKAGE}/examples/{name}.py")
}

/// The command of an example as a service, which finds the package where it is.
pub(crate) fn service(name: &str) -> [String; 4] {
    ["/usr/bin/env".to_owned(), format!("PYTHONPATH={PACKAGE}"), python(), example(name)]
}

/// Runs a client in Python for this group.
fn client(group: &Group, words: &[&str]) -> Ended {
    let mut command = Command::new(python());
    command.env("WHICHONE_HOME", group.paths().home());
    command.env("WHICHONE_GROUP", group.paths().name().as_str());
    run(command.env("PYTHONPATH", PACKAGE).args(words), "", PATIENCE_S)
}

/// The service in Python that the documentation holds takes grounding's place under traffic.
#[test]
#[ignore = "needs python3 with iceoryx2"]
fn example_in_python_replaces_grounding() {
    let command = service("grounding");
    let command = command.each_ref().map(String::as_str);
    let group = Group::up(&[]);
    for object in ["metal2", "clear", "white3"] {
        group.say("get me the bowl");
        let talk = std::thread::scope(|scope| {
            let talk = scope.spawn(|| group.await_pick(Some(object)));
            let ended = swap(&group, "grounding", &command);
            assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
            talk.join().expect("the dialogue")
        });
        assert_eq!(talk["object"], object, "{talk}\n{}", group.logs());
    }
    let before = group.incarnation("grounding");
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    assert_eq!(group.incarnation("grounding"), before, "it runs on\n{}", group.logs());
    group.signal("grounding", Signal::KILL);
    group.wait_for_restart("grounding", before);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    let old = program("whichone-grounding").display().to_string();
    assert_eq!(swap(&group, "grounding", &[&old]).code, Some(0));
    assert!(!group.logs().contains("Traceback"), "{}", group.logs());
    group.verify_journals();
    group.down();
}

/// The example planner decides in the policy service, and its journal is verified with it.
#[test]
#[ignore = "needs python3 with iceoryx2"]
fn example_planner_in_python_decides() {
    let policy = ["whichone-policy".to_owned(), "--planner-program".to_owned()];
    let command: Vec<String> = policy.into_iter().chain(service("planner")).collect();
    let group = Group::up(&[&format!("group.services.policy.command={command:?}")]);
    for object in ["metal2", "white"] {
        let outcome = group.fetch("get me the bowl", object);
        assert_eq!(
            (&outcome["object"], &outcome["outcome"]),
            (&object.into(), &"delivered".into())
        );
        assert!(outcome["questions"].as_u64() > Some(0), "{outcome}");
    }
    assert_eq!(group.dialogue()["planner"], "program");
    assert!(!group.logs().contains("has not decided"), "{}", group.logs());
    group.verify_journals();
    group.down();
}

/// A stand-in for a language model. It knows a word that the built-in readers do not, logs its
/// input, and gives invalid output or sleeps where the input says so.
const STAND_IN: &str = r#"
import json, re, sys, time
prompt = sys.stdin.read()
line = lambda name: json.loads(re.search(name + ": (.*)", prompt)[1])
heard = line("heard")[0]["text"].lower()
with open(sys.argv[1], "a", encoding="utf-8") as log:
    log.write(heard + "\n")
said = re.findall("[a-z]+", heard.replace("glassy", "clear"))
if "sleep" in said:
    time.sleep(60)
if "broken" in said:
    print("the clear one, I think")
elif "foreign" in said:
    print(json.dumps({"readings": [{"base": ["purple"]}]}))
else:
    response = [word for word in said if word in ("yes", "no")][:1] or ["none"]
    base = [word for word in line("scene words") if word in said]
    print(json.dumps({"readings": [{"base": base, "response": response[0]}]}))
"#;

#[test]
#[ignore = "needs python3 with iceoryx2"]
fn external_program_replaces_grounding() {
    let python = python();
    let group = Group::up(&[]);
    let folder = tempfile::tempdir().unwrap();
    let (stand_in, log) = (folder.path().join("stand_in.py"), folder.path().join("asked.txt"));
    std::fs::write(&stand_in, STAND_IN).unwrap();
    let asked = || std::fs::read_to_string(&log).unwrap();
    let paths = [&stand_in, &log].map(|path| path.display().to_string());
    let service = service("by_program");
    let mut command = service.each_ref().map(String::as_str).to_vec();
    command.extend([&*python, &paths[0], &paths[1]]);
    assert_eq!(swap(&group, "grounding", &command).code, Some(0), "{}", group.logs());
    assert_eq!(group.fetch("the glassy one", "clear")["object"], "clear", "{}", group.logs());
    assert!(asked().contains("the glassy one\n"), "{}", asked());
    assert!(!group.logs().contains("word spotting"), "{}", group.logs());
    // A program that says nothing of use, or nothing in time, is done without.
    for text in ["broken the clear bowl", "foreign the clear bowl", "sleep the clear bowl"] {
        assert_eq!(group.fetch(text, "clear")["object"], "clear", "{text}: {}", group.logs());
        assert!(asked().contains(text) && group.logs().contains("word spotting"), "{text}");
    }
    assert!(!group.logs().contains("Traceback"), "{}", group.logs());
    group.verify_journals();
    group.down();
}

/// Says, waits, stops and resumes, and prints what became of each.
const CLIENT: &str = r#"
import json, threading, time
from whichone import Client, NoPick, NotStopped

outcome = {}
with Client() as robot:
    outcome["number"] = robot.say("get me the clear bowl")
    ended = robot.await_pick(timeout=60)
    outcome["picked"] = [ended.name, ended.outcome.name]
    robot.stop()
    while not robot.look().arm.stopped:
        time.sleep(0.01)
    seen = robot.look().arm.stop
    robot.stop()
    while (stop := robot.look().arm.stop) == seen:
        time.sleep(0.01)
    time.sleep(2.2)
    try:
        robot.resume(stop=seen)
    except NotStopped as refused:
        outcome["refused"] = str(refused)
    robot.resume(stop=stop)
    while robot.look().arm.stopped:
        time.sleep(0.01)
    robot.say("thank you")
    try:
        robot.await_pick(timeout=60)
    except NoPick as answer:
        outcome["answer"] = str(answer)
    belief = robot.look().belief
    outcome["belief"] = [len(belief), round(sum(belief.values()), 6)]
print(json.dumps(outcome))
"#;

#[test]
#[ignore = "needs python3 with iceoryx2"]
fn client_in_python_says_waits_and_stops() {
    let group = Group::up(&[]);
    let ended = client(&group, &["-c", CLIENT]);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    let outcome: Value = ended.json();
    assert_eq!(outcome["picked"], serde_json::json!(["clear", "DELIVERED"]), "{outcome}");
    assert_eq!(outcome["belief"], serde_json::json!([6, 1.0]), "{outcome}");
    let refused = outcome["refused"].as_str();
    assert!(refused.is_some_and(|why| why.contains("another stop")), "{outcome}");
    assert!(outcome["answer"].as_str().is_some_and(|text| !text.is_empty()), "{outcome}");
    // The example answers the robot's questions.
    let ended = client(&group, &[&example("client"), "get me the bowl", "--want", "white3"]);
    assert!(ended.stdout.contains("delivered white3"), "{ended:?}\n{}", group.logs());
    let ended = client(&group, &[&example("client"), "get me the bowl", "--want", "vase"]);
    assert_eq!(ended.code, Some(2), "{ended:?}");
    assert!(ended.stderr.contains("expected one of white, "), "{ended:?}");
    let run = group.paths().run();
    group.verify_journals();
    group.must(&["down"]);
    assert!(!run.exists());
    let ended = client(&group, &["-c", "from whichone import Client; Client()"]);
    assert!(ended.stderr.contains("is not running"), "{ended:?}");
    assert!(ended.stderr.contains("help: start it with `whichone up"), "{ended:?}");
}

#[test]
#[ignore = "needs python3 with iceoryx2"]
fn package_in_python_passes_its_tests() {
    let tests = format!("{PACKAGE}/tests");
    let mut command = Command::new(python());
    command.args(["-m", "unittest", "discover", "-s", &tests]).env("PYTHONPATH", PACKAGE);
    let ended = run(&mut command, "", PATIENCE_S);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    // Started by hand, a service says how it is started.
    let ended = run(
        Command::new(python()).arg(example("grounding")).env("PYTHONPATH", PACKAGE),
        "",
        PATIENCE_S,
    );
    assert_eq!(ended.code, Some(64), "{ended:?}");
    assert!(ended.stderr.contains("help: services are started by their supervisor"), "{ended:?}");
}
