//! `whichone conform`: the shipped services keep the contract, and each fault is found by its rule.

use std::process::Command;
use std::thread;

use serde_json::Value as Json;
use whichone_tests::{Ended, program, run};

/// Longest test of one service, seconds.
const LONGEST_S: f64 = 240.0;

pub(crate) fn conform(service: &str, options: &[&str], command: &[&str]) -> Ended {
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/../config");
    let mut call = Command::new(program("whichone"));
    call.args(["conform", service, "--json", "--config", config, "--profile", "ci"]);
    run(call.args(options).arg("--").args(command), "", LONGEST_S)
}

/// The result of each rule.
fn rules(ended: &Ended) -> Vec<Json> {
    ended.json()["rules"].as_array().unwrap_or_else(|| panic!("{ended:?}")).clone()
}

#[test]
fn shipped_services_keep_the_contract() {
    thread::scope(|scope| {
        let test = |service: &'static str| {
            move || {
                let ended = conform(service, &[], &[&format!("whichone-{service}")]);
                assert_eq!(ended.code, Some(0), "{service}: {ended:#?}");
                rules(&ended).len()
            }
        };
        let others = ["speech", "policy", "arm", "console", "recorder"];
        let others = others.map(|service| scope.spawn(test(service)));
        assert_eq!(test("grounding")(), 15, "the rules for a grounder");
        others.into_iter().for_each(|one| assert_eq!(one.join().unwrap(), 8));
    });
}

/// Faults of the grounder `broken_grounder`, the rule that finds each, and a part of what is reported.
const FAULTS: [(&str, &str, &str); 23] = [
    ("never-ready", "ready", "expected READY=1 within 1.0 s"),
    ("exits-at-once", "ready", "found its end: exit 3"),
    ("is-without-beats", "beats", "expected WATCHDOG=1 at least every 3 s, found none"),
    ("forgets-its-epoch", "identity", "expected messages of epoch 7, found 8"),
    ("forgets-its-incarnation", "identity", "expected messages of incarnation 1, found 77"),
    ("speaks-for-users", "topics", "speech/audio, a topic of clients"),
    ("dies-when-restarted", "restart", "found its end: exit 4"),
    ("is-silent", "answers", "found none with its `seq`"),
    ("renumbers", "answers", "found none with its `seq`"),
    ("drops-fields", "answers", "expected the utterance's asked"),
    ("mistakes-the-scene", "answers", "found 0000000000000001"),
    ("invents-codes", "answers", "with invalid codes"),
    ("invents-words", "answers", "invalid readings: invalid word 999"),
    ("halves-weights", "answers", "sum to 1, found 0.5"),
    ("ignores-questions", "answers", "expected weights for question 0"),
    ("changes-its-mind", "repeats", "expected the same observation again"),
    ("answers-the-latest", "burst", "expected 16 observations"),
    ("trusts-its-input", "nonsense", "after an utterance with 200 hypotheses"),
    ("believes-any-epoch", "foreign", "expected no answer to an utterance of epoch 8"),
    ("is-slow", "latency", "expected answers within 1.0 s"),
    ("ignores-requests-to-end", "stop", "found it running"),
    ("fails-at-its-end", "stop", "expected exit 0 after SIGTERM, found exit 1"),
    ("survives-its-supervisor", "orphan", "found it running"),
];

#[test]
fn each_fault_of_a_grounder_is_found_by_its_rule() {
    let broken = program("examples/broken_grounder").display().to_string();
    let test = |(fault, rule, what): (&str, &str, &str)| {
        let options = [
            ["--rule", rule],
            ["--set", "group.services.grounding.start_deadline_s=10.0"],
            ["--set", "group.services.grounding.stop_deadline_s=2.0"],
        ];
        let quick = ["--set", "group.services.grounding.start_deadline_s=1.0"];
        let options = options.into_iter().chain((fault == "never-ready").then_some(quick));
        let options: Vec<&str> = options.flatten().collect();
        let ended = conform("grounding", &options, &[&broken, "--fault", fault]);
        assert_eq!(ended.code, Some(1), "{fault}: {ended:#?}");
        let [result] = &rules(&ended)[..] else { panic!("{fault}: {ended:#?}") };
        let found = result["found"].as_str().unwrap();
        assert!(result["ok"] == false && found.contains(what), "{fault}: {found}");
        assert!(!result["help"].as_str().unwrap().is_empty(), "{fault}");
    };
    let faults: Vec<_> = FAULTS.to_vec();
    // Most of them wait for something that does not come.
    thread::scope(|scope| {
        for some in faults.chunks(faults.len().div_ceil(6)) {
            scope.spawn(move || some.iter().for_each(|fault| test(*fault)));
        }
    });
}

#[test]
fn service_that_does_not_become_ready_is_started_once() {
    let broken = program("examples/broken_grounder").display().to_string();
    let soon = ["--set", "group.services.grounding.start_deadline_s=1.0"];
    let ended = conform("grounding", &soon, &[&broken, "--fault", "never-ready"]);
    let found: Vec<_> = rules(&ended).iter().map(|rule| rule["found"].to_string()).collect();
    let [first, others @ ..] = &found[..] else { panic!("{ended:?}") };
    assert!(first.contains("expected READY=1"), "{found:?}");
    assert!(others.iter().all(|other| other.contains("not tested")), "{found:?}");
}

#[test]
fn wrong_command_lines_of_conform_are_refused() {
    for (options, command, what) in [
        (&["--rule", "beat"][..], "whichone-grounding", "did you mean `beats`?"),
        (&[], "/no/such/program", "/no/such/program"),
    ] {
        let ended = conform("grounding", options, &[command]);
        assert_eq!(ended.code, Some(64), "{ended:?}");
        assert!(ended.stderr.contains(what), "{ended:?}");
    }
}
