//! Recordings whose writer was killed, or that are damaged: everything that can be read is kept.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use mcap::records::{self, Record};
use mcap::{Attachment, McapError, Writer};

use crate::file::{create_private, finished, options};
use crate::records::{LeftOut, each_record};
use crate::{EXTENSION, RecordingError};

/// Result of recovering a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// The complete file.
    pub path: PathBuf,
    /// Number of messages.
    pub messages: u64,
    /// Unreadable parts other than the end.
    pub left_out: LeftOut,
}

/// Completes unfinished recordings, and removes those without a message. A failing one is kept.
pub fn recover_all(unfinished: &[PathBuf]) {
    for path in unfinished {
        match recover(path) {
            Ok(Recovered { path, messages: 0, .. }) => {
                tracing::info!(file = %path.display(), "recording without a message removed");
                // One that stays does no harm.
                let _ = fs::remove_file(path);
            }
            Ok(Recovered { path, messages, left_out }) if left_out.is_nothing() => {
                tracing::info!(file = %path.display(), messages, "unfinished recording completed");
            }
            Ok(Recovered { path, messages, left_out }) => {
                let file = path.display();
                tracing::warn!(%file, messages, %left_out, "unfinished recording completed without");
            }
            // Its turn to be deleted has come meanwhile.
            Err(RecordingError::Io(_, error)) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => tracing::warn!(%error, "unfinished recording is left as it is"),
        }
    }
}

/// Completes an unfinished recording in its place.
///
/// # Errors
/// The file cannot be read, or the complete one cannot be written.
pub fn recover(path: &Path) -> Result<Recovered, RecordingError> {
    let whole = path.with_extension("recovering");
    let _ = fs::remove_file(&whole);
    let (messages, left_out) = merge(&[path.to_owned()], &whole)?;
    fs::rename(&whole, path).map_err(RecordingError::io(path))?;
    Ok(Recovered { path: finished(path)?, messages, left_out })
}

/// Writes one complete recording from several, in their order; also unfinished ones. Returns the
/// number of messages, and the parts left out; a file that is not a recording is one.
///
/// # Errors
/// As [`recover`]; nothing is left of the copy then.
pub fn merge(from: &[PathBuf], to: &Path) -> Result<(u64, LeftOut), RecordingError> {
    let merged = copy(from, to);
    let is_own = !matches!(&merged, Err(RecordingError::Io(_, error)) if error.kind() == ErrorKind::AlreadyExists);
    if merged.is_err() && is_own {
        let _ = fs::remove_file(to);
    }
    merged
}

fn copy(from: &[PathBuf], to: &Path) -> Result<(u64, LeftOut), RecordingError> {
    let writer = options().create(BufWriter::new(create_private(to)?));
    let writer = writer.map_err(RecordingError::mcap(to))?;
    let mut copier = Copier {
        writer,
        schemas: HashMap::new(),
        channels: HashMap::new(),
        attached: HashSet::new(),
        messages: 0,
    };
    let mut left_out = LeftOut::default();
    for file in from {
        copier.schemas.clear();
        copier.channels.clear();
        let read = each_record(file, |record| copier.add(record).map_err(RecordingError::mcap(to)));
        left_out += match read {
            // A recording that is not finished has no end.
            Ok(found) if file.extension().is_none_or(|it| it != EXTENSION) => {
                LeftOut { endless: 0, ..found }
            }
            Ok(found) => found,
            // One of many that is not a recording does not hide the others.
            Err(RecordingError::Mcap(path, error)) if from.len() > 1 && path != to => {
                tracing::warn!(file = %path.display(), %error, "not a recording");
                LeftOut { parts: 1, ..LeftOut::default() }
            }
            Err(error) => return Err(error),
        };
    }
    let Copier { mut writer, messages, .. } = copier;
    writer.finish().map_err(RecordingError::mcap(to))?;
    writer.into_inner().flush().map_err(RecordingError::io(to))?;
    Ok((messages, left_out))
}

/// Copies records of several files into one.
struct Copier {
    writer: Writer<BufWriter<File>>,
    /// Numbers of the schemas and channels of the file that is read, in the one that is written.
    schemas: HashMap<u16, u16>,
    channels: HashMap<u16, u16>,
    /// Attachments that are in it, by name and content.
    attached: HashSet<(String, Vec<u8>)>,
    messages: u64,
}

impl Copier {
    fn add(&mut self, record: Record<'_>) -> Result<(), McapError> {
        let Self { writer, schemas, channels, attached, messages } = self;
        match record {
            Record::Schema { header, data } => {
                let id = writer.add_schema(&header.name, &header.encoding, &data)?;
                schemas.insert(header.id, id);
            }
            Record::Channel(channel) => {
                let schema = schemas.get(&channel.schema_id).copied().unwrap_or(0);
                let records::Channel { topic, message_encoding, metadata, .. } = &channel;
                let id = writer.add_channel(schema, topic, message_encoding, metadata)?;
                channels.insert(channel.id, id);
            }
            Record::Message { mut header, data } => {
                let unknown = McapError::UnknownChannel(header.sequence, header.channel_id);
                header.channel_id = channels.get(&header.channel_id).copied().ok_or(unknown)?;
                *messages += 1;
                writer.write_to_known_channel(&header, &data)?;
            }
            Record::Attachment { header, data, .. }
                if attached.insert((header.name.clone(), data.to_vec())) =>
            {
                let (log_time, create_time) = (header.log_time, header.create_time);
                let (name, media_type) = (header.name, header.media_type);
                writer.attach(&Attachment { log_time, create_time, name, media_type, data })?;
            }
            Record::Metadata(metadata) => writer.write_metadata(&metadata)?,
            _ => {}
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::UNFINISHED;
    use crate::channels::{self, ChannelId};
    use crate::clock::WallClock;
    use crate::file::{Attached, Recording};
    use crate::list::{incomplete, summary};

    /// A recording that is flushed after every ten messages and then abandoned.
    fn abandoned(folder: &Path, messages: u32) -> PathBuf {
        let channels = channels::all();
        let files = vec![("robot.urdf".to_owned(), "application/xml", "<robot/>".to_owned())];
        let attached = Attached { files, ..Attached::default() };
        let mut recording =
            Recording::begin(folder, 1, 7_000_000, WallClock::default(), &attached).unwrap();
        for number in 0..messages {
            let id = ChannelId(number as usize % channels.len());
            let data = number.to_le_bytes();
            recording.write((id, &channels[id.0]), number, number.into(), &data).unwrap();
            if number % 10 == 9 {
                recording.flush().unwrap();
            }
        }
        let path = recording.path().to_owned();
        // As a kill does: nothing is written any more, and the lock is gone.
        let copy = folder.join("copy");
        fs::copy(&path, &copy).unwrap();
        fs::rename(&copy, &path).unwrap();
        std::mem::forget(recording);
        path
    }

    #[test]
    fn everything_up_to_the_last_flush_is_recovered_wherever_the_file_is_cut() {
        let folder = tempfile::tempdir().unwrap();
        let path = abandoned(folder.path(), 95);
        let whole = fs::read(&path).unwrap();
        let mut most = 0;
        for cut in (0..=whole.len()).rev().step_by(37) {
            fs::write(&path, &whole[..cut]).unwrap();
            match recover(&path) {
                Ok(recovered) => {
                    let found = summary(&recovered.path).unwrap();
                    assert_eq!(found.messages, recovered.messages, "cut at {cut}");
                    assert_eq!(recovered.messages % 10, 0, "whole chunks, cut at {cut}");
                    most = most.max(recovered.messages);
                    fs::remove_file(recovered.path).unwrap();
                }
                // Not even a header.
                Err(error) => assert!(cut < 100, "cut at {cut}: {error}"),
            }
        }
        assert_eq!(most, 90);
        assert!(fs::read_dir(folder.path()).unwrap().count() <= 1, "no leftovers");
    }

    #[test]
    fn recovery_keeps_attachments_and_removes_a_file_without_content() {
        let folder = tempfile::tempdir().unwrap();
        let empty = folder.path().join(format!("2020-01-01T00-00-00.000Z.{UNFINISHED}"));
        fs::write(&empty, "").unwrap();
        let torn = abandoned(folder.path(), 30);
        recover_all(&incomplete(folder.path()));
        assert!(!empty.exists() && !empty.with_extension("").exists() && !torn.exists());
        let (mut attached, mut messages) = (Vec::new(), 0);
        let whole = torn.with_extension("");
        each_record(&whole, |record| {
            match record {
                Record::Attachment { header, data, .. } => {
                    attached.push((header.name, data.into_owned()));
                }
                Record::Message { .. } => messages += 1,
                _ => {}
            }
            Ok(())
        })
        .unwrap();
        assert_eq!(attached, [("robot.urdf".to_owned(), b"<robot/>".to_vec())]);
        assert_eq!(messages, 30);
    }

    #[test]
    fn several_recordings_become_one_with_each_attachment_once() {
        let folder = tempfile::tempdir().unwrap();
        let first = recover(&abandoned(folder.path(), 30)).unwrap().path;
        let second = abandoned(folder.path(), 50);
        let to = folder.path().join("both.mcap");
        let merged = merge(&[first.clone(), second.clone()], &to).unwrap();
        assert_eq!(merged, (80, LeftOut::default()));
        // A file that is not a recording does not hide the others.
        let (odd, despite) = (folder.path().join("odd.mcap"), folder.path().join("despite.mcap"));
        fs::write(&odd, [7; 300]).unwrap();
        let left_out = LeftOut { parts: 1, ..LeftOut::default() };
        assert_eq!(merge(&[odd.clone(), first.clone()], &despite).unwrap(), (30, left_out));
        assert!(merge(&[odd], &folder.path().join("none.mcap")).is_err());
        let found = summary(&to).unwrap();
        assert_eq!((found.messages, found.span_ns), (80, (0, 49)));
        assert!(second.exists(), "it may be written still");
        let mut attached = 0;
        let count = |record: Record<'_>| {
            attached += u32::from(matches!(record, Record::Attachment { .. }));
            Ok(())
        };
        each_record(&to, count).unwrap();
        assert_eq!(attached, 1);
        // An existing file is never replaced.
        assert!(merge(&[first], &to).is_err());
        assert_eq!(summary(&to).unwrap().messages, 80);
    }

    #[test]
    fn damage_anywhere_costs_what_is_damaged() {
        let folder = tempfile::tempdir().unwrap();
        let path = abandoned(folder.path(), 50);
        let whole = fs::read(&path).unwrap();
        let mut damaged = 0;
        for at in (0..whole.len()).step_by(5) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0xff;
            fs::write(&path, &bytes).unwrap();
            let recovered =
                recover(&path).unwrap_or_else(|error| panic!("damage at {at}: {error}"));
            let Recovered { path, messages, left_out } = recovered;
            assert_eq!(summary(&path).unwrap().messages, messages, "damage at {at}");
            // Ten in its chunk, and those of the channels that it defines.
            assert!((30..=50).contains(&messages), "damage at {at}: {messages}, {left_out}");
            assert!(messages == 50 || !left_out.is_nothing(), "damage at {at}");
            damaged += usize::from(left_out.parts > 0);
            fs::remove_file(path).unwrap();
        }
        assert!(damaged > whole.len() / 20, "{damaged}");
    }
}
