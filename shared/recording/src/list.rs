//! The recordings of a folder.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use mcap::records::Record;
use service::wall_time;

use crate::recover::each_record;
use crate::{EXTENSION, RecordingError, UNFINISHED};

/// A recording in a folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The file.
    pub path: PathBuf,
    /// When it began, nanoseconds since 1970, by its name.
    pub began_ns: u64,
    /// Its size, bytes.
    pub bytes: u64,
    /// Whether it is complete.
    pub is_finished: bool,
}

/// What is in a recording.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Summary {
    /// Number of messages.
    pub messages: u64,
    /// First and last moment, nanoseconds since 1970; 0 where there is no message.
    pub span_ns: (u64, u64),
    /// Messages of each topic.
    pub topics: BTreeMap<String, u64>,
    /// What is known of the recorded group.
    pub group: BTreeMap<String, String>,
}

/// The recordings of a folder, oldest first.
pub fn entries(folder: &Path) -> Vec<Entry> {
    let files = fs::read_dir(folder).into_iter().flatten().flatten();
    let mut found: Vec<Entry> = files.filter_map(|file| entry(&file.path())).collect();
    found.sort_by(|a, b| (a.began_ns, &a.path).cmp(&(b.began_ns, &b.path)));
    found
}

/// The unfinished recordings of a folder, oldest first.
pub fn unfinished(folder: &Path) -> Vec<PathBuf> {
    let all = entries(folder).into_iter();
    all.filter(|entry| !entry.is_finished && entry.is_own()).map(|entry| entry.path).collect()
}

impl Entry {
    /// Whether the name is one that the recorder gives; others are never deleted or completed.
    pub fn is_own(&self) -> bool {
        self.began_ns > 0
    }
}

fn entry(path: &Path) -> Option<Entry> {
    let name = path.file_name()?.to_str()?;
    let stem = |end: &str| name.strip_suffix(end)?.strip_suffix('.');
    let finished = stem(EXTENSION);
    let stem = finished.or_else(|| stem(UNFINISHED))?;
    let about = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    Some(Entry {
        path: path.to_owned(),
        began_ns: wall_time::parse(stem).unwrap_or(0),
        bytes: about.len(),
        is_finished: finished.is_some(),
    })
}

/// Reads what is in a recording, finished or not.
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
