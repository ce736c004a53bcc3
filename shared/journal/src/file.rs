//! The journal on disk: open, append, sync, rotate, read.

use std::fs::{File, OpenOptions};
use std::io::{self, Read};
use std::marker::PhantomData;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::header::{self, Header, StoredHeader};
use crate::lock::Lock;
use crate::rotate::{self, KEPT, Step};
use crate::scan::{self, Ending, Position, Scan};
use crate::tail::{Batch, Tail};
use crate::{AppendError, JournalOpenError, RotateError, SyncError, frame};

/// The only writer of a journal. Unsynced records are lost when it is dropped.
#[derive(Debug)]
pub struct Journal<R> {
    path: PathBuf,
    header: Header,
    tail: Tail<File>,
    _lock: Lock,
    _record: PhantomData<fn(&R)>,
}

/// Contents found by [`Journal::open`]. All of it is durable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recovered<R> {
    /// Every record of the file, oldest first; a file that was rotated starts with its snapshot.
    pub records: Vec<R>,
    /// Number of the first of them: 1, or more after a rotation.
    pub first_seq: u64,
    /// Bytes of an unacknowledged write that were cut off.
    pub truncated_bytes: u64,
}

/// Owner and ending of a journal as found by [`inspect`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Inspection {
    /// Owner and kind.
    pub header: Header,
    /// The ending of the file.
    pub ending: Ending,
}

/// Contents found by [`read`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reading<R> {
    /// Owner and kind.
    pub header: Header,
    /// Every record up to the ending, oldest first.
    pub records: Vec<R>,
    /// Number of the first of these records.
    pub first_seq: u64,
    /// The ending of the file.
    pub ending: Ending,
}

impl<R: Serialize + DeserializeOwned> Journal<R> {
    /// Opens the journal at `path`. Records that a killed writer left unsynced are synced before
    /// this returns, so every recovered record may be acted on.
    ///
    /// # Errors
    /// See [`JournalOpenError`]; the file is left as it is.
    pub fn open(path: &Path, header: &Header) -> Result<(Self, Recovered<R>), JournalOpenError> {
        Self::open_with(path, header, |_| Err(JournalOpenError::Missing))
    }

    /// As [`Journal::open`], but also takes over a journal of one of the `older` kinds, whose
    /// records decode as present ones. The file states the present kind from its next rotation on.
    ///
    /// # Errors
    /// See [`JournalOpenError`]; the file is left as it is.
    pub fn take_over(
        path: &Path,
        header: &Header,
        older: &[&str],
    ) -> Result<(Self, Recovered<R>), JournalOpenError> {
        let found = load(path).and_then(|bytes| header::decode(&bytes));
        let record = found.map(|stored| stored.header.record).ok();
        let Some(record) = record.filter(|record| older.contains(&record.as_str())) else {
            return Self::open(path, header);
        };
        let (journal, recovered) = Self::open(path, &Header { record, ..header.clone() })?;
        Ok((Self { header: header.clone(), ..journal }, recovered))
    }

    /// As [`Journal::open`], but makes a new journal if the file is missing. The folder must exist.
    ///
    /// # Errors
    /// See [`JournalOpenError`]; the file is left as it is.
    pub fn open_or_create(
        path: &Path,
        header: &Header,
    ) -> Result<(Self, Recovered<R>), JournalOpenError> {
        Self::open_with(path, header, |path| create(path, header))
    }

    fn open_with(
        path: &Path,
        header: &Header,
        absent: impl FnOnce(&Path) -> Result<(Tail<File>, Recovered<R>), JournalOpenError>,
    ) -> Result<(Self, Recovered<R>), JournalOpenError> {
        let lock = Lock::take(path)?;
        rotate::clear_unfinished(path)
            .map_err(JournalOpenError::io("clear an unfinished rotation"))?;
        let (tail, recovered) = match load(path) {
            Err(JournalOpenError::Missing) => absent(path)?,
            bytes => recover(path, header, &bytes?)?,
        };
        let journal = Self {
            path: path.to_owned(),
            header: header.clone(),
            tail,
            _lock: lock,
            _record: PhantomData,
        };
        Ok((journal, recovered))
    }

    /// Queues a record for the next sync. Not durable yet.
    ///
    /// # Errors
    /// See [`AppendError`]; the record is not queued.
    pub fn append(&mut self, record: &R) -> Result<(), AppendError> {
        self.append_all(std::slice::from_ref(record))
    }

    /// As [`Journal::append`], all of them or none.
    ///
    /// # Errors
    /// See [`AppendError`]; no record is queued.
    pub fn append_all(&mut self, records: &[R]) -> Result<(), AppendError> {
        self.tail.append_all(records)
    }

    /// Makes everything appended so far durable, with one write and one `fdatasync`, as a whole.
    /// Does nothing if no record is queued.
    ///
    /// # Errors
    /// See [`SyncError`]; no record may be acted on.
    pub fn sync(&mut self) -> Result<(), SyncError> {
        self.tail.sync(false)
    }

    /// As [`Journal::sync`], on a full disk with the space that the journal keeps in reserve: for
    /// records that protect people.
    ///
    /// # Errors
    /// As [`Journal::sync`].
    pub fn sync_with_reserve(&mut self) -> Result<(), SyncError> {
        self.tail.sync(true)
    }

    /// Continues in a new file that starts with `snapshot`; the old one is kept as `<name>.1`.
    /// Queued records are synced into the old file first. Numbering continues. A crash at any
    /// moment leaves either the old or the new journal.
    ///
    /// # Errors
    /// See [`RotateError`].
    pub fn rotate(&mut self, snapshot: &[R]) -> Result<(), RotateError> {
        self.rotate_until(snapshot, |_| Ok(()))
    }

    /// As [`Journal::rotate`], but keeps no older file: records outside the snapshot are gone. A
    /// crash in between may leave older ones, until this is done again.
    ///
    /// # Errors
    /// See [`RotateError`].
    pub fn erase(&mut self, snapshot: &[R]) -> Result<(), RotateError> {
        self.rotate(snapshot)?;
        rotate::remove_old(&self.path)
            .map_err(|source| RotateError::Io { doing: "remove the old journals", source })
    }

    pub(crate) fn rotate_until(
        &mut self,
        snapshot: &[R],
        before: impl FnMut(Step) -> io::Result<()>,
    ) -> Result<(), RotateError> {
        self.tail.sync(false)?;
        let (bytes, position) = compose(&self.header, self.next_seq(), snapshot)?;
        match rotate::replace(&self.path, &bytes, KEPT, before) {
            Ok(file) => self.tail = Tail::new(file, position),
            Err((Step::SyncFolder, error)) => {
                self.tail.poison();
                return Err(SyncError::Unknown(error).into());
            }
            Err((step, source)) => return Err(RotateError::Io { doing: step.doing(), source }),
        }
        Ok(())
    }

    /// Number that the next record synced gets.
    pub fn next_seq(&self) -> u64 {
        self.tail.position().next_seq
    }

    /// Bytes of the file that are durable.
    pub fn bytes(&self) -> u64 {
        self.tail.position().end
    }
}

/// Reads a journal without locking it, even while its writer lives or if it is damaged.
///
/// # Errors
/// Another header or record layout; damage is reported by [`Reading::ending`].
pub fn read<R: DeserializeOwned>(path: &Path) -> Result<Reading<R>, JournalOpenError> {
    let bytes = load(path)?;
    let stored = header::decode(&bytes)?;
    let Scan { records, ending, .. } = scan::scan(&bytes, &stored)?;
    Ok(Reading { header: stored.header, records, first_seq: stored.first_seq, ending })
}

/// As [`read`], for those who do not know the records.
///
/// # Errors
/// No journal, or one of another format; damage is reported by [`Inspection::ending`].
pub fn inspect(path: &Path) -> Result<Inspection, JournalOpenError> {
    let bytes = load(path)?;
    let stored = header::decode(&bytes)?;
    let (_, ending) = scan::scan_frames(&bytes, &stored, scan::count)?;
    Ok(Inspection { header: stored.header, ending })
}

/// Reads a regular file: the end of a pipe or a device may never come.
fn load(path: &Path) -> Result<Vec<u8>, JournalOpenError> {
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => JournalOpenError::Missing,
        io::ErrorKind::InvalidData => JournalOpenError::NotAJournal,
        _ => JournalOpenError::io("read the journal")(error),
    };
    let mut bytes = Vec::new();
    safe_files::open_regular(path)
        .and_then(|mut file| file.read_to_end(&mut bytes))
        .map_err(failed)?;
    Ok(bytes)
}

fn create<R: Serialize>(
    path: &Path,
    header: &Header,
) -> Result<(Tail<File>, Recovered<R>), JournalOpenError> {
    let (bytes, position) =
        compose::<R>(header, 1, &[]).expect("a header without records always encodes");
    let file = rotate::replace(path, &bytes, 0, |_| Ok(()))
        .map_err(|(step, source)| JournalOpenError::Io { doing: step.doing(), source })?;
    let recovered = Recovered { records: Vec::new(), first_seq: 1, truncated_bytes: 0 };
    Ok((Tail::new(file, position), recovered))
}

fn recover<R: DeserializeOwned>(
    path: &Path,
    header: &Header,
    bytes: &[u8],
) -> Result<(Tail<File>, Recovered<R>), JournalOpenError> {
    let stored = header::decode(bytes)?;
    stored.header.check(header)?;
    let Scan { records, position, ending } = scan::scan(bytes, &stored)?;
    let truncated_bytes = match ending {
        Ending::Whole => 0,
        Ending::Torn { bytes, .. } => bytes,
        Ending::Corrupt { at, seq, .. } => return Err(JournalOpenError::Corrupt { at, seq }),
    };
    let io = JournalOpenError::io;
    let file = OpenOptions::new().write(true).open(path).map_err(io("open the journal"))?;
    let tail = Tail::resume(file, position, truncated_bytes > 0).map_err(io("sync the journal"))?;
    // A killed writer may also have put a new file in place without syncing the folder.
    rotate::sync_folder(path).map_err(io("sync the journal's folder"))?;
    let first_seq = stored.first_seq;
    Ok((tail, Recovered { records, first_seq, truncated_bytes }))
}

/// Composes the bytes of a new file; returns them with the position of its next frame.
fn compose<R: Serialize>(
    header: &Header,
    first_seq: u64,
    snapshot: &[R],
) -> Result<(Vec<u8>, Position), AppendError> {
    let count = snapshot.len() as u64;
    let (mut bytes, crc) = header::encode(header, first_seq, count)?;
    let (header, len) = (header.clone(), bytes.len());
    let stored = StoredHeader { header, first_seq, snapshot: count, crc, len };
    let mut position = Position::after(&stored);
    if !snapshot.is_empty() {
        let mut batch = Batch::default();
        snapshot.iter().try_for_each(|record| batch.push(record))?;
        let (sealed, crc) = frame::seal(bytes.len() as u64, first_seq, crc, &batch.body());
        bytes.extend_from_slice(&sealed);
        position = Position { end: bytes.len() as u64, next_seq: first_seq + count, prev_crc: crc };
    }
    Ok((bytes, position))
}
