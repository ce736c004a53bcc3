//! Layers of the workspace: what a crate may depend on, by `cargo tree`.

#![allow(clippy::unwrap_used, reason = "tests")]

mod measures;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names of the services' crates.
fn services() -> Vec<String> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../services");
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

/// Everything that `package` is built from, itself included, down to this depth.
fn tree(package: &str, depth: &str) -> BTreeSet<String> {
    tree_in("", &["--package", package, "--depth", depth])
}

fn tree_in(workspace: &str, options: &[&str]) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none"])
        .args(options)
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(workspace))
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
    assert!(tree.contains("vocabulary") && !tree.contains("config"), "{tree:?}");
}

/// Almost every crate depends on it.
#[test]
fn vocabulary_knows_scenes_alone() {
    let direct = tree("vocabulary", "1");
    assert_eq!(direct, ["vocabulary", "scene", "serde"].map(str::to_owned).into());
}

/// Everything in the workspace that is built from `package`, with every feature that is shipped, itself excluded.
fn dependents(package: &str) -> BTreeSet<String> {
    let output = Command::new(env!("CARGO"))
        .args(["tree", "--offline", "--locked", "--edges", "normal", "--prefix", "none"])
        .args(["--workspace", "--features", "ros2/dds,link/zenoh,grounding/tls"])
        .args(["--invert", package])
        .current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let lines = String::from_utf8(output.stdout).unwrap();
    let names = lines.lines().filter_map(|line| line.split(' ').next());
    names.filter(|name| !name.is_empty() && *name != package).map(str::to_owned).collect()
}

/// What decides, or renders what was decided: all that a change of a planner rebuilds. What others share with them is in
/// `vocabulary`.
#[test]
fn few_crates_depend_on_the_dialogue() {
    let allowed = [
        "demo",
        "evaluation",
        "laboratory",
        "planner_program",
        "policy",
        "setup",
        "speech",
        "whichone",
        "whichone-tests",
    ];
    assert_eq!(dependents("dialogue"), allowed.map(str::to_owned).into());
}

/// What reads utterances: all that a change of the reader rebuilds. Its words and their sounds are in `words`.
#[test]
fn few_crates_depend_on_the_language() {
    let allowed = [
        "console",
        "demo",
        "evaluation",
        "grounding",
        "laboratory",
        "reader_training",
        "speech",
        "whichone",
        "whichone-tests",
    ];
    assert_eq!(dependents("language"), allowed.map(str::to_owned).into());
}

/// Engines of speech are replaceable: one service uses them, and they know nothing of what decides.
#[test]
fn speech_alone_uses_its_engines() {
    let allowed = ["speech", "whichone", "whichone-tests"];
    assert_eq!(dependents("speech_engines"), allowed.map(str::to_owned).into());
    let tree = tree("speech_engines", "99");
    for absent in ["service", "config", "journal", "dialogue", "language", "words"] {
        assert!(!tree.contains(absent), "speech_engines depends on {absent}");
    }
}

/// What is for evaluation and development: who else depends on it is rebuilt with it.
#[test]
fn laboratory_is_at_the_rim() {
    let programs = ["whichone", "whichone-tests"].map(str::to_owned);
    assert_eq!(dependents("laboratory"), programs.clone().into());
    let with_page = programs.into_iter().chain(["console".to_owned()]);
    let with_page: BTreeSet<String> = with_page.collect();
    for part in ["page_study", "page_history", "page_scenes", "group_metrics", "http_api"] {
        assert_eq!(dependents(part), with_page, "{part}");
    }
    let with_interface = with_page.into_iter().chain(["http_api".to_owned()]);
    assert_eq!(dependents("discovery"), with_interface.collect());
}

/// What a program from outside is built on has neither configuration nor journal, and no shell of a service.
#[test]
fn sdk_links_little() {
    let tree = tree("whichone-sdk", "99");
    assert!(tree.contains("runtime") && tree.contains("messages"), "{tree:?}");
    let heavy = [
        "service",
        "config",
        "journal",
        "dialogue",
        "language",
        "tracing-subscriber",
        "flate2",
        "tokio",
    ];
    for absent in heavy {
        assert!(!tree.contains(absent), "whichone-sdk depends on {absent}");
    }
}

/// The demo is built for pages, which have neither files nor processes, and nothing is built on it.
#[test]
fn demo_needs_no_operating_system() {
    let tree = tree("demo", "99");
    assert!(tree.contains("dialogue") && tree.contains("language"), "{tree:?}");
    for absent in ["messages", "config", "safe_files", "runtime", "service", "libc", "rustix"] {
        assert!(!tree.contains(absent), "demo depends on {absent}");
    }
    assert_eq!(dependents("demo"), BTreeSet::new());
}

#[test]
fn lock_file_of_the_example_is_up_to_date() {
    let tree = tree_in("docs/examples/rust", &[]);
    assert!(tree.contains("lab") && tree.contains("whichone-sdk"), "{tree:?}");
}

#[test]
fn no_service_depends_on_a_service() {
    let services: BTreeSet<String> = services().into_iter().collect();
    assert!(services.len() > 10, "{services:?}");
    for service in services.iter().filter(|service| *service != "whichone") {
        let mut found = &tree(service, "99") & &services;
        found.remove(service);
        assert_eq!(found, BTreeSet::new(), "{service}");
    }
}

/// The program `whichone` contains the services, its library knows none.
#[test]
fn command_line_uses_no_service() {
    // These are also names of verbs, or of what is in the room.
    let verbs = ["arm", "console", "gateway", "link", "whichone"];
    let crates = services().into_iter().filter(|name| !verbs.contains(&&**name));
    let crates: Vec<String> = crates.chain(["parts".to_owned()]).collect();
    let top = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut folders: Vec<PathBuf> =
        ["services/whichone/src", "shared/command_line/src", "shared/laboratory/src"]
            .map(|folder| top.join(folder))
            .into();
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
                name.is_some_and(|(name, _)| crates.iter().any(|known| known == name))
            };
            let found: Vec<&str> = text.lines().filter(|line| of_service(line)).collect();
            assert!(found.is_empty(), "{}: {found:?}", path.display());
            read += 1;
        }
    }
    assert!(read > 80, "{read} files");
}

/// What only `safe_files` may do outside tests, with what it offers instead.
const WRITING: [(&str, &str); 8] = [
    ("temp_dir(", "TemporaryFolder"),
    ("tempfile::", "TemporaryFolder, Draft"),
    ("\"/tmp", "TemporaryFolder"),
    ("fs::write(", "replace_private, write_output"),
    ("File::create(", "create_private, open_lock"),
    ("fs::rename(", "replace, Draft::replace"),
    ("fs::copy(", "replace_private"),
    (".truncate(true)", "create_private"),
];

/// Files that do one of these things, each with the reason.
const WRITERS: [(&str, &str, &str); 8] = [
    (
        "shared/service/src/journal_record/golden.rs",
        "fs::write(",
        "used by tests alone, in the repository",
    ),
    (
        "shared/journal/src/rotate.rs",
        "fs::rename(",
        "the new journal takes the name of the old one; crashes between the steps are tested",
    ),
    (
        "shared/journal/src/rotate.rs",
        "fs::copy(",
        "a second name of the journal where there are no links",
    ),
    ("shared/recording/src/", "fs::rename(", "finished recordings get their names"),
    (
        "shared/service/src/log_file.rs",
        "fs::rename(",
        "a full log becomes the first of the older ones",
    ),
    ("shared/service/src/journal_set.rs", "fs::rename(", "journals are set aside"),
    (
        "shared/web_server/src/audit.rs",
        "fs::rename(",
        "a full audit becomes the first of the older ones",
    ),
    ("services/supervisor/src/epoch.rs", "fs::rename(", "journals are put aside"),
];

/// The text without items for tests.
fn production(text: &str) -> String {
    let (mut kept, mut is_test) = (String::new(), false);
    for line in text.lines() {
        is_test |= line == "#[cfg(test)]";
        if !is_test && !line.trim_start().starts_with("//") {
            kept.push_str(line);
            kept.push('\n');
        }
        // The end of an item.
        is_test &= !(line == "}" || line.ends_with(';') && !line.starts_with(' '));
    }
    kept
}

fn sources(folder: PathBuf, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap();
        if path.is_dir() {
            if !["tests", "examples", "target", "safe_files"].contains(&name) {
                sources(path, found);
            }
        } else if name.ends_with(".rs") && !name.ends_with("tests.rs") && name != "build.rs" {
            found.push(path);
        }
    }
}

/// A name that others can guess, or a file that is written through a link, is a hole wherever another user may write.
#[test]
fn files_are_written_by_one_crate() {
    let top = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    let mut files = Vec::new();
    for folder in ["shared", "services"] {
        sources(top.join(folder), &mut files);
    }
    assert!(files.len() > 500, "{} files", files.len());
    let mut problems = Vec::new();
    let mut used = BTreeSet::new();
    for file in files {
        let name = file.strip_prefix(&top).unwrap().display().to_string();
        let text = production(&std::fs::read_to_string(&file).unwrap());
        for (what, instead) in WRITING.into_iter().filter(|(what, _)| text.contains(what)) {
            let reason = WRITERS.iter().position(|(of, it, _)| name.starts_with(of) && *it == what);
            match reason {
                Some(number) => drop(used.insert(number)),
                None => problems.push(format!("{name}: {what} (use safe_files: {instead})")),
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
    assert_eq!(
        used.len(),
        WRITERS.len(),
        "exceptions that are none any more: only {used:?} are used"
    );
}
