//! The transcript's lines on disk, for the console's next incarnation.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use service::{Span, Time};

/// Shortest time between two writes.
const WRITE_EVERY: Span = Span::from_ms(500);

/// A file with JSON lines in the group's run folder, which is removed with the group.
#[derive(Debug)]
pub(super) struct LineStore {
    path: PathBuf,
    written: Time,
    is_due: bool,
}

impl LineStore {
    pub(super) fn in_folder(run: &Path, name: &str) -> Self {
        Self { path: run.join(name), written: Time(0), is_due: false }
    }

    /// Reads the lines of the previous incarnation; unreadable ones are left out.
    pub(super) fn read<T: DeserializeOwned>(&self) -> Vec<T> {
        let text = fs::read_to_string(&self.path).unwrap_or_default();
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
    }

    /// Notes that a line has changed.
    pub(super) fn mark_changed(&mut self) {
        self.is_due = true;
    }

    /// Writes the lines if they have changed and a write is due.
    pub(super) fn write<'a, T: Serialize + 'a>(
        &mut self,
        lines: impl Iterator<Item = &'a T>,
        now: Time,
    ) {
        if !self.is_due || now < self.written + WRITE_EVERY {
            return;
        }
        (self.written, self.is_due) = (now, false);
        // Every line can be written.
        let lines = lines.filter_map(|line| serde_json::to_string(line).ok());
        let text: String = lines.map(|line| line + "\n").collect();
        if let Err(error) = safe_files::replace_private(&self.path, text) {
            tracing::debug!(%error, file = %self.path.display(), "not stored");
        }
    }
}
