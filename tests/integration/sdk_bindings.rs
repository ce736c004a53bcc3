//! Grounders that are built with the SDKs beside the built-in one: the same dialogues, with the same outcomes.

use std::ops::Range;

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::Group;

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
    ("I need the big metal bowl", &["metal2", "metal"]),
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

/// The folder of the built C examples.
fn c_examples() -> String {
    std::env::var("WHICHONE_SDK_C").expect("WHICHONE_SDK_C is set; help: run `scripts/sdk test`")
}

#[test]
#[ignore = "needs the C examples, which `scripts/sdk test` builds"]
fn sdk_c_grounder_has_the_outcomes_of_the_built_in_one() {
    check_same_outcomes(&[&format!("{}/grounding", c_examples())]);
}

#[test]
#[ignore = "needs the C examples, which `scripts/sdk test` builds"]
fn sdk_c_client_says_and_watches() {
    let say = format!("{}/say", c_examples());
    let group = Group::up(&[]);
    let run = |text: &str, name: &str| {
        let mut command = std::process::Command::new(&say);
        command.env("WHICHONE_HOME", group.paths().home()).env("WHICHONE_GROUP", name);
        whichone_tests::run(command.args([text, "60"]), "", 90.0)
    };
    let ended = run("get me the clear bowl", group.paths().name().as_str());
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    assert!(ended.stdout.contains("robot: ") && ended.stdout.contains(" delivered"), "{ended:?}");
    let ended = run(" ", group.paths().name().as_str());
    assert!(ended.code == Some(64) && ended.stderr.contains("refused: "), "{ended:?}");
    let ended = run("hello", "no-such-group");
    assert!(ended.code == Some(1) && ended.stderr.contains("is not running"), "{ended:?}");
    group.verify_journals();
    group.down();
}
