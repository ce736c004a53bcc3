//! The journals on disk: one file per participant in the study's folder.

use std::io;
use std::path::{Path, PathBuf};

use safe_files::read_folder;
use user_study::{Entry, FILE_ENDING, Participant};

use crate::lines::Lines;

/// Everybody, in the order in which they came; torn ends are left out.
pub(super) fn read(folder: &Path) -> Result<Vec<Participant>, String> {
    let of = |path: &Path, error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let files = read_folder(folder, FILE_ENDING).map_err(|(path, error)| of(&path, &error))?;
    user_study::people(files).map_err(|(path, error)| of(&path, &error))
}

/// The study's folder, for its only writer.
#[derive(Debug)]
pub(super) struct Files {
    folder: PathBuf,
    /// The file of one participant; the others' need not stay open.
    open: Option<(String, Lines)>,
}

impl Files {
    pub(super) fn in_folder(folder: PathBuf) -> Self {
        Self { folder, open: None }
    }

    /// Writes entries of a participant down; they are on the disk afterwards.
    pub(super) fn append(&mut self, id: &str, entries: &[Entry]) -> io::Result<()> {
        let text: String = entries.iter().map(Entry::to_line).collect();
        match &mut self.open {
            Some((known, lines)) if *known == id => lines.append(&text),
            _ => {
                let (_, lines) = self.open.insert((id.to_owned(), open(&self.path(id))?));
                lines.append(&text)
            }
        }
    }

    /// Puts these entries in the place of all that there is of a participant.
    pub(super) fn replace(&mut self, id: &str, entries: &[Entry]) -> io::Result<()> {
        self.open.take_if(|(known, _)| *known == id);
        let text: String = entries.iter().map(Entry::to_line).collect();
        safe_files::replace_private_synced(&self.path(id), &text)
    }

    fn path(&self, id: &str) -> PathBuf {
        self.folder.join(format!("{id}.{FILE_ENDING}"))
    }
}

fn open(path: &Path) -> io::Result<Lines> {
    match Lines::create(path) {
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            Lines::open(path).map(|(lines, _)| lines)
        }
        created => created,
    }
}
