//! Grounders that are built with the SDKs beside the built-in one: the same dialogues, with the same outcomes.

use std::ops::Range;

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::{Group, program, run, wait_for};

use crate::conform::conform;
use crate::dialogues::{asked_by_line, last_heard};
use crate::python;
use crate::swap::swap;

/// The SDK in C.
const SDK_C: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/sdk/c");

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

/// Compiles an example in C.
fn c_example(name: &str) -> (tempfile::TempDir, String) {
    let source = format!("{SDK_C}/examples/{name}.c");
    compiled(&std::fs::read_to_string(source).expect("an example"))
}

/// Compiles a program in C against the library of this build, into a folder of its own.
fn compiled(source: &str) -> (tempfile::TempDir, String) {
    let library = program("libwhichone_c.so");
    let folder = library.parent().expect("a folder").display().to_string();
    let out = tempfile::tempdir().expect("a temporary folder");
    let example = out.path().join("program").display().to_string();
    let file = format!("{example}.c");
    std::fs::write(&file, source).expect("a writable folder");
    let mut compiler = std::process::Command::new("cc");
    // The examples include the header by its place beside them.
    let include = format!("-I{SDK_C}/examples");
    compiler.args(["-std=gnu11", "-Wall", "-Wextra", "-Werror", &include, &file]);
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

/// Says words in answer to a line, and releases a stop: `program WORDS PROMPT STOP`.
const ANSWER: &str = r#"
#include <stdio.h>
#include <stdlib.h>
#include "../whichone_group.h"

int main(int count, char **words) {
    whichone_group_t *group = count == 4 ? whichone_join_as_client(NULL) : NULL;
    if (!group)
        return WHICHONE_EXIT_USAGE;
    uint64_t seen = strtoull(words[2], NULL, 10), stop = strtoull(words[3], NULL, 10);
    bool heard = whichone_say_in_answer(group, "", words[1], seen, 10.0) > 0;
    bool released = whichone_release_stop(group, stop, -1.0);
    whichone_leave(group);
    return heard ? (released ? 0 : 1) : 2;
}
"#;

#[test]
fn sdk_c_client_answers_the_line_and_releases_the_stop_that_were_shown() {
    let (_out, answer) = compiled(ANSWER);
    let group = Group::up(&[]);
    let first = asked_by_line(&group, "get me the bowl", 0);
    asked_by_line(&group, "white", first);
    group.must(&["stop-motion"]);
    let seen = group.arm()["stop"].as_u64().expect("a number");
    group.must(&["stop-motion"]);
    let later = wait_for("the later stop", 20.0, || {
        group.arm()["stop"].as_u64().filter(|stop| *stop > seen)
    });
    std::thread::sleep(std::time::Duration::from_millis(2_200));
    let ended = |stop: u64| {
        let mut command = std::process::Command::new(&answer);
        command.env("WHICHONE_HOME", group.paths().home());
        command.env("WHICHONE_GROUP", group.paths().name().as_str());
        run(command.args(["yes", &first.to_string(), &stop.to_string()]), "", 60.0)
    };
    let refused = ended(seen);
    assert_eq!(refused.code, Some(1), "{refused:?}");
    assert!(refused.stderr.contains("another stop was given"), "{refused:?}");
    assert_eq!(last_heard(&group), ("yes".to_owned(), vec![first]));
    assert_eq!(group.arm()["stopped"], true);
    assert_eq!(ended(later).code, Some(0));
    group.down();
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
