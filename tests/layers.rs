//! Layers of the workspace: what a crate may depend on, by `cargo tree`.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::BTreeSet;
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
    for service in SERVICES {
        let direct = tree(service, "1");
        let found = SERVICES.iter().filter(|other| **other != service && direct.contains(**other));
        assert_eq!(found.count(), 0, "{service}: {direct:?}");
    }
}
