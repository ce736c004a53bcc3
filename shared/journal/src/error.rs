//! What can go wrong, one enum per operation. Each message ends with the cure.

use std::io;

/// Why a journal cannot be opened or read.
#[derive(Debug, thiserror::Error)]
pub enum JournalOpenError {
    /// Another process writes it.
    #[error("another process{} writes this journal; stop it first", by(*pid))]
    Locked {
        /// The other process, where the lock file names it.
        pid: Option<u32>,
    },
    /// The file does not begin like a journal.
    #[error("this is not a journal; move the file away or set it aside to start anew")]
    NotAJournal,
    /// Written in another format of the file itself.
    #[error(
        "the journal has format {found}, this version reads format {expected}; \
         start the version that wrote it, or set the journal aside to start anew"
    )]
    Format {
        /// Format number of the file.
        found: u32,
        /// Format number of this version, [`FORMAT`](crate::FORMAT).
        expected: u32,
    },
    /// Holds records of another kind or layout.
    #[error(
        "the journal holds records `{found}` with schema {found_schema:016x}, this version writes \
         `{expected}` with schema {expected_schema:016x}; start the version that wrote it, or set \
         the journal aside to start anew"
    )]
    Record {
        /// Kind of record in the file.
        found: String,
        /// Its schema key.
        found_schema: u64,
        /// Kind of record of the caller.
        expected: String,
        /// Its schema key.
        expected_schema: u64,
    },
    /// Belongs to another group.
    #[error(
        "the journal belongs to group `{found}`, this is group `{expected}`; \
         give each group its own state folder"
    )]
    Group {
        /// Group of the file.
        found: String,
        /// Group of the caller.
        expected: String,
    },
    /// Written in another epoch of the group.
    #[error(
        "the journal is of epoch {found}, the group is in epoch {expected}; \
         set the journal aside to join this epoch"
    )]
    Epoch {
        /// Epoch of the file.
        found: u64,
        /// Epoch of the caller.
        expected: u64,
    },
    /// Written for another scene.
    #[error(
        "the journal was written for another scene (key {found:016x}, now {expected:016x}); \
         go back to that scene, or set the journal aside to start anew"
    )]
    Scene {
        /// Scene key of the file.
        found: u64,
        /// Scene key of the caller.
        expected: u64,
    },
    /// Damaged in a part that had been acknowledged.
    #[error(
        "the journal is damaged at byte {at}, before record {seq}, with valid records after it; \
         inspect it, then set it aside to start anew"
    )]
    Corrupt {
        /// Offset of the first damaged byte's frame.
        at: u64,
        /// Number of the first record that cannot be read.
        seq: u64,
    },
    /// An undamaged frame whose records do not decode: two layouts share one schema key.
    #[error(
        "the records from {seq} on (byte {at}) are whole but not of this layout; \
         start the version that wrote them, or set the journal aside to start anew"
    )]
    Undecodable {
        /// Offset of the frame.
        at: u64,
        /// Number of its first record.
        seq: u64,
    },
    /// The operating system refused.
    #[error("cannot {doing}: {source}")]
    Io {
        /// What was tried.
        doing: &'static str,
        /// Why it failed.
        source: io::Error,
    },
}

/// Why a record cannot be appended. The journal is as before.
#[derive(Debug, thiserror::Error)]
pub enum AppendError {
    /// The record does not encode.
    #[error("the record does not encode: {0}")]
    Encode(#[from] postcard::Error),
    /// More than one frame may hold.
    #[error("{bytes} bytes between two syncs, at most {max} fit; sync more often")]
    TooLarge {
        /// Encoded size of the unsynced records with this one.
        bytes: usize,
        /// [`BODY_BYTES_MAX`](crate::BODY_BYTES_MAX).
        max: usize,
    },
}

/// Why appended records did not become durable.
#[derive(Debug, thiserror::Error)]
pub enum SyncError {
    /// No space. The file is as before and the records wait in memory: free space, sync again.
    #[error("no space for the journal: {0}; free some and sync again")]
    Full(io::Error),
    /// The write failed. The file is as before and the records wait in memory.
    #[error("cannot write the journal: {0}")]
    Write(io::Error),
    /// It is unknown what reached the disk; this journal takes nothing more. Opening it anew
    /// finds out.
    #[error("it is unknown what of the journal reached the disk ({0}); open it anew")]
    Unknown(io::Error),
    /// An earlier operation ended with [`SyncError::Unknown`].
    #[error("the journal failed before and takes no more records; open it anew")]
    Poisoned,
}

/// Why a journal could not be rotated.
#[derive(Debug, thiserror::Error)]
pub enum RotateError {
    /// The snapshot does not fit or encode; the old journal goes on.
    #[error("snapshot: {0}")]
    Snapshot(#[from] AppendError),
    /// What was appended before could not be synced; the old journal goes on unless the cause says
    /// otherwise.
    #[error(transparent)]
    Sync(#[from] SyncError),
    /// The new file could not be put in place; the old journal goes on.
    #[error("cannot {doing}: {source}; the old journal goes on")]
    Io {
        /// What was tried.
        doing: &'static str,
        /// Why it failed.
        source: io::Error,
    },
}

impl JournalOpenError {
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
