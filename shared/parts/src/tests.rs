//! Configurations with the sections of every part.

mod invalid;
mod reference;
mod restarts;
mod schemas;
mod study;

use std::fs;
use std::path::{Path, PathBuf};

use config::{SectionSchema, Settings};
use diagnostics::Diagnostics;
use model_reader::{Calibration, Configured};
use tempfile::TempDir;

/// The folder that is shipped.
fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config")
}

/// Every section with its schema.
fn sections() -> Vec<SectionSchema> {
    crate::register();
    config::schemas()
}

/// A configuration folder with the given files and a scene of one object.
struct Folder(TempDir);

const ONE_BOWL: &str = include_str!("../../../tests/fixtures/scenes/one_bowl.toml");

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in [("scenes/bowls.toml", ONE_BOWL)].iter().chain(files) {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        Self(folder)
    }

    fn load(&self, profile: Option<&str>, set: &[(&str, &str)]) -> Result<Settings, Diagnostics> {
        crate::register();
        let set: Vec<_> = set.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        Settings::load(self.0.path(), profile, &set)
    }

    /// Every problem on a line of its own, with files named from this folder.
    fn complaints(&self) -> String {
        let problems = self.load(None, &[]).unwrap_err().to_string();
        problems.replace(&format!("{}/", self.0.path().display()), "")
    }
}

#[test]
fn the_shipped_folder_loads_with_every_profile_and_scene() {
    crate::register();
    let names = |folder: &str| -> Vec<String> {
        let files = std::fs::read_dir(shipped().join(folder)).unwrap();
        let stem = |path: &Path| path.file_stem().unwrap().to_str().unwrap().to_owned();
        files.map(|file| stem(&file.unwrap().path())).collect()
    };
    let (profiles, scenes) = (names("profiles"), names("scenes"));
    for known in ["lab", "ci", "paper"] {
        assert!(profiles.iter().any(|name| name == known), "{profiles:?}");
    }
    for known in ["bowls", "markers", "tools"] {
        assert!(scenes.iter().any(|name| name == known), "{scenes:?}");
    }
    let load = |profile, scene: &str| {
        // The profile `link` leaves the keys to whoever has made them.
        let overrides = [("group.scene", scene), ("link.keys", "/keys")];
        let overrides = overrides.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let settings = config::Settings::load(&shipped(), profile, &overrides)
            .unwrap_or_else(|e| panic!("{scene} with {profile:?}: {e}"));
        assert_eq!(settings.scene.name(), scene);
    };
    scenes.iter().for_each(|scene| load(None, scene));
    profiles.iter().for_each(|profile| load(Some(profile), "markers"));
}

#[test]
fn language_model_is_off_by_default_and_no_part_of_the_decisions() {
    let usual = Folder::new(&[]).load(None, &[]).unwrap();
    assert_eq!(usual.part(), Ok(Configured(None)));
    let text = "[model]\nurl = 'http://[::1]:80/v1'\nmodel = 'small'\ntimeout_ms = 800";
    let settings = Folder::new(&[("dialogue.toml", text)]).load(None, &[]).unwrap();
    let Configured(model) = settings.part().unwrap();
    let model = model.unwrap();
    assert_eq!((&*model.url, &*model.name), ("http://[::1]:80/v1", "small"));
    assert_eq!((model.timeout.as_millis(), model.calibration), (800, Calibration::NONE));
    assert_eq!(settings.manager_key("entropy"), usual.manager_key("entropy"));
    let other = Folder::new(&[("dialogue.toml", "p_l = 0.9")]).load(None, &[]).unwrap();
    assert_ne!(other.manager_key("entropy"), usual.manager_key("entropy"));
}
