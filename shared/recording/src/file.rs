//! A recording being written.

use std::cell::Cell;
use std::collections::{BTreeMap, HashMap};
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Seek, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, Compression, WriteOptions, Writer};

use crate::channels::{Channel, ChannelId, message_encoding};
use crate::clock::{self, WallClock};
use crate::{EXTENSION, RecordingError, UNFINISHED};

/// Bytes of messages that are compressed together, unless a flush comes first. A writer that is
/// killed loses those of the open chunk.
const CHUNK_BYTES: u64 = 256 << 10;
/// Key of the metadata for the number of a recording in its folder.
pub(crate) const NUMBER: &str = "number";
/// Mode of a recording: readable by its owner alone, as it holds people's words.
const PRIVATE: u32 = 0o600;

/// Files that every recording holds.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Attached {
    /// Name, media type and text of each.
    pub files: Vec<(String, &'static str, String)>,
    /// Properties of the recorded group.
    pub group: BTreeMap<String, String>,
}

/// Options of every file.
pub(crate) fn options() -> WriteOptions {
    WriteOptions::new()
        .profile("")
        .library(format!("whichone {}", build_info::full_version()))
        .compression(Some(Compression::Lz4))
        .chunk_size(Some(CHUNK_BYTES))
        // A chunk is written whole or not at all.
        .disable_seeking(true)
}

/// Counts the bytes that are written to a file.
#[derive(Debug)]
struct Counted {
    file: BufWriter<File>,
    bytes: Rc<Cell<u64>>,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.bytes.set(self.bytes.get() + written as u64);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for Counted {
    fn seek(&mut self, to: io::SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

/// Creates a file that only its owner can read.
pub(crate) fn create_private(path: &Path) -> Result<File, RecordingError> {
    let mut options = OpenOptions::new();
    let options = options.write(true).create_new(true).mode(PRIVATE);
    options.open(path).map_err(RecordingError::io(path))
}

/// Returns whether a recorder is writing the file.
pub(crate) fn is_locked(path: &Path) -> bool {
    File::open(path)
        .is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

/// A recording that is being written; its file is locked. One that is dropped instead of finished
/// is complete in its chunks, but keeps its unfinished name.
pub struct Recording {
    writer: Writer<Counted>,
    bytes: Rc<Cell<u64>>,
    path: PathBuf,
    clock: WallClock,
    began_ns: u64,
    /// Number of each channel in this file.
    channels: HashMap<ChannelId, u16>,
    messages: u64,
}

impl Recording {
    /// Begins a recording in `folder`, at a moment in nanoseconds since 1970. Its number is greater
    /// than those of the files before it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn begin(
        folder: &Path,
        number: u64,
        now_ns: u64,
        clock: WallClock,
        attached: &Attached,
    ) -> Result<Self, RecordingError> {
        let path = folder.join(format!("{}.{UNFINISHED}", clock::name(now_ns)));
        let file = create_private(&path)?;
        // Held until the file is closed, also by the death of this process.
        file.lock().map_err(RecordingError::io(&path))?;
        let file = BufWriter::new(file);
        let bytes = Rc::new(Cell::new(0));
        let writer = options().create(Counted { file, bytes: Rc::clone(&bytes) });
        let writer = writer.map_err(RecordingError::mcap(&path))?;
        let channels = HashMap::new();
        let mut recording =
            Self { writer, bytes, path, clock, began_ns: now_ns, channels, messages: 0 };
        recording.attach(number, attached)?;
        Ok(recording)
    }

    fn attach(&mut self, number: u64, attached: &Attached) -> Result<(), RecordingError> {
        let Self { writer, path, clock, began_ns, .. } = self;
        let mut metadata = attached.group.clone();
        metadata.insert("wall_minus_monotonic_ns".to_owned(), clock.offset_ns.to_string());
        metadata.insert(NUMBER.to_owned(), number.to_string());
        let metadata = Metadata { name: "whichone".to_owned(), metadata };
        writer.write_metadata(&metadata).map_err(RecordingError::mcap(path))?;
        for (name, media_type, text) in &attached.files {
            let attachment = Attachment {
                log_time: *began_ns,
                create_time: *began_ns,
                name: name.clone(),
                media_type: (*media_type).to_owned(),
                data: text.as_bytes().into(),
            };
            writer.attach(&attachment).map_err(RecordingError::mcap(path))?;
        }
        Ok(())
    }

    /// Adds a message. Its times are nanoseconds since 1970, `sequence` is that of its writer.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(
        &mut self,
        (id, channel): (ChannelId, &Channel),
        sequence: u32,
        at_ns: u64,
        data: &[u8],
    ) -> Result<(), RecordingError> {
        let channel_id = match self.channels.get(&id) {
            Some(channel_id) => *channel_id,
            None => self.add(id, channel)?,
        };
        let header = MessageHeader { channel_id, sequence, log_time: at_ns, publish_time: at_ns };
        self.messages += 1;
        let written = self.writer.write_to_known_channel(&header, data);
        written.map_err(RecordingError::mcap(&self.path))
    }

    fn add(&mut self, id: ChannelId, channel: &Channel) -> Result<u16, RecordingError> {
        let Channel { topic, schema, schema_encoding, definition, .. } = channel;
        let Self { writer, path, channels, .. } = self;
        let schema = writer.add_schema(schema, schema_encoding, definition.as_bytes());
        let number = schema.and_then(|schema| {
            writer.add_channel(schema, topic, message_encoding(schema_encoding), &BTreeMap::new())
        });
        let number = number.map_err(RecordingError::mcap(path))?;
        channels.insert(id, number);
        Ok(number)
    }

    /// Hands the data so far to the operating system: they outlive this process.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn flush(&mut self) -> Result<(), RecordingError> {
        self.writer.flush().map_err(RecordingError::mcap(&self.path))
    }

    /// Completes the file and gives it its name.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn finish(mut self) -> Result<PathBuf, RecordingError> {
        self.writer.finish().map_err(RecordingError::mcap(&self.path))?;
        let Self { writer, path, .. } = self;
        writer.into_inner().flush().map_err(RecordingError::io(&path))?;
        finished(&path)
    }

    /// Returns the recording's start, nanoseconds since 1970.
    pub fn began_ns(&self) -> u64 {
        self.began_ns
    }

    /// Returns the clock of the messages.
    pub fn clock(&self) -> WallClock {
        self.clock
    }

    /// Bytes of closed chunks and attachments so far.
    pub fn bytes(&self) -> u64 {
        self.bytes.get()
    }

    /// Messages so far.
    pub fn messages(&self) -> u64 {
        self.messages
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

/// Gives a complete file its final name.
pub(crate) fn finished(path: &Path) -> Result<PathBuf, RecordingError> {
    let name = path.to_string_lossy();
    let stem = name.strip_suffix(&format!(".{UNFINISHED}")).unwrap_or(&name);
    let to = PathBuf::from(format!("{stem}.{EXTENSION}"));
    fs::rename(path, &to).map_err(RecordingError::io(path))?;
    Ok(to)
}
