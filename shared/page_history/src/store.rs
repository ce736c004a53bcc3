//! The store of past interactions: JSON lines in a few files of bounded size, oldest interactions
//! first. The journals keep the last few hundred interactions only; this keeps thousands.
//!
//! Lines are not synced: after a power failure lost ones are rebuilt from the journals.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use crate::interaction::{Interaction, Summary};

/// Size at which a file is full, bytes.
const FILE_BYTES: u64 = 1 << 20;
/// Most files; the oldest is deleted.
const FILES_MAX: usize = 64;

/// Past interactions on disk, listed in memory.
#[derive(Debug)]
pub(super) struct Store {
    folder: PathBuf,
    /// Oldest first.
    files: Vec<StoreFile>,
    file_bytes: u64,
    files_max: usize,
}

#[derive(Debug)]
struct StoreFile {
    path: PathBuf,
    bytes: u64,
    entries: Vec<Entry>,
}

#[derive(Debug)]
struct Entry {
    summary: Summary,
    offset: u64,
    bytes: u64,
}

impl Store {
    /// Opens the store in a folder; empty if there is none.
    ///
    /// # Errors
    /// The folder cannot be read.
    pub(super) fn open(folder: PathBuf) -> io::Result<Self> {
        Self::with_limits(folder, FILE_BYTES, FILES_MAX)
    }

    pub(super) fn with_limits(
        folder: PathBuf,
        file_bytes: u64,
        files_max: usize,
    ) -> io::Result<Self> {
        let mut paths: Vec<PathBuf> = match fs::read_dir(&folder) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            entries => entries?.flatten().map(|entry| entry.path()).collect(),
        };
        paths.retain(|path| path.extension().is_some_and(|it| it == "jsonl"));
        paths.sort();
        let files = paths.into_iter().map(StoreFile::read).collect::<io::Result<_>>()?;
        Ok(Self { folder, files, file_bytes, files_max })
    }

    /// Number of interactions.
    pub(super) fn len(&self) -> usize {
        self.files.iter().map(|file| file.entries.len()).sum()
    }

    /// The interactions, newest first.
    pub(super) fn newest_first(&self) -> impl Iterator<Item = &Summary> {
        let files = self.files.iter().rev();
        files.flat_map(|file| file.entries.iter().rev().map(|entry| &entry.summary))
    }

    /// Number of the newest interaction, 0 for none.
    pub(super) fn newest(&self) -> u64 {
        self.newest_first().next().map_or(0, |summary| summary.interaction)
    }

    /// The oldest interaction.
    pub(super) fn oldest(&self) -> Option<&Summary> {
        self.files.iter().find_map(|file| file.entries.first()).map(|entry| &entry.summary)
    }

    /// Appends an interaction, which is newer than all that are stored.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn append(&mut self, interaction: &Interaction) -> io::Result<()> {
        let line = serde_json::to_string(interaction)? + "\n";
        let is_full = |file: &StoreFile| file.bytes + line.len() as u64 > self.file_bytes;
        if self.files.last().is_none_or(is_full) {
            fs::create_dir_all(&self.folder)?;
            let name = format!("{:020}.jsonl", interaction.interaction);
            let path = self.folder.join(name);
            self.files.push(StoreFile { path, bytes: 0, entries: Vec::new() });
        }
        if let Some(file) = self.files.last_mut() {
            file.append(interaction, &line)?;
        }
        while self.files.len() > self.files_max {
            fs::remove_file(&self.files.remove(0).path)?;
        }
        Ok(())
    }

    /// Reads an interaction; `None` if it is not stored.
    ///
    /// # Errors
    /// Its file cannot be read.
    pub(super) fn read(&self, interaction: u64) -> io::Result<Option<Interaction>> {
        let find = |file: &StoreFile| {
            let key = |entry: &Entry| entry.summary.interaction;
            let at = file.entries.binary_search_by_key(&interaction, key).ok()?;
            let Entry { offset, bytes, .. } = file.entries[at];
            Some((file.path.clone(), offset, bytes))
        };
        let Some((path, offset, bytes)) = self.files.iter().find_map(find) else { return Ok(None) };
        let mut file = File::open(path)?;
        file.seek(SeekFrom::Start(offset))?;
        let mut line = Vec::new();
        file.take(bytes).read_to_end(&mut line)?;
        Ok(Some(serde_json::from_slice(&line)?))
    }
}

impl StoreFile {
    /// Lists the interactions of a file. Damaged lines are skipped, and a torn end is cut off.
    fn read(path: PathBuf) -> io::Result<Self> {
        let text = fs::read(&path)?;
        let (mut entries, mut offset): (Vec<Entry>, u64) = (Vec::new(), 0);
        for line in text.split_inclusive(|byte| *byte == b'\n') {
            let bytes = line.len() as u64;
            if !line.ends_with(b"\n") {
                OpenOptions::new().write(true).open(&path)?.set_len(offset)?;
                break;
            }
            if let Ok(interaction) = serde_json::from_slice::<Interaction>(line)
                && entries.last().is_none_or(|it| it.summary.interaction < interaction.interaction)
            {
                entries.push(Entry { summary: interaction.summary(), offset, bytes });
            }
            offset += bytes;
        }
        Ok(Self { path, bytes: offset, entries })
    }

    fn append(&mut self, interaction: &Interaction, line: &str) -> io::Result<()> {
        let mut file = OpenOptions::new().create(true).append(true).open(&self.path)?;
        let bytes = line.len() as u64;
        if let Err(error) = file.write_all(line.as_bytes()) {
            // The next line must not follow upon half of this one.
            file.set_len(self.bytes)?;
            return Err(error);
        }
        let offset = self.bytes;
        self.entries.push(Entry { summary: interaction.summary(), offset, bytes });
        self.bytes += bytes;
        Ok(())
    }
}

/// Folder of the store next to the journals: a fresh start moves it with them.
pub(super) fn folder(journals: &Path) -> PathBuf {
    journals.join("history")
}
