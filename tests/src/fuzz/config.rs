//! Configuration files, one of a folder at a time.

use std::fs;
use std::path::{Path, PathBuf};

use config::{SNAPSHOT_FILE, Settings};
use tempfile::TempDir;

use super::bytes::{Input, chosen, project_file};

const SECTIONS: [&str; 7] =
    ["group", "dialogue", "speech", "arm", "study", "console", "profiles/fuzz"];

thread_local! {
    /// A configuration folder without sections.
    static FOLDER: TempDir = folder();
}

fn folder() -> TempDir {
    parts::register();
    let folder = tempfile::tempdir().expect("a folder");
    for part in ["scenes", "profiles"] {
        fs::create_dir(folder.path().join(part)).expect("a new folder");
    }
    for name in ["scenes/bowls.toml", "scenes/markers.toml"] {
        let text = project_file(&format!("config/{name}"));
        fs::write(folder.path().join(name), text).expect("a new file");
    }
    folder
}

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let section = SECTIONS[usize::from(input.byte()) % SECTIONS.len()];
    FOLDER.with(|folder| {
        let file = folder.path().join(format!("{section}.toml"));
        fs::write(&file, input.0).expect("space for a file");
        let profile = section.strip_prefix("profiles/");
        let loaded = Settings::load(folder.path(), profile, &[]);
        fs::remove_file(&file).expect("it was there");
        match loaded {
            Ok(settings) => survives(&settings, folder.path()),
            Err(problems) => {
                assert!(problems.iter().count() > 0);
                for problem in problems.iter() {
                    assert!(!problem.file.is_empty() && !problem.what.is_empty(), "{problem}");
                    let place = problem.line.is_some() || !problem.key.is_empty();
                    let whole = std::str::from_utf8(input.0).is_err();
                    assert!(place || whole, "no place: {problem}");
                }
            }
        }
    });
}

/// Checks that services read from the snapshot what the supervisor has loaded.
fn survives(settings: &Settings, folder: &Path) {
    let file: PathBuf = folder.join(SNAPSHOT_FILE);
    fs::write(&file, settings.snapshot()).expect("space for a file");
    let read = Settings::load_snapshot(folder);
    fs::remove_file(&file).expect("it was there");
    match read {
        Ok(read) => assert!(read == *settings, "the snapshot differs"),
        // Durations are measured by `preflight`, which is not part of this.
        Err(problems) => {
            assert!(problems.iter().all(|problem| problem.key == "durations"), "{problems}");
        }
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let mut seeds: Vec<_> = (0..6)
        .map(|n| chosen(n, project_file(&format!("config/{}.toml", SECTIONS[usize::from(n)]))))
        .collect();
    for name in ["baxter", "ci", "lab", "paper"] {
        seeds.push(chosen(6, project_file(&format!("config/profiles/{name}.toml"))));
    }
    seeds
}
