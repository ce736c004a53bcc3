//! The example of the SDK: built outside the workspace, and its programs in a group.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use whichone_tests::{Group, program, run, wait_for};

use crate::swap::swap;

/// Longest build of the example, seconds: from nothing, on a busy machine.
const BUILD_S: f64 = 900.0;

/// Builds the example in its own workspace, with the dependencies that this build has fetched; returns the folder of
/// its programs.
fn built() -> PathBuf {
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/examples/rust");
    let whichone = program("whichone");
    let target = whichone.ancestors().nth(2).expect("the build's folder").join("external");
    let mut build = Command::new(env!("CARGO"));
    build.args(["build", "--offline", "--locked", "--quiet", "--manifest-path"]);
    build.arg(example.join("Cargo.toml")).arg("--target-dir").arg(&target);
    let ended = run(&mut build, "", BUILD_S);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    target.join("debug")
}

#[test]
fn programs_of_another_workspace_take_part_in_a_group() {
    let programs = built();
    let path = |name: &str| programs.join(name).display().to_string();
    let command = format!("group.services.favourite.command=[{:?}]", path("favourite"));
    let group = Group::up(&[
        &command,
        "group.services.favourite.reads=[\"policy/view\"]",
        "group.services.favourite.writes=[\"favourite/latest\"]",
    ]);
    assert_eq!(group.service("favourite")["actual"], "ready", "a service of a new kind");
    assert_eq!(swap(&group, "grounding", &[&path("spotter")]).code, Some(0), "{}", group.logs());
    let mut errand = Command::new(path("errand"));
    errand.args(["get me the bowl", "clear"]);
    errand.env("WHICHONE_HOME", group.paths().home());
    errand.env("WHICHONE_GROUP", group.paths().name().as_str());
    let ended = run(&mut errand, "", 120.0);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    assert!(ended.stdout.ends_with("Delivered clear\n"), "{ended:?}");
    assert!(ended.stdout.contains("robot Is") || ended.stdout.contains('?'), "{ended:?}");
    assert!(ended.stdout.contains("(clear "), "the new topic: {ended:?}");
    for service in ["grounding", "favourite"] {
        let before = group.incarnation(service);
        group.signal(service, rustix::process::Signal::KILL);
        group.wait_for_restart(service, before);
    }
    assert_eq!(group.fetch("the white bowl", "white2")["object"], "white2", "{}", group.logs());
    group.verify_journals();
    group.down();
}

/// Words that open an interaction, and the object that the user wants.
const REQUESTS: [(&str, &str); 5] = [
    ("get me the bowl", "metal2"),
    ("the white bowl", "white3"),
    ("a metal one please", "metal2"),
    ("bring me the clear bowl", "clear"),
    ("the bowl on the counter", "white2"),
];

#[test]
#[ignore = "takes minutes: 400 dialogues"]
fn dialogues_with_the_external_grounder_end_as_with_the_built_in_one() {
    let spotter = built().join("spotter").display().to_string();
    let count =
        std::env::var("WHICHONE_DIALOGUES").ok().and_then(|n| n.parse().ok()).unwrap_or(200);
    let outcomes = |command: Option<&str>| {
        let group = Group::up_in_memory(&[]);
        if let Some(command) = command {
            assert_eq!(swap(&group, "grounding", &[command]).code, Some(0), "{}", group.logs());
        }
        let fetch = |n: usize| {
            let (text, object) = REQUESTS[n % REQUESTS.len()];
            let ended = group.fetch(text, object);
            (ended["object"].clone(), ended["outcome"].clone())
        };
        let outcomes: Vec<_> = (0..count).map(fetch).collect();
        group.verify_journals();
        group.down();
        outcomes
    };
    assert_eq!(outcomes(Some(&spotter)), outcomes(None));
}

#[test]
#[ignore = "takes minutes: 50 swaps under traffic"]
fn fifty_swaps_under_traffic_lose_nothing() {
    let spotter = built().join("spotter").display().to_string();
    let built_in = program("whichone-grounding").display().to_string();
    let group = Group::up_in_memory(&[]);
    let swaps = std::sync::atomic::AtomicUsize::new(0);
    let done = || swaps.load(std::sync::atomic::Ordering::Relaxed) >= 50;
    std::thread::scope(|scope| {
        let talk = scope.spawn(|| {
            let mut talks = 0;
            while !done() {
                let (text, object) = REQUESTS[talks % REQUESTS.len()];
                let ended = group.fetch(text, object);
                assert_eq!(ended["object"], object, "{text}: {ended}\n{}", group.logs());
                talks += 1;
            }
            talks
        });
        while !done() && !talk.is_finished() {
            let number = swaps.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
            let command = if number.is_multiple_of(2) { &spotter } else { &built_in };
            let ended = swap(&group, "grounding", &[command]);
            assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
            std::thread::sleep(Duration::from_millis(200));
        }
        assert!(talk.join().expect("every dialogue ends as wanted") > 0);
    });
    wait_for("a quiet group", 30.0, || (group.dialogue()["interaction"] == 0).then_some(()));
    group.verify_journals();
    group.down();
}
