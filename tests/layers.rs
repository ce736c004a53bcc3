//! Layers of the workspace: what a crate may depend on, by `cargo metadata`.

#![allow(clippy::unwrap_used, reason = "tests")]

use std::collections::{BTreeSet, HashMap};
use std::process::Command;

use serde_json::Value as Json;

const SERVICES: [&str; 8] =
    ["speech", "grounding", "policy", "arm", "baxter", "console", "supervisor", "whichone"];

/// Names of the packages that each package depends on in a normal build.
fn dependencies() -> HashMap<String, BTreeSet<String>> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version=1", "--offline", "--locked"])
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Json = serde_json::from_slice(&output.stdout).unwrap();
    let names: HashMap<&str, &str> = (metadata["packages"].as_array().unwrap().iter())
        .map(|package| (package["id"].as_str().unwrap(), package["name"].as_str().unwrap()))
        .collect();
    let is_normal = |dependency: &&Json| {
        dependency["dep_kinds"].as_array().unwrap().iter().any(|kind| kind["kind"].is_null())
    };
    let of = |node: &Json| {
        let dependencies = node["deps"].as_array().unwrap().iter().filter(is_normal);
        let names = dependencies.map(|one| names[one["pkg"].as_str().unwrap()].to_owned());
        (node["id"].as_str().unwrap().to_owned(), names.collect())
    };
    let by_id = metadata["resolve"]["nodes"].as_array().unwrap().iter().map(of);
    by_id.map(|(id, found)| (names[id.as_str()].to_owned(), found)).collect()
}

/// Everything that `package` is built from.
fn tree(package: &str) -> BTreeSet<String> {
    let direct = dependencies();
    let (mut found, mut open) = (BTreeSet::new(), vec![package.to_owned()]);
    while let Some(next) = open.pop() {
        for dependency in direct.get(&next).into_iter().flatten() {
            if found.insert(dependency.clone()) {
                open.push(dependency.clone());
            }
        }
    }
    found
}

#[test]
fn grounding_links_neither_kinematics_nor_charts() {
    let tree = tree("grounding");
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
    let tree = tree("messages");
    assert!(tree.contains("dialogue") && !tree.contains("config"), "{tree:?}");
}

#[test]
fn no_service_depends_on_a_service() {
    let direct = dependencies();
    for service in SERVICES {
        let found: Vec<_> =
            SERVICES.iter().filter(|other| direct[service].contains(**other)).collect();
        assert!(found.is_empty(), "{service} depends on {found:?}");
    }
}
