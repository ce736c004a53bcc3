//! The recorder in a real group, and its files as the libraries of others read them.

use recording::list::{Entry, State, entries, summary};
use rustix::process::Signal;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::{SystemTime, UNIX_EPOCH};
use whichone_tests::{DIALOGUE_CHANNELS, Group, run, wait_for};

/// Real time enough for four to ten looks a second to see each change, and no demand on the disk.
const SETTINGS: [&str; 2] = ["arm.time_scale=10.0", "group.recorder.free_min_mib=0"];

fn recorded_group() -> Group {
    let group = Group::up(&SETTINGS);
    wait_until_recording(&group);
    group
}

fn wait_until_recording(group: &Group) {
    wait_for("a recording", 20.0, || {
        (group.service("recorder")["actual"] == "ready" && !recordings(group).is_empty())
            .then_some(())
    });
}

fn recordings(group: &Group) -> Vec<Entry> {
    entries(&group.paths().recordings())
}

/// Messages of a topic in a recording that is finished or not.
fn count(entry: &Entry, topic: &str) -> u64 {
    summary(&entry.path).ok().and_then(|it| it.topics.get(topic).copied()).unwrap_or(0)
}

fn wall_ns() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_nanos() as u64
}

/// What Python's libraries find in the files.
fn read_by_others(files: &[PathBuf]) -> Value {
    let python =
        std::env::var("WHICHONE_RECORDING_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let program = concat!(env!("CARGO_MANIFEST_DIR"), "/recording/read.py");
    let ended = run(Command::new(python).arg(program).args(files), "", 120.0);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    ended.json()
}

/// A journal's records.
fn journal(group: &Group, service: &str) -> Vec<Value> {
    let listed = group.must(&["journal", service, "--json"]).stdout;
    listed.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

#[test]
#[ignore = "needs python3 with mcap, mcap-ros2-support, mcap-protobuf-support, jsonschema, foxglove-sdk"]
fn recorded_dialogue_is_read_by_the_libraries_of_others() {
    let group = recorded_group();
    assert_eq!(group.fetch("get me the bowl", "white2")["object"], "white2");
    // It writes its log.
    group.must(&["restart", "grounding"]);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.must(&["record", "stop"]);
    let status = group.call(&["status"]);
    assert_eq!(status.code, Some(0), "the group is whole without it: {status:?}");
    let files: Vec<PathBuf> = recordings(&group).into_iter().map(|entry| entry.path).collect();
    let found = read_by_others(&files);
    let topics = found["topics"].as_object().unwrap();
    for topic in DIALOGUE_CHANNELS.into_iter().chain(["/log"]) {
        assert!(topics.get(topic).is_some_and(|it| it["count"].as_u64() > Some(0)), "{topic}");
    }
    // Every message that a service has sent since, by its own count.
    for (name, topic) in topics {
        assert_eq!(topic["lost"], 0, "{name}: {topic}\n{}", group.logs());
    }
    assert!(!topics.contains_key("/speech/audio") && !topics.contains_key("/sound"));
    let messages = |topic: &str| found["messages"][topic].as_array().unwrap();
    let numbers = |of: &[Value], key: &str| -> BTreeSet<u64> {
        of.iter().filter_map(|it| it[key].as_u64()).filter(|number| *number > 0).collect()
    };
    let accepted = journal(&group, "speech");
    let accepted: Vec<Value> = accepted
        .iter()
        .map(|line| line["record"].clone())
        .filter(|record| record["type"] == "accepted")
        .collect();
    assert_eq!(numbers(messages("/speech/receipt"), "seq"), numbers(&accepted, "utterance"));
    let acts: Vec<Value> =
        journal(&group, "policy").iter().map(|line| line["record"]["decision"].clone()).collect();
    let recorded = numbers(messages("/policy/act"), "act");
    let journaled = numbers(&acts, "act");
    assert!(!recorded.is_empty());
    assert_eq!(recorded, journaled, "every act, and no other");
    let delivered =
        messages("/policy/view").iter().rev().find_map(|it| it["last"]["name"].as_str());
    assert_eq!(delivered, Some("clear"));
    let numbers = |belief: &Value| -> Option<Vec<f64>> {
        belief.as_array()?.iter().map(Value::as_f64).collect()
    };
    let beliefs: Vec<Vec<f64>> =
        messages("/policy/view").iter().filter_map(|view| numbers(&view["belief"])).collect();
    let mut compared = 0;
    for line in journal(&group, "policy") {
        let belief = line["record"]["belief"].as_object().unwrap();
        if belief.is_empty() {
            continue;
        }
        let belief: Vec<f64> = belief.values().filter_map(Value::as_f64).collect();
        let is_equal = |other: &Vec<f64>| {
            let pairs = belief.iter().zip(other);
            other.len() == belief.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-9)
        };
        assert!(beliefs.iter().any(is_equal), "{belief:?} is not among {beliefs:?}");
        compared += 1;
    }
    assert!(compared > 2, "{compared} beliefs");
    let said = messages("/dialogue");
    assert_eq!(
        (&said[0]["name"], &said[0]["message"]),
        (&"user".into(), &"get me the bowl".into())
    );
    assert!(said.iter().any(|line| line["name"] == "robot"));
    for name in ["settings.toml", "scene.toml", "robot.urdf", "robot.srdf"] {
        assert!(found["attachments"][name].as_u64() > Some(100), "{name}");
    }
    assert_eq!(found["metadata"]["group"], group.paths().name().as_str());
    let span_s =
        (found["span"][1].as_u64().unwrap() - found["span"][0].as_u64().unwrap()) / 1_000_000_000;
    assert!(span_s < 300, "wall times of this run: {span_s} s");
    exports(&group, &files, topics);
    group.must(&["record", "start"]);
    wait_until_recording(&group);
    group.down();
}

/// One file of all recordings, and one of the journals.
fn exports(group: &Group, files: &[PathBuf], topics: &serde_json::Map<String, Value>) {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name).display().to_string();
    let recordings = group.paths().recordings().display().to_string();
    group.must(&["export", "mcap", &recordings, "--out", &out("all.mcap")]);
    let all = read_by_others(&[folder.path().join("all.mcap")]);
    for (name, topic) in topics {
        assert_eq!(all["topics"][name]["count"], topic["count"], "{name}");
    }
    assert_eq!(files.len(), entries(&group.paths().recordings()).len());
    let journals = group.paths().journal().display().to_string();
    group.must(&["export", "mcap", &journals, "--out", &out("journals.mcap")]);
    let found = read_by_others(&[folder.path().join("journals.mcap")]);
    let records: usize =
        ["speech", "policy", "arm"].iter().map(|service| journal(group, service).len()).sum();
    assert_eq!(found["topics"]["/log"]["count"], records);
    group.must(&["export", "trace", &journals, "--out", &out("trace.json")]);
    check_trace(&fs::read(folder.path().join("trace.json")).unwrap());
    // A recording and its journals agree about the time.
    let ends = [&all, &found].map(|it| it["span"][1].as_u64().unwrap());
    assert!(ends[0].abs_diff(ends[1]) < 120_000_000_000, "{ends:?}");
}

/// Each utterance leads to the decision about it, and on to what is said or moved, at later times.
fn check_trace(json: &[u8]) {
    let trace: Value = serde_json::from_slice(json).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    let of = |kind: &'static str| events.iter().filter(move |it| it["ph"] == kind);
    let heard = of("X").filter(|it| it["cat"] == "heard").count();
    assert!(heard > 1, "{trace}");
    for begin in of("s") {
        let end = of("f").find(|it| it["id"] == begin["id"]).unwrap();
        assert!(begin["ts"].as_f64() <= end["ts"].as_f64(), "{begin} {end}");
    }
    assert_eq!(of("s").count(), heard, "{trace}");
    let moved = of("X").filter(|it| it["cat"] == "moved");
    assert!(moved.into_iter().any(|it| it["dur"].as_f64() > Some(1e5)), "{trace}");
}

#[test]
fn killed_recorder_leaves_a_file_that_is_completed_at_its_next_start() {
    let group = recorded_group();
    group.say("the clear bowl");
    let torn = wait_for("the utterance in the file", 20.0, || {
        recordings(&group).into_iter().find(|entry| count(entry, "/speech/receipt") > 0)
    });
    assert_eq!(torn.state(), State::BeingWritten);
    let (before, killed) = (group.incarnation("recorder"), wall_ns());
    group.signal("recorder", Signal::KILL);
    let status = group.call(&["status"]);
    assert_eq!(status.code, Some(0), "an observer degrades nothing: {status:?}");
    group.wait_for_restart("recorder", before);
    let whole = wait_for("the completed file", 20.0, || {
        recordings(&group)
            .into_iter()
            .find(|entry| entry.began_ns == torn.began_ns && entry.state() == State::Complete)
    });
    assert!(count(&whole, "/speech/receipt") > 0 && count(&whole, "/speech/utterance") > 0);
    let end = summary(&whole.path).unwrap().span_ns.1;
    let lost_s = killed.saturating_sub(end) as f64 / 1e9;
    // A second by its own clock; the rest is what a busy machine takes.
    assert!(lost_s < 3.0, "{lost_s} s lost");
    assert_eq!(group.await_pick(None)["object"], "clear");
    group.down();
}

#[test]
fn group_is_whole_without_its_recorder() {
    let group = Group::up(&SETTINGS);
    group.must(&["hold", "recorder"]);
    assert_eq!(group.status()["state"], "ready");
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.must(&["release", "recorder"]);
    wait_until_recording(&group);
    let folder = tempfile::tempdir().unwrap();
    let copy = folder.path().join("copy.mcap");
    let path = copy.display().to_string();
    wait_for("something in the copy", 20.0, || {
        let _ = std::fs::remove_file(&copy);
        group.must(&["record", "open", "--out", &path]);
        (summary(&copy).unwrap().messages > 0).then_some(())
    });
    group.must(&["record", "stop"]);
    let listed = group.must(&["record", "list", "--json"]).stdout;
    let listed: Vec<Value> =
        listed.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(listed.iter().all(|it| it["state"] == "complete"), "{listed:?}");
    let newest = listed.last().unwrap();
    let opened = group.must(&["record", "open", "--json"]).json();
    assert_eq!(opened["file"], newest["file"]);
    // The group's recordings, where no source is named.
    let day = folder.path().join("day.mcap").display().to_string();
    let exported = group.must(&["export", "mcap", "--out", &day, "--json"]).json();
    assert!(exported["messages"].as_u64() > Some(0), "{exported}");
    let again = group.call(&["export", "mcap", "--out", &day]);
    assert_eq!(again.code, Some(74), "{again:?}");
    let expected = format!("{day}: it exists already; help: name another file");
    assert!(again.stderr.contains(&expected), "{again:?}");
    group.down();
}
