//! Errors, one enum per operation. Messages end with advice to the operator.

use std::io;

/// Way out for a journal that another version wrote.
pub(crate) const FRESH: &str = "help: start the version that wrote it, or start over with `whichone up \
                     --fresh`, which keeps the old file";

/// Failure to open or read a journal.
#[derive(Debug, thiserror::Error)]
pub enum JournalOpenError {
    /// Another process holds the lock.
    #[error("the journal is locked by another process{}; help: stop that process", by(*pid))]
    Locked {
        /// The other process, if the lock file names it.
        pid: Option<u32>,
    },
    /// The file is missing.
    #[error("the file is missing")]
    Missing,
    /// The file has no bytes; a journal has some from its first moment.
    #[error("the file is empty")]
    Empty,
    /// The file does not begin like a journal.
    #[error("not a journal")]
    NotAJournal,
    /// Another owner, epoch, kind of record or version of the format; with the way out.
    #[error("{0}")]
    Foreign(String),
    /// Another journal of the same service.
    #[error("expected generation {expected}, found {found}: a journal that was set aside")]
    Generation {
        /// The one in use.
        expected: u64,
        /// Version of the file.
        found: u64,
    },
    /// Damage to acknowledged records.
    #[error("damaged at byte {at}: record {seq} and what may follow it cannot be read")]
    Corrupt {
        /// Offset of the first damaged frame.
        at: u64,
        /// Number of the first record that cannot be read.
        seq: u64,
    },
    /// A valid frame whose records do not decode: two layouts share one record kind.
    #[error("records from {seq} on (byte {at}) have another layout; {FRESH}")]
    Undecodable {
        /// Offset of the frame.
        at: u64,
        /// Number of the first record.
        seq: u64,
    },
    /// Failure of the operating system.
    #[error("cannot {doing}: {source}")]
    Io {
        /// Attempted operation.
        doing: &'static str,
        /// Cause.
        source: io::Error,
    },
}

/// Failure to append a record. The journal is unchanged.
#[derive(Debug, thiserror::Error)]
pub enum AppendError {
    /// The record does not encode.
    #[error("the record does not encode: {0}")]
    Encode(#[from] postcard::Error),
    /// Exceeds the capacity of one frame.
    #[error("{bytes} bytes between two syncs exceed the limit of {max}; help: sync more often")]
    TooLarge {
        /// Encoded size of the unsynced records with this one.
        bytes: usize,
        /// [`BODY_BYTES_MAX`](crate::BODY_BYTES_MAX).
        max: usize,
    },
}

/// Failure to make appended records durable.
#[derive(Debug, thiserror::Error)]
pub enum SyncError {
    /// No space left. The file is unchanged and records stay in memory: free space and sync again.
    #[error("no space for the journal: {0}; help: free some space")]
    Full(io::Error),
    /// Failed write. The file is unchanged and the records stay in memory.
    #[error("cannot write the journal: {0}")]
    Write(io::Error),
    /// Unknown state of the file on disk; the journal accepts no more records until it is reopened.
    #[error("unknown how much of the journal reached the disk ({0}); help: reopen it")]
    Unknown(io::Error),
    /// An earlier operation ended with [`SyncError::Unknown`].
    #[error("the journal failed earlier and accepts no more records; help: reopen it")]
    Poisoned,
}

/// Failure to rotate a journal.
#[derive(Debug, thiserror::Error)]
pub enum RotateError {
    /// The snapshot does not fit or encode; the old journal stays in use.
    #[error("snapshot: {0}")]
    Snapshot(#[from] AppendError),
    /// Pending records could not be synced; the old journal stays in use unless the source is
    /// [`SyncError::Unknown`].
    #[error(transparent)]
    Sync(#[from] SyncError),
    /// The new file could not be installed; the old journal stays in use.
    #[error("cannot {doing}: {source}; the old journal stays in use")]
    Io {
        /// Attempted operation.
        doing: &'static str,
        /// Cause.
        source: io::Error,
    },
}

impl JournalOpenError {
    /// Returns whether the journal is lost or damaged: a restart changes nothing, and the one way
    /// out is to set it aside.
    pub fn is_lost(&self) -> bool {
        use JournalOpenError::{Corrupt, Empty, Generation, Missing, NotAJournal};
        matches!(self, Missing | Empty | NotAJournal | Generation { .. } | Corrupt { .. })
    }

    pub(crate) fn io(doing: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io { doing, source }
    }
}

impl SyncError {
    pub(crate) fn of_write(error: io::Error) -> Self {
        use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        match error.kind() {
            StorageFull | QuotaExceeded | FileTooLarge => Self::Full(error),
            _ => Self::Write(error),
        }
    }
}

fn by(pid: Option<u32>) -> String {
    pid.map_or_else(String::new, |pid| format!(" (pid {pid})"))
}
