//! The writing end: queues records until a sync makes them durable as one frame.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

use rustix::fs::{FallocateFlags, fallocate};
use rustix::io::Errno;
use serde::Serialize;

use crate::frame::{self, BODY_BYTES_MAX};
use crate::scan::Position;
use crate::{AppendError, SyncError};

/// Space that a journal keeps after its end for vital records, bytes.
const RESERVE_BYTES: u64 = 32 << 10;

/// File operations of the journal; tests inject disk faults here.
pub(crate) trait Storage {
    fn write_at(&mut self, bytes: &[u8], at: u64) -> io::Result<()>;
    fn truncate(&mut self, len: u64) -> io::Result<()>;
    fn sync(&mut self) -> io::Result<()>;
    /// Takes space for the bytes from `at` to `until`, beyond the end of the file.
    fn reserve(&mut self, at: u64, until: u64) -> io::Result<()>;
}

impl Storage for File {
    fn write_at(&mut self, bytes: &[u8], at: u64) -> io::Result<()> {
        self.write_all_at(bytes, at)
    }

    fn truncate(&mut self, len: u64) -> io::Result<()> {
        self.set_len(len)
    }

    fn sync(&mut self) -> io::Result<()> {
        self.sync_data()
    }

    fn reserve(&mut self, at: u64, until: u64) -> io::Result<()> {
        match fallocate(&*self, FallocateFlags::KEEP_SIZE, at, until - at) {
            // A file system that cannot reserve: a write shows whether there is space.
            Err(Errno::OPNOTSUPP | Errno::NOSYS | Errno::INVAL) => Ok(()),
            result => Ok(result?),
        }
    }
}

/// The end of a file that is being written.
#[derive(Debug)]
pub(crate) struct Tail<S> {
    storage: S,
    position: Position,
    waiting: Batch,
    /// Offset up to which the file system has given space.
    reserved: u64,
    poisoned: bool,
}

impl<S: Storage> Tail<S> {
    pub(crate) fn new(storage: S, position: Position) -> Self {
        let waiting = Batch::default();
        let mut tail = Self { storage, position, waiting, reserved: 0, poisoned: false };
        // On a full disk the records can be read anyway, and the next sync reports the shortage.
        let _ = tail.reserve(position.end);
        tail
    }

    /// The end of a file that was there before, cut to `position`. A killed writer may have written
    /// without syncing, so the file's content is not trusted before this succeeds.
    pub(crate) fn resume(mut storage: S, position: Position, torn: bool) -> io::Result<Self> {
        if torn {
            storage.truncate(position.end)?;
        }
        storage.sync()?;
        Ok(Self::new(storage, position))
    }

    pub(crate) fn position(&self) -> Position {
        self.position
    }

    /// Queues all records or none.
    pub(crate) fn append_all<R: Serialize>(&mut self, records: &[R]) -> Result<(), AppendError> {
        let before = (self.waiting.count, self.waiting.records.len());
        records.iter().try_for_each(|record| self.waiting.push(record)).inspect_err(|_| {
            self.waiting.count = before.0;
            self.waiting.records.truncate(before.1);
        })
    }

    /// Rejects further records: the content of the disk is unknown.
    pub(crate) fn poison(&mut self) {
        self.poisoned = true;
    }

    /// One write, one sync. On a failed write or sync the file is cut back, because a second sync
    /// would report success for pages that the first one already gave up, and after a failed sync
    /// no more records are accepted.
    ///
    /// Without `vital`, nothing is written unless the reserve stays whole.
    pub(crate) fn sync(&mut self, vital: bool) -> Result<(), SyncError> {
        if self.poisoned {
            return Err(SyncError::Poisoned);
        }
        if self.waiting.count == 0 {
            return Ok(());
        }
        let Position { end, next_seq, prev_crc } = self.position;
        let (bytes, crc) = frame::seal(end, next_seq, prev_crc, &self.waiting.body());
        let after = end + bytes.len() as u64;
        if let Err(error) = self.reserve(after)
            && !(vital && after <= self.reserved)
        {
            return Err(SyncError::of_write(error));
        }
        if let Err(error) = self.storage.write_at(&bytes, end) {
            return Err(self.cut_back(end, SyncError::of_write(error)));
        }
        if let Err(error) = self.storage.sync() {
            self.poisoned = true;
            return Err(self.cut_back(end, SyncError::Unknown(error)));
        }
        self.position =
            Position { end: after, next_seq: next_seq + self.waiting.count as u64, prev_crc: crc };
        self.waiting = Batch::default();
        Ok(())
    }

    /// Keeps [`RESERVE_BYTES`] of space after `end`.
    fn reserve(&mut self, end: u64) -> io::Result<()> {
        if end + RESERVE_BYTES > self.reserved {
            // In larger steps than frames, which need not ask every time.
            let until = end + 2 * RESERVE_BYTES;
            self.storage.reserve(self.position.end, until)?;
            self.reserved = until;
        }
        Ok(())
    }

    fn cut_back(&mut self, end: u64, error: SyncError) -> SyncError {
        // A file that is cut gives up the space after its end.
        self.reserved = 0;
        match self.storage.truncate(end) {
            Ok(()) => error,
            Err(truncate) => {
                self.poisoned = true;
                SyncError::Unknown(truncate)
            }
        }
    }
}

/// Encoded records on their way into one frame.
#[derive(Debug, Default)]
pub(crate) struct Batch {
    count: usize,
    records: Vec<u8>,
}

/// Bytes of the longest count before the records.
const COUNT_BYTES_MAX: usize = 10;

impl Batch {
    pub(crate) fn push<R: Serialize>(&mut self, record: &R) -> Result<(), AppendError> {
        let encoded = postcard::to_stdvec(record)?;
        let bytes = self.records.len() + encoded.len() + COUNT_BYTES_MAX;
        if bytes > BODY_BYTES_MAX {
            return Err(AppendError::TooLarge { bytes, max: BODY_BYTES_MAX });
        }
        self.records.extend_from_slice(&encoded);
        self.count += 1;
        Ok(())
    }

    /// Returns the postcard encoding of a sequence of the records.
    pub(crate) fn body(&self) -> Vec<u8> {
        let mut buffer = [0; COUNT_BYTES_MAX];
        let count = postcard::to_slice(&self.count, &mut buffer).expect("a count fits");
        [&*count, &self.records].concat()
    }
}
