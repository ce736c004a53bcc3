//! Reads flights, up to the last whole frame.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use flate2::{Decompress, FlushDecompress};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::{
    Beginning, Entry, FORMAT, FRAME_BYTES_MAX, FRAME_HEAD, Head, MAGIC, STATED, of_other_build,
};
use crate::exit::{Exit, Failure};
use crate::service_loop::{Program, Record};
use crate::{Effects, Event, Node, Time};

type In<P> = <<P as Program>::Node as Node>::In<'static>;
type Out<P> = <<P as Program>::Node as Node>::Out;
/// Inputs and statements of a node, as a flight of the program holds them.
type EntryOf<P> = Entry<Event<In<P>>, Effects<Out<P>, Record<P>>>;

/// The frames of a file, inflated one after another.
pub(super) struct Flight {
    path: PathBuf,
    file: BufReader<File>,
    inflate: Decompress,
    /// Content of the current frame, and how much of it has been decoded.
    frame: Vec<u8>,
    at: usize,
    /// Whether the file ends in the middle of a frame.
    pub(super) is_torn: bool,
    /// Offset of a complete but damaged frame, bytes; nothing after it can be read.
    pub(super) damaged_at: Option<u64>,
}

impl Flight {
    pub(super) fn open(path: &Path) -> Result<Self, Failure> {
        let failed = |error: io::Error| Failure::file(path, &error);
        let mut file = BufReader::new(safe_files::open_regular(path).map_err(failed)?);
        let mut start = [0; MAGIC.len() + 4];
        let read = read_up_to(&mut file, &mut start).map_err(failed)?;
        let marked = read.min(MAGIC.len());
        if start[..marked] != MAGIC[..marked] {
            let what = "expected a flight, found another file";
            let help = "help: name a flight, or a folder with none but flights in files *.flight";
            return Err(Failure::new(Exit::Config, format!("{}: {what}; {help}", path.display())));
        }
        if read < start.len() {
            return Err(empty(path));
        }
        let format = u32::from_le_bytes(start[MAGIC.len()..].try_into().unwrap_or_default());
        if format != FORMAT {
            return Err(of_other_build(
                path,
                format_args!("expected format {FORMAT}, found {format}"),
            ));
        }
        let (path, inflate) = (path.to_owned(), Decompress::new(false));
        Ok(Self { path, file, inflate, frame: Vec::new(), at: 0, is_torn: false, damaged_at: None })
    }

    /// Returns the next value of the stream and its bytes; `None` at the end.
    pub(super) fn next<T: DeserializeOwned>(&mut self) -> Result<Option<(T, &[u8])>, Failure> {
        if self.at == self.frame.len() && !self.next_frame()? {
            return Ok(None);
        }
        let bytes = &self.frame[self.at..];
        match postcard::take_from_bytes(bytes) {
            Ok((value, rest)) => {
                let begin = self.at;
                self.at = self.frame.len() - rest.len();
                Ok(Some((value, &self.frame[begin..self.at])))
            }
            Err(error) => Err(of_other_build(
                &self.path,
                format_args!("its content is of another build ({error})"),
            )),
        }
    }

    /// As [`Flight::next`] for the first entries of every flight.
    pub(super) fn first<T: DeserializeOwned>(&mut self) -> Result<T, Failure> {
        let path = self.path.clone();
        let found = self.next()?.map(|(value, _)| value);
        found.ok_or_else(|| empty(&path))
    }

    /// Returns the whole stream.
    pub(super) fn content(mut self) -> Result<Vec<u8>, Failure> {
        let mut content = Vec::new();
        while self.next_frame()? {
            content.extend_from_slice(&self.frame);
        }
        Ok(content)
    }

    /// Reads the next frame. Returns whether there is a whole one.
    fn next_frame(&mut self) -> Result<bool, Failure> {
        let begin =
            self.file.stream_position().map_err(|error| Failure::file(&self.path, &error))?;
        let mut head = [0; FRAME_HEAD];
        let read = read_up_to(&mut self.file, &mut head)
            .map_err(|error| Failure::file(&self.path, &error))?;
        self.is_torn = read > 0;
        let [len, crc] = [0, 4]
            .map(|at| u32::from_le_bytes([head[at], head[at + 1], head[at + 2], head[at + 3]]));
        if read < FRAME_HEAD {
            return Ok(false);
        }
        if len as usize > FRAME_BYTES_MAX {
            self.damaged_at = Some(begin);
            return Ok(false);
        }
        let mut content = vec![0; len as usize];
        let read = read_up_to(&mut self.file, &mut content)
            .map_err(|error| Failure::file(&self.path, &error))?;
        if read < content.len() {
            return Ok(false);
        }
        self.is_torn = crc32c::crc32c(&content) != crc || !self.inflate(&content);
        self.damaged_at = self.is_torn.then_some(begin);
        Ok(!self.is_torn)
    }

    /// Returns whether the content is a part of the stream.
    fn inflate(&mut self, content: &[u8]) -> bool {
        (self.at, self.frame) = (0, Vec::with_capacity(content.len() * 4 + 64));
        let begin = self.inflate.total_in();
        loop {
            let done = (self.inflate.total_in() - begin) as usize;
            let result = self.inflate.decompress_vec(
                &content[done..],
                &mut self.frame,
                FlushDecompress::Sync,
            );
            if result.is_err() || self.frame.len() > FRAME_BYTES_MAX {
                return false;
            }
            let is_consumed = (self.inflate.total_in() - begin) as usize == content.len();
            if is_consumed && self.frame.len() < self.frame.capacity() {
                return !self.frame.is_empty();
            }
            self.frame.reserve(self.frame.capacity().max(64));
        }
    }
}

/// A flight whose writer was killed before it recorded anything.
fn empty(path: &Path) -> Failure {
    let what = "expected a flight, found one that ends before its first frame; help: remove it";
    Failure::new(Exit::Config, format!("{}: {what}", path.display()))
}

/// Returns a note for the user on the unread part of a torn or damaged flight.
pub fn unread(is_torn: bool, damaged_at: Option<u64>) -> Option<String> {
    match damaged_at {
        Some(at) => Some(format!("damaged at byte {at}; nothing after it is read")),
        None => is_torn.then(|| "its end is unfinished; everything before it is read".to_owned()),
    }
}

/// Fills `buffer` as far as the file goes, and returns how far that is.
fn read_up_to(file: &mut impl Read, buffer: &mut [u8]) -> io::Result<usize> {
    let mut read = 0;
    while read < buffer.len() {
        match file.read(&mut buffer[read..])? {
            0 => break,
            more => read += more,
        }
    }
    Ok(read)
}

/// Returns the circumstances of a flight.
///
/// # Errors
/// The file cannot be read, or is not a flight of this format.
pub fn head(path: &Path) -> Result<Head, Failure> {
    Flight::open(path)?.first()
}

/// Source from which the node of a program was made.
pub(super) type BeginningOf<P> = Beginning<Vec<Record<P>>, Vec<u8>>;

/// Opens a flight of a program; returns its head and its beginning.
pub(super) fn open<P: Program>(path: &Path) -> Result<(Flight, Head, BeginningOf<P>), Failure> {
    let mut flight = Flight::open(path)?;
    let head: Head = flight.first()?;
    let (own, found) =
        ((P::SERVICE.name(), P::RECORD), (head.service.as_str(), head.record.as_deref()));
    if own != found {
        let what = format!("expected a flight of {own:?}, found one of {found:?}");
        return Err(of_other_build(path, what));
    }
    let beginning = flight.first()?;
    Ok((flight, head, beginning))
}

/// A step of a flight.
pub(super) enum Step<P: Program> {
    /// The event with the entry's bytes.
    Event(Time, Event<In<P>>, Vec<u8>),
    Durable,
    /// The effects with their bytes.
    Stated(Effects<Out<P>, Record<P>>, Vec<u8>),
}

/// Returns the next step.
pub(super) fn step<P: Program>(flight: &mut Flight) -> Result<Option<Step<P>>, Failure> {
    let Some((entry, bytes)) = flight.next::<EntryOf<P>>()? else { return Ok(None) };
    Ok(Some(match entry {
        Entry::Event(at, event) => Step::Event(at, event, bytes.to_vec()),
        Entry::Durable => Step::Durable,
        Entry::Stated(effects) => Step::Stated(effects, bytes.to_vec()),
    }))
}

/// The bytes that a flight has for these effects.
pub(super) fn encoded<O: Serialize, R: Serialize>(
    effects: &Effects<O, R>,
) -> Result<Vec<u8>, postcard::Error> {
    let bytes = postcard::to_stdvec(&Entry::<(), _>::Stated(effects));
    debug_assert!(bytes.as_ref().is_ok_and(|bytes| bytes.first() == Some(&STATED)));
    bytes
}

/// Whether a service was given something or stated it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// An event.
    In,
    /// A record or an output.
    Out,
}

/// A step of a flight as JSON, for other programs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Line {
    /// Number of the pass, from 1.
    pub pass: u64,
    /// Time, nanoseconds of the monotonic clock.
    pub at_ns: u64,
    /// Direction of the step.
    pub direction: Direction,
    /// The event, or the effects.
    pub value: serde_json::Value,
}

/// Hands every step of a flight to `take`. Returns a note on the unread part, if any.
///
/// # Errors
/// The file cannot be read, or is of another build; or `take` fails.
pub fn lines<P: Program>(
    path: &Path,
    mut take: impl FnMut(Line) -> Result<(), Failure>,
) -> Result<Option<String>, Failure> {
    let (mut flight, head, _) = open::<P>(path)?;
    let (mut pass, mut at_ns) = (1, head.started.ns());
    let json = |value: Result<serde_json::Value, serde_json::Error>| {
        value.map_err(|error| Failure::output(error.into()))
    };
    while let Some(step) = step::<P>(&mut flight)? {
        match step {
            Step::Event(at, event, _) => {
                at_ns = at.ns();
                let value = json(serde_json::to_value(&event))?;
                take(Line { pass, at_ns, direction: Direction::In, value })?;
            }
            Step::Durable => {}
            Step::Stated(effects, _) => {
                if !effects.is_empty() {
                    let value = json(serde_json::to_value(&effects))?;
                    take(Line { pass, at_ns, direction: Direction::Out, value })?;
                }
                pass += 1;
            }
        }
    }
    Ok(unread(flight.is_torn, flight.damaged_at))
}
