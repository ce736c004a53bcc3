//! Configuration folders as people write them, right and wrong.

mod invalid;
mod layering;
mod sections;
mod snapshot;

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use crate::{Diagnostics, Settings};

/// Returns the shipped configuration folder.
fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../config")
}

/// A configuration folder with the given files. The scene that the defaults name is always there,
/// with one object.
struct Folder(TempDir);

const ONE_BOWL: &str = include_str!("../../../../tests/fixtures/scenes/one_bowl.toml");

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        folder.write("scenes/bowls.toml", ONE_BOWL);
        files.iter().for_each(|(name, text)| folder.write(name, text));
        folder
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.0.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn load(
        &self,
        profile: Option<&str>,
        overrides: &[(&str, &str)],
    ) -> Result<Settings, Diagnostics> {
        let overrides: Vec<_> =
            overrides.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        Settings::load(self.path(), profile, &overrides)
    }

    /// Every problem on a line of its own, with files named from this folder.
    fn complaints(&self, profile: Option<&str>, overrides: &[(&str, &str)]) -> Vec<String> {
        let problems = self.load(profile, overrides).unwrap_err().to_string();
        let folder = format!("{}/", self.path().display());
        problems.lines().map(|line| line.replace(&folder, "")).collect()
    }
}
