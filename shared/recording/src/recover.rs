//! Recordings whose writer was killed: everything up to its last flush is kept.

use std::collections::{HashMap, HashSet};
use std::fs::{self, File};
use std::io::{BufReader, BufWriter, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use mcap::records::{self, Record};
use mcap::sans_io::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{Attachment, McapError, Writer, parse_record};

use crate::RecordingError;
use crate::file::{create_private, finished, options};

/// What was kept of a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovered {
    /// The complete file.
    pub path: PathBuf,
    /// Its messages.
    pub messages: u64,
    /// Whether the end of the file was damaged.
    pub was_torn: bool,
}

/// Completes unfinished recordings, and removes those without a message. One that fails is left as it is.
pub fn recover_all(unfinished: &[PathBuf]) {
    for path in unfinished {
        match recover(path) {
            Ok(Recovered { path, messages: 0, .. }) => {
                tracing::info!(file = %path.display(), "recording without a message removed");
                // One that stays does no harm.
                let _ = fs::remove_file(path);
            }
            Ok(Recovered { path, messages, .. }) => {
                tracing::info!(file = %path.display(), messages, "unfinished recording completed");
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
    let (messages, was_torn) = merge(&[path.to_owned()], &whole)?;
    fs::rename(&whole, path).map_err(RecordingError::io(path))?;
    Ok(Recovered { path: finished(path)?, messages, was_torn })
}

/// Writes one complete recording from several, in their order; they may be unfinished or still being
/// written. Returns the number of messages, and whether the end of one, or one of several as a whole, was damaged.
///
/// # Errors
/// As [`recover`]; nothing is left of the copy then.
pub fn merge(from: &[PathBuf], to: &Path) -> Result<(u64, bool), RecordingError> {
    let merged = copy(from, to);
    let is_own = !matches!(&merged, Err(RecordingError::Io(_, error)) if error.kind() == ErrorKind::AlreadyExists);
    if merged.is_err() && is_own {
        let _ = fs::remove_file(to);
    }
    merged
}

fn copy(from: &[PathBuf], to: &Path) -> Result<(u64, bool), RecordingError> {
    let writer = options().create(BufWriter::new(create_private(to)?));
    let writer = writer.map_err(RecordingError::mcap(to))?;
    let mut copier = Copier {
        writer,
        schemas: HashMap::new(),
        channels: HashMap::new(),
        attached: HashSet::new(),
        messages: 0,
    };
    let mut was_torn = false;
    for file in from {
        copier.schemas.clear();
        copier.channels.clear();
        let end = each_record(file, |record| copier.add(record).map_err(RecordingError::mcap(to)));
        was_torn |= match end {
            Ok(end) => end == End::Torn,
            // One of many that is no recording hides none of the others.
            Err(RecordingError::Mcap(path, error)) if from.len() > 1 && path != to => {
                tracing::warn!(file = %path.display(), %error, "not a recording");
                true
            }
            Err(error) => return Err(error),
        };
    }
    let Copier { mut writer, messages, .. } = copier;
    writer.finish().map_err(RecordingError::mcap(to))?;
    writer.into_inner().flush().map_err(RecordingError::io(to))?;
    Ok((messages, was_torn))
}

/// Longest record that is read: a longer one is damage. Attachments are far shorter.
const RECORD_BYTES_MAX: usize = 64 << 20;

/// End of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum End {
    /// Whole records, with or without a summary.
    Whole,
    /// A part of a record, or damage.
    Torn,
}

/// Reads the records of a file, those in chunks too, to the end of its data or the first damage.
pub(crate) fn each_record(
    path: &Path,
    mut take: impl FnMut(Record<'_>) -> Result<(), RecordingError>,
) -> Result<End, RecordingError> {
    let file = safe_files::open_regular(path).map_err(RecordingError::io(path))?;
    let mut file = BufReader::new(file);
    let read_options = LinearReaderOptions::default()
        .with_skip_end_magic(true)
        .with_validate_chunk_crcs(true)
        .with_record_length_limit(RECORD_BYTES_MAX);
    let mut reader = LinearReader::new_with_options(read_options);
    let mut has_begun = false;
    while let Some(event) = reader.next_event() {
        match event {
            Ok(LinearReadEvent::ReadRequest(wanted)) => {
                let read = file.read(reader.insert(wanted)).map_err(RecordingError::io(path))?;
                reader.notify_read(read);
            }
            Ok(LinearReadEvent::Record { opcode, data }) => {
                has_begun = true;
                match parse_record(opcode, data) {
                    Ok(Record::DataEnd(_)) => return Ok(End::Whole),
                    Ok(record) => take(record)?,
                    Err(_) => return Ok(End::Torn),
                }
            }
            Err(error) if has_begun => {
                // The end of a file whose writer was killed between two chunks.
                let is_whole = matches!(error, McapError::UnexpectedEof | McapError::BadMagic);
                return Ok(if is_whole { End::Whole } else { End::Torn });
            }
            Err(error) => return Err(RecordingError::Mcap(path.to_owned(), error)),
        }
    }
    Ok(End::Whole)
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
            Recording::begin(folder, 7_000_000, WallClock::default(), &attached).unwrap();
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
        assert_eq!(merge(&[first.clone(), second.clone()], &to).unwrap(), (80, false));
        // What is no recording hides none of the others.
        let (odd, despite) = (folder.path().join("odd.mcap"), folder.path().join("despite.mcap"));
        fs::write(&odd, [7; 300]).unwrap();
        assert_eq!(merge(&[odd.clone(), first.clone()], &despite).unwrap(), (30, true));
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
    fn damage_anywhere_ends_the_recovery_before_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = abandoned(folder.path(), 50);
        let whole = fs::read(&path).unwrap();
        let mut torn = 0;
        for at in (0..whole.len()).step_by(5) {
            let mut bytes = whole.clone();
            bytes[at] ^= 0xff;
            fs::write(&path, &bytes).unwrap();
            match recover(&path) {
                Ok(recovered) => {
                    torn += usize::from(recovered.was_torn);
                    let found = summary(&recovered.path).unwrap();
                    assert_eq!(found.messages, recovered.messages, "damage at {at}");
                    assert!(found.messages <= 50, "damage at {at}");
                    fs::remove_file(recovered.path).unwrap();
                }
                // In the header, or in a record that nothing protects.
                Err(error) => assert!(matches!(error, RecordingError::Mcap(..)), "{at}: {error}"),
            }
        }
        assert!(torn > whole.len() / 20, "{torn}");
    }
}
