//! Grounders that are built with the SDKs beside the built-in one: the same dialogues, with the same outcomes.

use std::ops::Range;

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::{Group, program, run};

use crate::conform::conform;
use crate::python;
use crate::swap::swap;

/// Dialogues with each grounder: a few in continuous integration, `$WHICHONE_SDK_DIALOGUES` in `scripts/sdk dialogues`.
fn dialogues() -> usize {
    let number = std::env::var("WHICHONE_SDK_DIALOGUES").ok();
    number.map_or(4, |number| number.parse().expect("WHICHONE_SDK_DIALOGUES is a number"))
}

/// Requests, and the objects that users want who say so.
const REQUESTS: [(&str, &[&str]); 4] = [
    ("get me the bowl", &["white", "white2", "white3", "metal", "metal2", "clear"]),
    ("the white bowl please", &["white", "white2", "white3"]),
    ("I need the big metal bowl", &["metal2"]),
    ("bring me the clear one", &["clear"]),
];

/// Holds the dialogues of these numbers and returns their outcomes.
fn held(group: &Group, numbers: Range<usize>) -> Vec<(String, Value, Value)> {
    let one = |n: usize| {
        let (request, objects) = REQUESTS[n % REQUESTS.len()];
        let object = objects[(n / REQUESTS.len()) % objects.len()];
        let ended = group.fetch(request, object);
        let [picked, outcome] = ["object", "outcome"].map(|key| ended[key].clone());
        (format!("{request:?} for {object}"), picked, outcome)
    };
    numbers.map(one).collect()
}

/// Swaps the grounder in and holds the dialogues with it; half-way it is killed.
#[track_caller]
fn check_same_outcomes(command: &[&str]) {
    let count = dialogues();
    let group = Group::up_in_memory(&[]);
    let expected = held(&group, 0..count);
    let ended = swap(&group, "grounding", command);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    let mut found = held(&group, 0..count / 2);
    let before = group.incarnation("grounding");
    group.signal("grounding", Signal::KILL);
    found.extend(held(&group, count / 2..count));
    group.wait_for_restart("grounding", before);
    assert_eq!(found.len(), count);
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found, expected, "{}", group.logs());
    }
    let status = group.service("grounding");
    assert_eq!(status["incarnation"].as_u64(), Some(before + 1), "it was killed once: {status}");
    assert!(!group.logs().contains("message rejected"), "{}", group.logs());
    group.verify_journals();
    group.down();
}

#[test]
#[ignore = "needs python3 with iceoryx2"]
fn sdk_python_grounder_has_the_outcomes_of_the_built_in_one() {
    let command = python::service("grounding");
    check_same_outcomes(&command.each_ref().map(String::as_str));
}

#[test]
#[ignore = "needs python3 with iceoryx2"]
fn sdk_python_grounder_keeps_the_contract() {
    let command = python::service("grounding");
    let ended = conform("grounding", &[], &command.each_ref().map(String::as_str));
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

#[test]
fn sdk_c_grounder_keeps_the_contract() {
    let (_out, grounder) = c_example("grounding");
    let ended = conform("grounding", &[], &[&grounder]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
}

/// Compiles an example in C against the library of this build, into a folder of its own.
fn c_example(name: &str) -> (tempfile::TempDir, String) {
    let library = program("libwhichone_c.so");
    let folder = library.parent().expect("a folder").display().to_string();
    let out = tempfile::tempdir().expect("a temporary folder");
    let example = out.path().join(name).display().to_string();
    let source = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/sdk/c/examples");
    let mut compiler = std::process::Command::new("cc");
    compiler.args(["-std=gnu11", "-Wall", "-Wextra", "-Werror", &format!("{source}/{name}.c")]);
    compiler.args(["-o", &example, &format!("-L{folder}"), "-lwhichone_c"]);
    compiler.arg(format!("-Wl,-rpath,{folder}"));
    // Rust links with the same program.
    let ended = run(&mut compiler, "", 60.0);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    (out, example)
}

#[test]
fn sdk_c_grounder_has_the_outcomes_of_the_built_in_one() {
    let (_out, grounder) = c_example("grounding");
    check_same_outcomes(&[&grounder]);
    // Started by hand, it says how it is started.
    let ended = run(&mut std::process::Command::new(&grounder), "", 10.0);
    assert_eq!(ended.code, Some(64), "{ended:?}");
    assert!(ended.stderr.contains("help: services are started by their supervisor"), "{ended:?}");
}

#[test]
fn sdk_c_client_says_and_watches() {
    let (_out, say) = c_example("say");
    let group = Group::up(&[]);
    let said = |text: &str, name: &str| {
        let mut command = std::process::Command::new(&say);
        command.env("WHICHONE_HOME", group.paths().home()).env("WHICHONE_GROUP", name);
        run(command.args([text, "60"]), "", 90.0)
    };
    let ended = said("get me the clear bowl", group.paths().name().as_str());
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    assert!(ended.stdout.contains("robot: ") && ended.stdout.contains(" delivered"), "{ended:?}");
    let ended = said(" ", group.paths().name().as_str());
    assert!(ended.code == Some(64) && ended.stderr.contains("refused: "), "{ended:?}");
    let ended = said("hello", "no-such-group");
    assert!(ended.code == Some(1) && ended.stderr.contains("is not running"), "{ended:?}");
    group.verify_journals();
    group.down();
}
