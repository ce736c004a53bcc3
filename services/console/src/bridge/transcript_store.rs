//! The transcript on disk, for the console's next incarnation.

use std::fs;
use std::path::{Path, PathBuf};

use service::{Span, Time};

use crate::view_model::Line;

/// Shortest time between two writes.
const WRITE_EVERY: Span = Span::from_ms(500);

/// A file with the latest lines in the group's run folder, which is removed with the group.
#[derive(Debug)]
pub(super) struct TranscriptStore {
    path: PathBuf,
    written: Time,
    is_due: bool,
}

impl TranscriptStore {
    pub(super) fn in_folder(run: &Path) -> Self {
        Self { path: run.join("console.lines"), written: Time(0), is_due: false }
    }

    /// Reads the lines of the previous incarnation; unreadable ones are left out.
    pub(super) fn read(&self) -> Vec<Line> {
        let text = fs::read_to_string(&self.path).unwrap_or_default();
        text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
    }

    /// Notes that a line has changed.
    pub(super) fn mark_changed(&mut self) {
        self.is_due = true;
    }

    /// Writes the lines if they have changed and a write is due.
    pub(super) fn write<'a>(&mut self, lines: impl Iterator<Item = &'a Line>, now: Time) {
        if !self.is_due || now < self.written + WRITE_EVERY {
            return;
        }
        (self.written, self.is_due) = (now, false);
        let text: String = lines.map(|line| line.to_text() + "\n").collect();
        if let Err(error) = journal::replace_file(&self.path, text) {
            tracing::debug!(%error, "transcript not stored");
        }
    }
}
