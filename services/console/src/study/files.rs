//! The journals on disk: one file per participant in the study's folder.

use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

use evaluation::user_study::{Entry, FILE_ENDING, Participant};
use journal::lines::{self, Lines};

/// The study's folder, for its only writer.
#[derive(Debug)]
pub(super) struct Files {
    folder: PathBuf,
    open: HashMap<String, Lines>,
}

impl Files {
    pub(super) fn in_folder(folder: PathBuf) -> Self {
        Self { folder, open: HashMap::new() }
    }

    /// Everybody, in the order in which they came; torn ends are cut off.
    pub(super) fn recover(&mut self) -> Result<Vec<Participant>, String> {
        let of =
            |path: &Path, error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
        let files = lines::read_folder(&self.folder, FILE_ENDING)
            .map_err(|(path, error)| of(&path, &error))?;
        evaluation::user_study::people(files).map_err(|(path, error)| of(&path, &error))
    }

    /// Writes entries of a participant down; they are on the disk afterwards.
    pub(super) fn append(&mut self, id: &str, entries: &[Entry]) -> io::Result<()> {
        let text: String = entries.iter().map(Entry::to_line).collect();
        if !self.open.contains_key(id) {
            // One participant at a time: the others' files need not stay open.
            self.open.clear();
            let lines = self.lines(id)?;
            self.open.insert(id.to_owned(), lines);
        }
        match self.open.get_mut(id) {
            Some(lines) => lines.append(&text),
            None => Ok(()),
        }
    }

    /// Puts these entries in the place of all that there is of a participant.
    pub(super) fn replace(&mut self, id: &str, entries: &[Entry]) -> io::Result<()> {
        self.open.remove(id);
        let text: String = entries.iter().map(Entry::to_line).collect();
        journal::replace_file_synced(&self.path(id), &text)
    }

    fn lines(&self, id: &str) -> io::Result<Lines> {
        match Lines::create(&self.path(id)) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
                Lines::open(&self.path(id)).map(|(lines, _)| lines)
            }
            created => created,
        }
    }

    fn path(&self, id: &str) -> PathBuf {
        self.folder.join(format!("{id}.{FILE_ENDING}"))
    }
}
