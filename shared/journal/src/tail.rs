//! The writing end: queues records until a sync makes them durable as one frame.

use std::fs::File;
use std::io;
use std::os::unix::fs::FileExt;

use serde::Serialize;

use crate::frame::{self, BODY_BYTES_MAX};
use crate::scan::Position;
use crate::{AppendError, SyncError};

/// File operations of the journal; tests inject disk faults here.
pub(crate) trait Storage {
    fn write_at(&mut self, bytes: &[u8], at: u64) -> io::Result<()>;
    fn truncate(&mut self, len: u64) -> io::Result<()>;
    fn sync(&mut self) -> io::Result<()>;
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
}

/// The end of a file that is being written.
#[derive(Debug)]
pub(crate) struct Tail<S> {
    storage: S,
    position: Position,
    waiting: Batch,
    poisoned: bool,
}

impl<S: Storage> Tail<S> {
    pub(crate) fn new(storage: S, position: Position) -> Self {
        Self { storage, position, waiting: Batch::default(), poisoned: false }
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

    pub(crate) fn append<R: Serialize>(&mut self, record: &R) -> Result<(), AppendError> {
        self.waiting.push(record)
    }

    /// Rejects further records: the content of the disk is unknown.
    pub(crate) fn poison(&mut self) {
        self.poisoned = true;
    }

    /// One write, one sync. On a failed write the file is cut back to what it was; on a failed sync
    /// it is cut back too, because a second sync would report success for pages that the first one
    /// already gave up, and then no more records are accepted.
    pub(crate) fn sync(&mut self) -> Result<(), SyncError> {
        if self.poisoned {
            return Err(SyncError::Poisoned);
        }
        if self.waiting.count == 0 {
            return Ok(());
        }
        let Position { end, next_seq, prev_crc } = self.position;
        let (bytes, crc) = frame::seal(next_seq, prev_crc, &self.waiting.body());
        if let Err(error) = self.storage.write_at(&bytes, end) {
            return Err(self.cut_back(end, SyncError::of_write(error)));
        }
        if let Err(error) = self.storage.sync() {
            self.poisoned = true;
            return Err(self.cut_back(end, SyncError::Unknown(error)));
        }
        self.position = Position {
            end: end + bytes.len() as u64,
            next_seq: next_seq + self.waiting.count as u64,
            prev_crc: crc,
        };
        self.waiting = Batch::default();
        Ok(())
    }

    fn cut_back(&mut self, end: u64, error: SyncError) -> SyncError {
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
