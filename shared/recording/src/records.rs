//! Records of a recording, also of one that is damaged.
//!
//! A record begins with its kind and its length, so one whose content is damaged is passed over. If
//! the length is damaged too, reading continues at the next place with consecutive whole records.
//! Channels whose definition was in a lost chunk are read from the summary at the end.

use std::collections::{BTreeMap, HashSet};
use std::fmt::{self, Display, Formatter};
use std::io::{self, Read, Seek};
use std::ops::AddAssign;
use std::os::unix::fs::FileExt;
use std::path::Path;

use mcap::records::{Record, SchemaHeader, op};
use mcap::sans_io::{
    LinearReadEvent, LinearReader, LinearReaderOptions, SummaryReadEvent, SummaryReader,
    SummaryReaderOptions,
};
use mcap::{MAGIC, McapError, Summary, parse_record};
use scene::count;

use crate::RecordingError;
use crate::frames::{Found, Frame, Frames, HEAD_BYTES, own_length};
use crate::zstd::Zstd;

/// Longest record, and most bytes that a chunk may decompress to: a longer one is damage.
pub(crate) const RECORD_BYTES_MAX: u64 = 256 << 20;

/// Counts of unreadable parts of recordings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LeftOut {
    /// Damaged parts.
    pub parts: u64,
    /// Messages in them, as far as known.
    pub messages: u64,
    /// Files without an end: cut off, or not finished.
    pub endless: u64,
}

impl LeftOut {
    /// Whether everything was read.
    pub fn is_nothing(&self) -> bool {
        *self == Self::default()
    }
}

impl AddAssign for LeftOut {
    fn add_assign(&mut self, other: Self) {
        self.parts += other.parts;
        self.messages += other.messages;
        self.endless += other.endless;
    }
}

impl Display for LeftOut {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { parts, messages, endless } = *self;
        if parts > 0 {
            f.write_str(&count(parts, "damaged part"))?;
        }
        if messages > 0 {
            write!(f, " with {}", count(messages, "message"))?;
        }
        if endless > 0 {
            let and = if parts > 0 { ", and " } else { "" };
            write!(f, "{and}the end of {}", count(endless, "file"))?;
        }
        Ok(())
    }
}

/// Takes a record; refused ones end the reading.
type Take<'a> = &'a mut dyn FnMut(Record<'_>) -> Result<(), RecordingError>;

/// Reads the records of a file, also in chunks, to the end of its data. Returns the parts left out.
///
/// # Errors
/// The file cannot be read, is not a recording, or `take` fails.
pub(crate) fn each_record(
    path: &Path,
    mut take: impl FnMut(Record<'_>) -> Result<(), RecordingError>,
) -> Result<LeftOut, RecordingError> {
    let file = safe_files::open_regular(path).map_err(RecordingError::io(path))?;
    let size = file.metadata().map_err(RecordingError::io(path))?.len();
    let mut reading = Reading {
        frames: Frames { file: &file, size },
        path,
        take: &mut take,
        known: HashSet::new(),
        summary: None,
        taken: 0,
        indexed: 0,
        unknown: 0,
    };
    reading.run()
}

/// The summary at the end of a complete file.
pub(crate) fn summary_section(path: &Path) -> Option<Summary> {
    let mut file = safe_files::open_regular(path).ok()?;
    let size = file.metadata().ok()?.len();
    let options = SummaryReaderOptions::default().with_file_size(size);
    let mut reader = SummaryReader::new_with_options(
        options.with_record_length_limit(RECORD_BYTES_MAX as usize),
    );
    while let Some(event) = reader.next_event() {
        match event.ok()? {
            SummaryReadEvent::ReadRequest(wanted) => {
                let read = file.read(reader.insert(wanted)).ok()?;
                reader.notify_read(read);
            }
            SummaryReadEvent::SeekRequest(to) => reader.notify_seeked(file.seek(to).ok()?),
        }
    }
    reader.finish()
}

/// The metadata before the first message.
pub(crate) fn first_metadata(path: &Path) -> Option<BTreeMap<String, String>> {
    let file = safe_files::open_regular(path).ok()?;
    let frames = Frames { file: &file, size: file.metadata().ok()?.len() };
    let mut at = MAGIC.len() as u64;
    loop {
        match frames.at(at).ok()? {
            Found::Record(frame) if frame.kind == op::METADATA => {
                if frame.bytes > RECORD_BYTES_MAX {
                    return None;
                }
                let content = frames.content(frame).ok()?;
                let Ok(Record::Metadata(found)) = parse_record(frame.kind, &content) else {
                    return None;
                };
                return Some(found.metadata);
            }
            Found::Record(frame) if !matches!(frame.kind, op::CHUNK | op::DATA_END) => {
                at = frame.end();
            }
            _ => return None,
        }
    }
}

/// One pass over a file.
struct Reading<'a> {
    frames: Frames<'a>,
    path: &'a Path,
    take: Take<'a>,
    /// Channels that were defined so far.
    known: HashSet<u16>,
    summary: Option<Option<Summary>>,
    taken: u64,
    /// Messages that the indexes behind the chunks name.
    indexed: u64,
    /// Messages of channels that are defined nowhere.
    unknown: u64,
}

impl Reading<'_> {
    fn run(&mut self) -> Result<LeftOut, RecordingError> {
        let mut left_out = LeftOut { endless: 1, ..LeftOut::default() };
        let mut at = Some(self.begin(&mut left_out)?);
        while let Some(place) = at {
            at = self.step(place, &mut left_out)?;
        }
        if left_out.parts > 0 || self.unknown > 0 || self.indexed > self.taken {
            let summary = self.summary.get_or_insert_with(|| summary_section(self.path));
            let stated = summary.as_ref().and_then(|it| it.stats.as_ref());
            let stated = stated.map_or(0, |it| it.message_count).max(self.indexed);
            left_out.messages = stated.saturating_sub(self.taken).max(self.unknown);
            left_out.parts = left_out.parts.max(1);
        }
        Ok(left_out)
    }

    /// Hands on the content at a position. Returns the next position; `None` at the end.
    fn step(&mut self, at: u64, left_out: &mut LeftOut) -> Result<Option<u64>, RecordingError> {
        let found = self.io(self.frames.at(at))?;
        if let Found::Record(frame) = found {
            if matches!(frame.kind, op::DATA_END | op::FOOTER) {
                left_out.endless = 0;
                return Ok(None);
            }
            let is_length_right = !matches!(self.io(self.frames.at(frame.end()))?, Found::Damage);
            if let Some(end) = self.record(frame, is_length_right)? {
                return Ok(Some(end));
            }
            left_out.parts += 1;
            if is_length_right {
                return Ok(Some(frame.end()));
            }
        }
        let next = self.io(self.frames.next(at + 1))?;
        let is_damage = match found {
            // It was counted.
            Found::Record(_) => false,
            Found::Damage => true,
            // The length that leads beyond the end is damaged if something follows.
            Found::End => next.is_some(),
        };
        left_out.parts += u64::from(is_damage);
        Ok(next)
    }

    fn io<T>(&self, done: io::Result<T>) -> Result<T, RecordingError> {
        done.map_err(RecordingError::io(self.path))
    }

    /// Returns the place of the first record.
    fn begin(&self, left_out: &mut LeftOut) -> Result<u64, RecordingError> {
        let begin = MAGIC.len() as u64;
        let mut magic = [0; MAGIC.len()];
        let read = self.io(self.frames.file.read_at(&mut magic, 0))?;
        let is_magic = magic.as_slice() == MAGIC;
        if !is_magic && read > 0 && !self.io(self.frames.is_chain(begin))? {
            return Err(RecordingError::Mcap(self.path.to_owned(), McapError::BadMagic));
        }
        left_out.parts += u64::from(!is_magic && read > 0);
        Ok(begin)
    }

    /// Hands on a record, or those in a chunk. Returns its end if it is sound.
    fn record(
        &mut self,
        frame: Frame,
        is_length_right: bool,
    ) -> Result<Option<u64>, RecordingError> {
        let end = is_length_right.then_some(frame.end());
        match frame.kind {
            op::CHUNK | op::MESSAGE_INDEX | op::ATTACHMENT => {}
            op::SCHEMA | op::CHANNEL | op::MESSAGE | op::METADATA => {}
            _ => return Ok(end),
        }
        if frame.bytes > RECORD_BYTES_MAX {
            return Ok(None);
        }
        let content = self.io(self.frames.content(frame))?;
        let is_sound = match frame.kind {
            // Their sums tell whether they are sound, and with them the lengths in them.
            op::CHUNK | op::ATTACHMENT => {
                let Some(own) = own_length(frame.kind, &content) else { return Ok(None) };
                let content = &content[..own];
                let is_sound = match frame.kind {
                    op::CHUNK => self.chunk(content)?,
                    kind => self.parsed(kind, content)?,
                };
                return Ok(is_sound.then_some(frame.at + HEAD_BYTES + own as u64));
            }
            // It has no sum: of two lengths, the right one leads to a record.
            op::MESSAGE_INDEX => {
                let Some(own) = own_length(frame.kind, &content) else { return Ok(None) };
                let end = frame.at + HEAD_BYTES + own as u64;
                let is_one = own == content.len() && is_length_right;
                if !is_one && !self.io(self.frames.is_chain(end))? {
                    return Ok(None);
                }
                // A channel, and 16 bytes for each message.
                self.indexed += (own as u64 - 6) / 16;
                return Ok(Some(end));
            }
            kind => is_length_right && self.parsed(kind, &content)?,
        };
        Ok(end.filter(|_| is_sound))
    }

    fn parsed(&mut self, kind: u8, content: &[u8]) -> Result<bool, RecordingError> {
        match parse_record(kind, content) {
            Ok(record) => self.hand_on(record).map(|()| true),
            Err(_) => Ok(false),
        }
    }

    /// Hands on the records of a chunk, once its sum is right.
    fn chunk(&mut self, content: &[u8]) -> Result<bool, RecordingError> {
        let options = LinearReaderOptions::default()
            .with_skip_start_magic(true)
            .with_skip_end_magic(true)
            .with_validate_chunk_crcs(true)
            .with_prevalidate_chunk_crcs(true)
            .with_record_length_limit(RECORD_BYTES_MAX as usize);
        let mut reader = LinearReader::new_with_options(options);
        reader.add_decompressor(Zstd::default()).map_err(RecordingError::mcap(self.path))?;
        let mut head = [op::CHUNK; HEAD_BYTES as usize];
        head[1..].copy_from_slice(&(content.len() as u64).to_le_bytes());
        let mut bytes = head.chain(content);
        while let Some(event) = reader.next_event() {
            match event {
                Ok(LinearReadEvent::ReadRequest(wanted)) => {
                    let read = self.io(bytes.read(reader.insert(wanted)))?;
                    reader.notify_read(read);
                }
                Ok(LinearReadEvent::Record { opcode, data }) => {
                    if !self.parsed(opcode, data)? {
                        return Ok(false);
                    }
                }
                Err(_) => return Ok(false),
            }
        }
        Ok(true)
    }

    fn hand_on(&mut self, record: Record<'_>) -> Result<(), RecordingError> {
        match &record {
            Record::Channel(channel) => _ = self.known.insert(channel.id),
            Record::Message { header, .. } => {
                let id = header.channel_id;
                if !self.known.contains(&id) && !self.define(id)? {
                    self.unknown += 1;
                    return Ok(());
                }
                self.taken += 1;
            }
            _ => {}
        }
        (self.take)(record)
    }

    /// Hands on the definition of a channel in the summary. Returns whether there is one.
    fn define(&mut self, id: u16) -> Result<bool, RecordingError> {
        let summary = self.summary.get_or_insert_with(|| summary_section(self.path)).as_ref();
        let Some(channel) = summary.and_then(|it| it.channels.get(&id)).cloned() else {
            return Ok(false);
        };
        if let Some(schema) = channel.schema.as_deref() {
            let (name, encoding) = (schema.name.clone(), schema.encoding.clone());
            let header = SchemaHeader { id: schema.id, name, encoding };
            (self.take)(Record::Schema { header, data: schema.data.clone() })?;
        }
        self.known.insert(id);
        (self.take)(Record::Channel(mcap::records::Channel {
            id,
            schema_id: channel.schema.as_ref().map_or(0, |it| it.id),
            topic: channel.topic.clone(),
            message_encoding: channel.message_encoding.clone(),
            metadata: channel.metadata.clone(),
        }))?;
        Ok(true)
    }
}

#[cfg(test)]
#[path = "records_tests.rs"]
mod tests;
