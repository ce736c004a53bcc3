//! `whichone export pomdp`: its text is the problem that `plan` solves.

use std::process::Command;
use whichone_tests::{Ended, program, run};

const ROOT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
const BOWLS: &str = "config/scenes/bowls.toml";

fn export(words: &[&str]) -> Ended {
    let mut command = Command::new(program("whichone"));
    run(command.args(["export", "pomdp"]).args(words).current_dir(ROOT), "", 60.0)
}

/// Words of the line of the exported text that has this key.
fn exported(key: &str, words: &[&str]) -> Vec<String> {
    let ended = export(words);
    assert_eq!(ended.code, Some(0), "{words:?}: {}", ended.stderr);
    let mut lines = ended.stdout.lines();
    let found = lines.find_map(|line| line.strip_prefix(key)?.strip_prefix(": "));
    let found = found.unwrap_or_else(|| panic!("{key}: {}", ended.stdout));
    found.split(' ').map(str::to_owned).collect()
}

#[test]
fn every_scene_is_exported_with_the_options_of_plan() {
    for (scene, objects) in [("bowls", 6), ("markers", 2), ("tools", 10)] {
        assert_eq!(exported("states", &[scene]).len(), objects + 1, "{scene}");
    }
    let actions = |words: &[&str]| exported("actions", &[&[BOWLS], words].concat()).len();
    assert_eq!(actions(&[]), 1 + 5 + 11 + 6);
    assert_eq!(actions(&["--no-which"]), 1 + 11 + 6);
    assert_eq!(actions(&["--no-attr", "--mode", "present"]), 1 + 5 + 6 + 6);
    assert_eq!(actions(&["--no-attr", "--no-which"]), 1 + 6);
    assert_eq!(exported("discount", &[BOWLS, "--costs", "predecessor"]), ["0.9"]);
    assert_eq!(exported("discount", &[BOWLS, "--set", "dialogue.costs.discount=0.5"]), ["0.5"]);
    assert_eq!(exported("states", &["tests/fixtures/scenes/tools.json"]).len(), 11);
}

#[test]
fn export_to_a_file_equals_the_printed_text() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bowls.pomdp").display().to_string();
    let ended = export(&[BOWLS, "--output", &file]);
    assert_eq!(ended.code, Some(0), "{}", ended.stderr);
    assert!(ended.stdout.contains("7 states, 23 actions, 14 observations"), "{}", ended.stdout);
    let written = std::fs::read_to_string(&file).unwrap();
    assert_eq!(written, export(&[BOWLS]).stdout);
    let json = export(&[BOWLS, "--json"]).json();
    assert_eq!((&json["pomdp"], &json["states"]), (&written.into(), &7.into()));
    let json = export(&[BOWLS, "--json", "--output", &file]).json();
    assert_eq!((&json["file"], json.get("pomdp")), (&file.into(), None));
}

#[test]
fn export_reports_unsupported_problems() {
    for (words, code, part) in [
        (&["no/such/scene.toml"][..], 74, "no/such/scene.toml"),
        (&["teapots"], 78, "teapots"),
        (&["Cargo.toml"], 78, "Cargo.toml"),
        (&[BOWLS, "--costs", "free"], 64, "free"),
        (&[BOWLS, "--set", "dialogue.p_l=2"], 78, "p_l"),
        (&[BOWLS, "--output", "no/such/folder/file"], 74, "no/such/folder/file"),
        (&[], 64, "SCENE"),
    ] {
        let ended = export(words);
        assert_eq!(ended.code, Some(code), "{words:?}: {ended:?}");
        assert!(ended.stderr.contains(part), "{words:?}: {}", ended.stderr);
    }
}
