//! The recordings of a folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use mcap::records::{Record, Statistics};
use serde::Serialize;
use service::wall_time;

use crate::file::{self, NUMBER};
use crate::records::{each_record, first_metadata, summary_section};
use crate::{EXTENSION, RecordingError, UNFINISHED};

/// A recording in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The file.
    pub path: PathBuf,
    /// Start of the recording by its name, nanoseconds since 1970; 0 for a foreign name.
    pub began_ns: u64,
    /// Size of the recording, bytes.
    pub bytes: u64,
}

/// State of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum State {
    /// The recording was completed.
    Complete,
    /// A recorder is writing the recording.
    BeingWritten,
    /// The recorder ended before completing the recording; its next start does.
    Incomplete,
    /// The file has the name of a complete recording, and cannot be read as one.
    Damaged,
    /// The file's name is not the recorder's.
    Foreign,
}

/// Content of a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Number of messages.
    pub messages: u64,
    /// First and last moment, nanoseconds since 1970; 0 without messages.
    pub span_ns: (u64, u64),
    /// Messages of each topic.
    pub topics: BTreeMap<String, u64>,
    /// Properties of the recorded group.
    pub group: BTreeMap<String, String>,
}

/// The recordings of a folder, oldest first.
pub fn entries(folder: &Path) -> Vec<Entry> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<Entry> = files.filter_map(|file| entry(&file.path())).collect();
    found.sort_by(|a, b| (a.began_ns, &a.path).cmp(&(b.began_ns, &b.path)));
    found
}

/// The incomplete recordings of a folder, oldest first.
pub fn incomplete(folder: &Path) -> Vec<PathBuf> {
    let all = entries(folder).into_iter();
    all.filter(|entry| entry.state() == State::Incomplete).map(|entry| entry.path).collect()
}

impl Entry {
    /// Whether the name is one that the recorder gives; others are never deleted or completed.
    pub fn is_own(&self) -> bool {
        self.began_ns > 0
    }

    /// Whether the name is that of a complete recording.
    fn is_finished(&self) -> bool {
        self.path.extension().is_some_and(|end| end == EXTENSION)
    }

    /// Returns whether a recorder is writing the recording.
    pub fn is_being_written(&self) -> bool {
        !self.is_finished() && self.is_own() && file::is_locked(&self.path)
    }

    /// Returns the recording's state.
    pub fn state(&self) -> State {
        match self.is_finished() {
            _ if !self.is_own() => State::Foreign,
            true if statistics(&self.path).is_some() => State::Complete,
            true => State::Damaged,
            false if self.is_being_written() => State::BeingWritten,
            false => State::Incomplete,
        }
    }

    /// Returns the time from its first message to its last one, seconds; of an incomplete one from
    /// its beginning to its last change. `None` if unknown.
    pub fn seconds(&self) -> Option<f64> {
        let ns = match self.state() {
            State::Complete => {
                let Statistics { message_start_time, message_end_time, .. } =
                    statistics(&self.path)?;
                message_end_time.saturating_sub(message_start_time)
            }
            State::BeingWritten | State::Incomplete => {
                let changed = fs::metadata(&self.path).and_then(|found| found.modified()).ok()?;
                let changed = changed.duration_since(UNIX_EPOCH).ok()?.as_nanos();
                u64::try_from(changed).ok()?.saturating_sub(self.began_ns)
            }
            State::Damaged | State::Foreign => return None,
        };
        Some(ns as f64 / 1e9)
    }
}

/// The statistics at the end of a complete file.
fn statistics(path: &Path) -> Option<Statistics> {
    summary_section(path)?.stats
}

/// The number of a recording in its folder, greater for files begun later; 0 if it has none.
pub(crate) fn number(path: &Path) -> u64 {
    let stated = first_metadata(path).and_then(|mut found| found.remove(NUMBER));
    stated.and_then(|number| number.parse().ok()).unwrap_or(0)
}

fn entry(path: &Path) -> Option<Entry> {
    let name = path.file_name()?.to_str()?;
    let stem = |end: &str| name.strip_suffix(end)?.strip_suffix('.');
    let stem = stem(EXTENSION).or_else(|| stem(UNFINISHED))?;
    let about = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    Some(Entry {
        path: path.to_owned(),
        began_ns: wall_time::parse(stem).unwrap_or(0),
        bytes: about.len(),
    })
}

/// Summarises the content of a recording, finished or not.
///
/// # Errors
/// The file cannot be read, or is not MCAP.
pub fn summary(path: &Path) -> Result<Summary, RecordingError> {
    let mut found = Summary::default();
    let mut topics: BTreeMap<u16, (String, u64)> = BTreeMap::new();
    each_record(path, |record| {
        match record {
            Record::Channel(channel) => {
                topics.entry(channel.id).or_insert((channel.topic, 0));
            }
            Record::Message { header, .. } => {
                let (first, last) = &mut found.span_ns;
                *first = if found.messages == 0 {
                    header.log_time
                } else {
                    (*first).min(header.log_time)
                };
                *last = (*last).max(header.log_time);
                found.messages += 1;
                topics.entry(header.channel_id).or_default().1 += 1;
            }
            Record::Metadata(metadata) => found.group.extend(metadata.metadata),
            _ => {}
        }
        Ok(())
    })?;
    found.topics = topics.into_values().collect();
    Ok(found)
}
