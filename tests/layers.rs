//! Layers of the workspace: what a crate may depend on, by `cargo tree`.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::Command;

const SERVICES: [&str; 12] = [
    "speech",
    "grounding",
    "policy",
    "arm",
    "baxter",
    "ros1",
    "ros2",
    "link",
    "console",
    "recorder",
    "supervisor",
    "whichone",
];

/// Everything that `package` is built from, itself included, down to this depth.
fn tree(package: &str, depth: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none"])
        .args(["--package", package, "--depth", depth])
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines = String::from_utf8(output.stdout).unwrap();
    lines.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn grounding_links_neither_kinematics_nor_charts() {
    let tree = tree("grounding", "99");
    assert!(tree.contains("language"), "{tree:?}");
    for absent in [
        "manipulation",
        "robot_model",
        "preflight",
        "rsruckig",
        "nalgebra",
        "evaluation",
        "plotters",
    ] {
        assert!(!tree.contains(absent), "grounding depends on {absent}");
    }
}

#[test]
fn messages_depend_on_no_configuration() {
    let tree = tree("messages", "99");
    assert!(tree.contains("dialogue") && !tree.contains("config"), "{tree:?}");
}

/// What a program from outside is built on has neither configuration nor journal, and no shell of a service.
#[test]
fn sdk_links_little() {
    let tree = tree("whichone-sdk", "99");
    assert!(tree.contains("runtime") && tree.contains("messages"), "{tree:?}");
    let heavy =
        ["service", "config", "journal", "language", "tracing-subscriber", "flate2", "tokio"];
    for absent in heavy {
        assert!(!tree.contains(absent), "whichone-sdk depends on {absent}");
    }
}

#[test]
fn no_service_depends_on_a_service() {
    for service in SERVICES.into_iter().filter(|service| *service != "whichone") {
        let direct = tree(service, "1");
        let found = SERVICES.iter().filter(|other| **other != service && direct.contains(**other));
        assert_eq!(found.count(), 0, "{service}: {direct:?}");
    }
}

/// The program `whichone` contains the services, its library knows none.
#[test]
fn command_line_uses_no_service() {
    // The others are also names of verbs.
    let crates =
        ["speech", "grounding", "policy", "baxter", "ros1", "ros2", "recorder", "supervisor"];
    let mut folders =
        vec![PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../services/whichone/src"))];
    let mut read = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            if path.extension().is_none_or(|ending| ending != "rs") || path.ends_with("hosted.rs") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            let of_service = |line: &str| {
                let name = line.trim().strip_prefix("use ").and_then(|rest| rest.split_once("::"));
                name.is_some_and(|(name, _)| crates.contains(&name))
            };
            let found: Vec<&str> = text.lines().filter(|line| of_service(line)).collect();
            assert!(found.is_empty(), "{}: {found:?}", path.display());
            read += 1;
        }
    }
    assert!(read > 50, "{read} files");
}
