//! A language model that reads utterances: a service in this process stands in for it.

use std::io::Write;
use std::process::Command;

use serde_json::Value;
use stand_in_model::{Reply, StandIn, heard, wants};
use whichone_tests::{Group, program, run, wait_for};

/// What the built-in reader cannot know; everything else gets an answer that is refused.
const RIDDLE: &str = "the one that grandma likes";

fn reply(request: &Value) -> Reply {
    match heard(request).as_str() {
        RIDDLE => Reply::Content(wants(&["clear"])),
        _ => Reply::Content("I would say the red one.".to_owned()),
    }
}

fn wait_for_status(group: &Group, part: &str) {
    wait_for(&format!("status `{part}`"), 30.0, || {
        let says = group.service("grounding")["says"].as_str()?.to_owned();
        says.contains(part).then_some(())
    });
}

#[test]
fn model_reads_what_the_built_in_reader_cannot_and_dialogues_go_on_without_it() {
    let model = StandIn::start(reply).unwrap();
    let url = format!("dialogue.model.url={}", model.url());
    let group = Group::up(&[&url, "dialogue.model.model=small", "dialogue.model.timeout_ms=8000"]);
    group.say(RIDDLE);
    wait_for_status(&group, "model small answers");
    let outcome = group.await_pick(Some("clear"));
    assert_eq!((&outcome["object"], &outcome["outcome"]), (&"clear".into(), &"delivered".into()));
    let journal = group.must(&["journal", "policy", "--json"]).stdout;
    assert!(journal.contains(r#""base":["clear"]"#), "{journal}");

    // Its answers are refused: the built-in reader understands.
    assert_eq!(group.fetch("the big metal bowl", "metal2")["object"], "metal2");
    wait_for_status(&group, "in place of the model: answer refused");
    let address = model.address();
    drop(model);
    assert_eq!(group.fetch("the big metal bowl", "metal2")["object"], "metal2");
    wait_for_status(&group, "in place of the model: not reached");
    let _back = StandIn::start_at(address, reply).unwrap();
    group.say(RIDDLE);
    wait_for_status(&group, "model small answers");
    let outcome = group.await_pick(Some("clear"));
    assert_eq!(outcome["object"], "clear", "{outcome}");
    let log = group.must(&["logs", "grounding"]).stdout;
    // Once a minute at most, and not with each utterance.
    let warnings = log.matches("the built-in reader takes its place").count();
    assert!((1..=2).contains(&warnings), "{log}");
    group.verify_journals();

    // The flight has the answers, so that a replay needs no model.
    let flights = group.paths().flights().display().to_string();
    let ended = group.call(&["replay", &flights, "--service", "grounding"]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    group.down();
}

#[test]
fn calibration_is_fitted_to_labelled_lines() {
    // Certain of itself, and right about half of the lines only.
    let model = StandIn::start(|request| match heard(request).as_str() {
        "garbage" => Reply::Content("{}".to_owned()),
        text if text.contains("white") => Reply::Content(wants(&["white"])),
        _ => Reply::Content(wants(&["clear"])),
    })
    .unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lines.jsonl");
    let mut file = std::fs::File::create(&path).unwrap();
    for (text, base) in [
        ("the white bowl", "white"),
        ("a white one", "white"),
        ("the metal bowl", "metal"),
        ("the small bowl", "small"),
        ("garbage", "white"),
    ] {
        let expect =
            format!(r#"{{"base":["{base}"],"response":"none","excluded":[],"intent":"inform"}}"#);
        writeln!(file, r#"{{"id":"{text}","text":"{text}","expect":{expect}}}"#).unwrap();
    }
    let url = format!("dialogue.model.url={}", model.url());
    let calibrate = |words: &[&str]| {
        let mut command = Command::new(program("whichone"));
        command.args(["ground", "--scene", "bowls", "--calibrate"]).arg(&path);
        command.args(["--set", &url, "--set", "dialogue.model.timeout_ms=8000"]).args(words);
        run(command.current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/..")), "", 120.0)
    };
    let ended = calibrate(&["--set", "dialogue.model.model=small", "--json"]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let found = ended.json();
    assert_eq!((&found["lines"], &found["right"]), (&4.into(), &2.into()), "{found}");
    assert_eq!(found["failures"][0]["id"], "garbage", "{found}");
    assert_eq!(found["misread"][0]["read"]["base"][0], "clear", "{found}");
    let loss = |name: &str| found["log_loss"][name].as_f64().unwrap();
    assert!(loss("built_in") < 0.01 && loss("before") > 3.0 && loss("after") < 0.01, "{found}");
    assert!(found["calibration"]["built_in"].as_f64().unwrap() > 0.95, "{found}");
    let ended = calibrate(&["--set", "dialogue.model.model=small"]);
    assert!(ended.stdout.contains("[model.calibration]\npower = "), "{ended:?}");
    let ended = calibrate(&[]);
    assert_eq!(ended.code, Some(78), "{ended:?}");
    assert!(
        ended.stderr.contains("dialogue.model.url: the name of the model is missing"),
        "{}",
        ended.stderr
    );
}
