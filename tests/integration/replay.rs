//! Flights of real processes: recorded through kills, replayed by the services' own programs, exported.

use std::fs;
use std::path::Path;
use std::process::Command;

use grounding::shell::GroundingProgram;
use grounding::{GroundingNode, In};
use messages::{Hypothesis, Utterance};
use recording::list::summary;
use rustix::process::Signal;
use serde_json::Value;
use service::flight::{Head, Report, Ring, Tap, list};
use service::lifecycle::Environment;
use service::service_loop::Program;
use service::{Effects, Event, Never, Node, Time};
use tempfile::TempDir;
use whichone_tests::{Ended, Group, YES_NO, program, run, settings, wait_for};

const SERVICES: [&str; 4] = ["speech", "grounding", "policy", "arm"];

/// `whichone replay` of a folder, outside of any group.
fn replay(folder: &Path, words: &[&str]) -> Ended {
    let mut command = Command::new(program("whichone"));
    run(command.arg("replay").arg(folder).args(words), "", 300.0)
}

fn reports(ended: &Ended) -> Vec<Report> {
    ended.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// Flights of four dialogues, in each of which another service was killed during the fetch.
fn flights_with_kills() -> TempDir {
    let group = Group::up(&["arm.time_scale=15.0", "group.flight.free_min_mib=0", YES_NO]);
    for service in SERVICES {
        let outcome = group.fetch_while("the bowl", "clear", || {
            let before = group.incarnation(service);
            group.signal(service, Signal::KILL);
            group.wait_for_restart(service, before);
        });
        assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", group.logs());
    }
    // Copied while the services record: the ends are as a kill leaves them. What a service has just done takes a moment.
    let copy = wait_for("flights of each service, before and after its kill", 30.0, || {
        let copy = tempfile::tempdir().unwrap();
        for file in list(&group.paths().flights()).unwrap() {
            fs::copy(&file, copy.path().join(file.file_name().unwrap())).unwrap();
        }
        let reports = reports(&replay(copy.path(), &["--json"]));
        let is_whole = reports.len() == 2 * SERVICES.len();
        (is_whole && reports.iter().all(|report| report.passes > 5)).then_some(copy)
    });
    group.down();
    copy
}

#[test]
fn flights_of_killed_services_replay_exactly_and_answer_what_if() {
    let folder = flights_with_kills();
    let ended = replay(folder.path(), &["--json"]);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let reports = reports(&ended);
    for service in SERVICES {
        let own: Vec<_> = reports.iter().filter(|report| report.service == service).collect();
        assert!(own.len() == 2 && own.iter().all(|report| report.passes > 5), "{own:?}");
    }

    let what_if = ["--service", "policy", "--what-if", "dialogue.planner=never-ask"];
    let ended = replay(folder.path(), &what_if);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    for part in ["interaction 1", "recorded  ask \"", "what if   pick \"", "decisions differ"] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
    for part in ["other passes differ", "first other difference:", "recorded    ", "recomputed  "] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
    let report = &self::reports(&replay(folder.path(), &[&what_if[..], &["--json"]].concat()))[0];
    let first = report.other_difference.as_ref().unwrap();
    assert!(report.other_passes > 0 && !first.path.is_empty(), "{first:?}");
    assert_ne!(first.recorded, first.recomputed);
    let ended = replay(folder.path(), &["--what-if", "dialogue.planer=entropy"]);
    assert_eq!(ended.code, Some(78), "{ended:?}");
    assert!(ended.stderr.contains("--what-if: dialogue.planer: unknown key"), "{}", ended.stderr);
    let ended = replay(folder.path(), &["--service", "foo"]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    let expected = "help: there are flights of arm, grounding, policy, speech";
    assert!(ended.stderr.contains(expected), "{}", ended.stderr);

    let mcap = folder.path().join("flights.mcap");
    let mut export = Command::new(program("whichone"));
    export.args(["export", "mcap"]).arg(folder.path()).arg("--out").arg(&mcap);
    let ended = run(&mut export, "", 120.0);
    assert_eq!(ended.code, Some(0), "{ended:?}");
    let topics = summary(&mcap).unwrap().topics;
    let of = |direction: &str| -> u64 {
        let topic = |service| format!("/flight/{service}/{direction}");
        SERVICES.iter().map(|service| topics.get(&topic(service)).copied().unwrap_or(0)).sum()
    };
    assert_eq!(of("in"), reports.iter().map(|report| report.events).sum::<u64>());
    assert!(of("out") > 100, "{topics:?}");
}

/// A flight of grounding that read in the paper's way and claims the configured one, as a build with another
/// reader would leave it.
fn flight_of_another_reader(folder: &Path) {
    let (settings, environment) = (settings(&[]), Environment::nowhere());
    let head = Head::of::<GroundingProgram>(&environment, &settings, Time(1), 1);
    let ring = Ring { folder: folder.to_owned(), bytes_max: 1 << 30, free_min: 0 };
    let mut tap = Tap::start(ring, &head, &[] as &[Never]);
    let paper = ["--language", "paper"].map(str::to_owned).to_vec();
    let paper = Environment { arguments: paper, ..environment };
    let config = GroundingProgram::config(&paper, &settings).unwrap();
    let mut node = GroundingNode::recover(config, Vec::new()).unwrap();
    for (seq, text) in [(1, "the white bowl"), (2, "anything but the white plastic one")] {
        let mut utterance = Utterance { seq, ..Utterance::default() };
        utterance.set_hypotheses(&[Hypothesis::certain(text.to_owned())]).unwrap();
        let (event, mut effects) =
            (Event::Message(In::Utterance(utterance.into())), Effects::default());
        tap.event(&event, Time(seq * 1_000_000_000));
        node.on(event, Time(seq * 1_000_000_000), &mut effects);
        tap.stated(&effects);
        tap.end_pass();
    }
}

#[test]
fn replay_stops_at_the_first_difference_with_exit_code_70() {
    let folder = tempfile::tempdir().unwrap();
    let ended = replay(folder.path(), &[]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    assert!(ended.stderr.contains("flight.enabled"), "{}", ended.stderr);

    flight_of_another_reader(folder.path());
    let ended = replay(folder.path(), &[]);
    assert_eq!(ended.code, Some(70), "{ended:?}");
    let field = "outputs[0].Observation.readings[0]";
    for part in ["grounding-", field, "recorded ", "recomputed ", "events up to"] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
    let report = replay(folder.path(), &["--json"]).json();
    assert!(report["difference"]["before"].as_array().is_some_and(|it| !it.is_empty()), "{report}");
    assert_ne!(report["difference"]["path"], Value::Null);

    fs::write(folder.path().join("arm-0.flight"), "something else").unwrap();
    let ended = replay(folder.path(), &[]);
    assert_eq!(ended.code, Some(78), "{ended:?}");
    for part in ["arm-0.flight: expected a flight, found another file", "help: name a flight"] {
        assert!(ended.stderr.contains(part), "{}", ended.stderr);
    }
    fs::write(folder.path().join("arm-0.flight"), b"WOFLIGHT\x09\0\0\0").unwrap();
    let ended = replay(folder.path(), &[]);
    assert_eq!(ended.code, Some(78), "{ended:?}");
    assert!(ended.stderr.contains("found 9; help: replay it with the build"), "{}", ended.stderr);
}
