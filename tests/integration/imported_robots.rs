//! Published descriptions that become groups which fetch: import, check, up, dialogue, delivered.

use std::path::Path;

use whichone_tests::{Group, settings_of};

/// Imports a robot into a configuration of its own, and has a block fetched in a dialogue.
fn delivers(file: &str, name: &str) {
    let robots = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/robot_import/tests/robots");
    let (file, folder) = (robots.join(file).display().to_string(), tempfile::tempdir().unwrap());
    let config = folder.path().join("config");
    let written = config.display().to_string();
    let mut group = Group::with_config(config.clone());
    let imported = group
        .must(&["robot", "import", &file, "--name", name, "--config", &written, "--json"])
        .json();
    assert_eq!(imported["problems"].as_array().map(Vec::len), Some(0), "{imported}");
    group.must(&["check", "--config", &written, "--profile", name]);
    let again = group.call(&["robot", "import", &file, "--name", name, "--config", &written]);
    assert_eq!(again.code, Some(64), "an existing file is not replaced: {again:?}");
    let settings = settings_of(&config.join("profiles").join(name).with_extension("toml"));
    let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
    let ended = group.start(&settings);
    assert_eq!(ended.code, Some(0), "{ended:?}\n{}", group.logs());
    let outcome = group.fetch("get me a block", "blue_large");
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &"blue_large".into()), "{outcome}\n{}", group.logs());
    group.verify_journals();
    group.down();
}

#[test]
fn imported_panda_delivers() {
    delivers("panda/panda.urdf", "panda");
}

#[test]
fn imported_xarm7_without_a_gripper_delivers() {
    delivers("xarm7/xarm7.urdf", "xarm7");
}

/// Five joints, and one jaw that turns.
#[test]
fn imported_so101_delivers() {
    delivers("so101/so101.urdf", "own101");
}

/// Lifts, continuous joints and linkages, and more arms of five joints: see `only_nightly`.
#[test]
fn other_imported_robots_deliver() {
    for (file, name) in [
        ("fetch.urdf", "fetch"),
        ("jaco.urdf", "jaco"),
        ("xarm6_with_gripper.urdf", "xarm6"),
        ("ur5.urdf", "ur5"),
        ("iiwa7.urdf", "iiwa7"),
        ("so100.urdf", "so100"),
        ("widowx.urdf", "widowx"),
    ] {
        delivers(file, name);
    }
}
