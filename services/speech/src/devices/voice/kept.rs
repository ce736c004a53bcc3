//! A folder with the sound of the latest sentences, for whoever wants to hear them elsewhere.

use std::collections::VecDeque;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Sentences that are kept; a dialogue of the usual length has a tenth of it.
pub const KEPT_MAX: usize = 64;
/// How the names of kept files begin.
const PREFIX: &str = "line-";

/// The folder. What an earlier run left in it counts, and goes first.
#[derive(Debug)]
pub(super) struct Kept {
    folder: PathBuf,
    files: VecDeque<PathBuf>,
}

impl Kept {
    /// Takes the folder into use; it is made where it is not there.
    pub(super) fn open(folder: &Path) -> io::Result<Self> {
        fs::create_dir_all(folder)?;
        let mut found = Vec::new();
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            if entry.file_name().to_string_lossy().starts_with(PREFIX) {
                found.push((entry.metadata()?.modified()?, entry.path()));
            }
        }
        found.sort();
        Ok(Self {
            folder: folder.to_owned(),
            files: found.into_iter().map(|(_, path)| path).collect(),
        })
    }

    /// Keeps the sound of a sentence as `line-NAME.wav`, which is there whole or not at all.
    pub(super) fn keep(&mut self, name: &str, sound: &Path) -> io::Result<()> {
        let part = self.folder.join(format!("{PREFIX}{name}.part"));
        let file = self.folder.join(format!("{PREFIX}{name}.wav"));
        fs::copy(sound, &part)?;
        fs::rename(&part, &file)?;
        self.files.retain(|known| *known != file);
        self.files.push_back(file);
        while self.files.len() > KEPT_MAX {
            if let Some(oldest) = self.files.pop_front() {
                // Somebody may have taken it away already.
                let _ = fs::remove_file(oldest);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> =
            entries.map(|name| name.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }

    #[test]
    fn the_latest_are_kept_over_restarts_and_other_files_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let sound = folder.path().join("sound");
        fs::write(&sound, b"RIFF").unwrap();
        let to = folder.path().join("kept");
        let mut kept = Kept::open(&to).unwrap();
        fs::write(to.join("mine.wav"), b"").unwrap();
        (0..KEPT_MAX).for_each(|n| kept.keep(&format!("{n:03}"), &sound).unwrap());
        kept.keep("000", &sound).unwrap();
        assert_eq!(names(&to).len(), KEPT_MAX + 1, "the same name is the same file");
        let mut kept = Kept::open(&to).unwrap();
        kept.keep("100", &sound).unwrap();
        kept.keep("101", &sound).unwrap();
        let left = names(&to);
        assert_eq!(left.len(), KEPT_MAX + 1);
        let last = ["line-100.wav", "line-101.wav", "mine.wav"];
        assert!(last.iter().all(|name| left.iter().any(|l| l == name)), "{left:?}");
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_an_error() {
        assert!(Kept::open(Path::new("/dev/null/kept")).is_err());
    }
}
