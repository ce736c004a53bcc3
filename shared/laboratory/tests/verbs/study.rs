//! `study`: the same seed gives the same bytes, and bad input is named.

use std::path::Path;

use serde_json::Value;
use service::exit::Exit;

use super::{Ended, run};

fn study(words: &[&str]) -> Ended {
    run(&[&["study"], words].concat())
}

const BOWLS: [&str; 2] = ["--scene", "config/scenes/bowls.toml"];

/// Every file in the folder, by name.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_str().unwrap().to_owned();
            (name, std::fs::read(path).unwrap())
        })
        .collect();
    files.sort();
    files
}

#[test]
fn the_same_seed_gives_the_same_bytes_on_any_number_of_threads() {
    let run = |threads: &str, seed: &str| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().to_str().unwrap();
        let words = ["--interactions", "1100", "--users", "model,human", "--turns", "naive"];
        let more = ["--policies", "lookahead", "--threads", threads, "--seed", seed, "--out", out];
        let out = study(&[&BOWLS[..], &words, &more].concat()).succeeded();
        (out, files(folder.path()))
    };
    let one = run("1", "7");
    assert_eq!(one, run("3", "7"));
    assert_ne!(one.0, run("1", "8").0);
    let names: Vec<&str> = one.1.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, FILES);
    assert!(one.1.iter().all(|(_, bytes)| !bytes.is_empty()));
}

const FILES: [&str; 5] =
    ["questions.svg", "study.csv", "study.json", "success.svg", "turn-taking.svg"];

#[test]
fn every_policy_is_simulated_with_every_kind_of_user() {
    let words = ["--interactions", "60", "--users", "model,truthful,noisy,human", "--json"];
    let out = study(&[&BOWLS[..], &words].concat()).succeeded();
    let json: Value = serde_json::from_slice(&out).unwrap();
    let rows = json["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 4 * dialogue::registry::names().len());
    for row in rows {
        let ends = ["right", "wrong", "without_pick"].map(|end| row[end].as_u64().unwrap());
        assert_eq!(ends.iter().sum::<u64>(), 60, "{row}");
        let [low, mean, high] =
            ["success_low", "success", "success_high"].map(|key| row[key].as_f64().unwrap());
        assert!(low <= mean && mean <= high, "{row}");
        assert!(row["seconds"].as_f64() > row["talk_s"].as_f64(), "the arm takes time: {row}");
    }
}

/// The table of seconds is the measured costs, and measured costs are those of the configuration's
/// own key.
#[test]
fn study_prints_durations_that_can_be_the_costs() {
    let run = |more: &[&str]| -> Value {
        let words = ["--interactions", "40", "--mode", "present", "--users", "model", "--json"];
        let words = [&words[..], &["--policies", "lookahead"]].concat();
        let out = study(&[&BOWLS[..], &words, more].concat()).succeeded();
        serde_json::from_slice(&out).unwrap()
    };
    let (plain, measured) = (run(&[]), run(&["--measured-costs"]));
    let robot = run(&["--set", "dialogue.costs.from=robot"]);
    assert_eq!([&plain["costs_measured"], &measured["costs_measured"]], [false, true]);
    assert_eq!(measured["durations"], plain["durations"]);
    assert_eq!(measured, robot, "the same numbers by either way");
    assert_ne!(measured["rows"], plain["rows"]);
    let objects = plain["durations"]["objects"].as_array().unwrap();
    assert_eq!(objects.len(), 6);
    for object in objects {
        let [aim, point, pick] =
            ["aim_s", "point_s", "pick_s"].map(|key| object[key].as_f64().unwrap());
        assert!(0.5 < aim && aim + 2.0 < point && point < pick, "{object}");
    }
    let words = ["--interactions", "40", "--users", "model", "--policies", "lookahead"];
    let text = String::from_utf8(study(&[&BOWLS[..], &words].concat()).succeeded()).unwrap();
    assert!(text.contains("Questions cost what is configured"), "{text}");
    assert!(text.contains("Is it in the dishwasher?"), "{text}");
}

/// `dialogue.open_questions` and `dialogue.attribute_questions` hold as for the running robot;
/// options and presets restrict them further.
#[test]
fn study_asks_the_questions_that_the_configuration_allows() {
    let actions = |words: &[&str]| -> [bool; 2] {
        let few = ["--interactions", "1", "--policies", "lookahead", "--users", "model", "--json"];
        let out = study(&[&BOWLS[..], &few, words].concat()).succeeded();
        let json: Value = serde_json::from_slice(&out).unwrap();
        ["attribute", "which"].map(|kind| json["actions"][kind].as_bool().unwrap())
    };
    let open = ["--set", "dialogue.open_questions=true"];
    let silent = ["--set", "dialogue.attribute_questions=false"];
    let cases: [(&[&str], [bool; 2]); 5] = [
        (&[], [true, false]),
        (&open, [true, true]),
        (&[&open[..], &["--no-which"]].concat(), [true, false]),
        (&[&open[..], &silent].concat(), [false, true]),
        (&[&silent[..], &["--preset", "paper-remote"]].concat(), [true, false]),
    ];
    for (words, expected) in cases {
        assert_eq!(actions(words), expected, "{words:?}");
    }
}

#[test]
fn evaluations_of_the_publication_are_presets() {
    let present = study(&["--preset", "paper-present", "--json"]);
    let json: Value = serde_json::from_slice(&present.succeeded()).unwrap();
    assert_eq!((&json["interactions"], &json["request"]), (&3.into(), &false.into()));
    assert_eq!(json["actions"]["mode"], "present");
    assert_eq!(json["actions"]["which"], false);
    let remote = study(&["--preset", "paper-remote", "--interactions", "20", "--json"]);
    let json: Value = serde_json::from_slice(&remote.succeeded()).unwrap();
    assert_eq!(json["interactions"], 20);
    let rows = json["rows"].as_array().unwrap();
    assert!(rows.iter().any(|row| row["turn_taking"] == "naive"));
}

#[test]
fn invalid_input_is_reported_with_help() {
    let cases: [(&[&str], Exit, &str); 8] = [
        (&[], Exit::Usage, "--scene"),
        (&["--scene", "/nowhere.toml"], Exit::Storage, "/nowhere.toml"),
        (&["--policies", "oracle"], Exit::Usage, "oracle"),
        (&["--users", "robot"], Exit::Usage, "robot"),
        (&["--interactions", "0"], Exit::Usage, "--interactions"),
        (&["--threads", "0"], Exit::Usage, "--threads"),
        (&["--turns", "polite"], Exit::Usage, "open+mixture"),
        (&["--preset", "section-7"], Exit::Usage, "paper-remote"),
    ];
    for (words, exit, part) in cases {
        let named = words.first().is_none_or(|word| *word == "--scene");
        let scene = if named { &[][..] } else { &BOWLS[..] };
        study(&[scene, words].concat()).failed(exit, part);
    }
}

#[test]
fn unwritable_folder_is_reported() {
    let words = ["--interactions", "1", "--out", "/dev/null/study"];
    study(&[&BOWLS[..], &words].concat()).failed(Exit::Storage, "/dev/null/study");
}

/// Journal of a participant with one interaction under each of two policies: the first was
/// right after ten seconds, the second wrong after six.
fn journal(id: &str) -> String {
    let drawn = |step: u32| {
        format!(
            r#"{{"at":2,"event":"drawn","step":{step},"object":"white","label":"white bowl","scene":"bowls","scene_key":"00","among":["white"]}}"#
        )
    };
    let heard = r#"{"at":3,"event":"heard","seq":1,"source":"typed","onset_ms":1000.0,"accepted_ms":3000.0}"#;
    let ended = |verdict: &str, object: &str, seconds: f64| {
        format!(
            r#"{{"at":4,"event":"ended","verdict":"{verdict}","interaction":1,"object":"{object}","questions":2,"utterances":1,"seconds":{seconds},"ended_ms":9.0}}"#
        )
    };
    let begun = format!(
        r#"{{"at":1,"event":"begun","version":1,"participant":"{id}","session":"s","seed":1,"plan":[{{"policy":"lookahead","practice":false}},{{"policy":"entropy","practice":false}}],"protocol":{{"title":"Two policies","consent":"","instructions":["Ask."],"interactions":1,"warmup":0,"objects":"uniform","design":"within","policies":["lookahead","entropy"],"order":"latin","seconds_max":60.0,"show_belief":false,"keep_words":false,"questionnaire":[{{"id":"quick","text":"It was quick.","kind":"likert","points":5,"required":true}}]}},"group":"lab","software":"1"}}"#
    );
    let started = r#"{"at":2,"event":"started","after":0}"#.to_owned();
    let lines = [
        begun,
        drawn(0),
        started.clone(),
        heard.to_owned(),
        ended("right", "white", 8.0),
        drawn(1),
        started,
        heard.to_owned(),
        ended("wrong", "clear", 4.0),
        r#"{"at":5,"event":"questioned"}"#.to_owned(),
        r#"{"at":6,"event":"answered","answers":{"quick":4}}"#.to_owned(),
        r#"{"at":7,"event":"finished"}"#.to_owned(),
    ];
    lines.join("\n") + "\n"
}

#[test]
fn user_study_is_reported_from_its_files() {
    let folder = tempfile::tempdir().unwrap();
    for id in ["AAAAAA", "CCCCCC"] {
        std::fs::write(folder.path().join(format!("{id}.jsonl")), journal(id)).unwrap();
    }
    let (data, out) = (folder.path().to_str().unwrap(), folder.path().join("out"));
    let printed = study(&["report", data, "--json", "--out", out.to_str().unwrap()]).succeeded();
    let json: Value = serde_json::from_slice(&printed).unwrap();
    assert_eq!(json["participants"]["complete"], 2);
    assert_eq!(json["all"]["interactions"], 4);
    assert_eq!(json["policies"][0]["success"], 1.0);
    assert_eq!(json["paired"][0]["seconds"]["mean"], -4.0);
    let written: Vec<String> = files(&out).into_iter().map(|(name, _)| name).collect();
    for name in ["interactions.csv", "participants.csv", "dictionary.csv", "success.svg"] {
        assert!(written.iter().any(|found| found == name), "{name}: {written:?}");
    }
    let table = String::from_utf8(study(&["report", data]).succeeded()).unwrap();
    for word in ["Two policies", "2 complete", "entropy less lookahead", "It was quick."] {
        assert!(table.contains(word), "{word}: {table}");
    }
}

#[test]
fn data_that_is_missing_or_damaged_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let data = folder.path().to_str().unwrap();
    study(&["report", data]).failed(Exit::NotReached, "holds no data");
    let damaged = journal("AAAAAA").replacen("started", "stared", 1);
    std::fs::write(folder.path().join("AAAAAA.jsonl"), damaged).unwrap();
    let ended = study(&["report", data]);
    assert!(ended.error.contains("restore"), "{}", ended.error);
    ended.failed(Exit::Storage, "AAAAAA.jsonl: line 3");
}
