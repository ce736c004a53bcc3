//! One writer per journal: a lock on a file beside it, held for life. The journal itself cannot
//! carry the lock because a rotation puts another file in its place.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use crate::JournalOpenError;

/// Who holds a journal's lock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LockHolder {
    /// The process, where the lock file names it.
    pub pid: Option<u32>,
}

/// Who writes the journal at `path` now; `None` where nobody does. It takes the lock for a moment,
/// so ask only while no service that owns it is being started.
///
/// # Errors
/// Where the lock file exists but cannot be opened.
pub fn lock_holder(path: &Path) -> io::Result<Option<LockHolder>> {
    let file = match File::open(lock_path(path)) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    match file.try_lock_shared() {
        Ok(()) => Ok(None),
        Err(TryLockError::WouldBlock) => Ok(Some(LockHolder { pid: pid_in(&file) })),
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// The lock, free again when dropped and when the process ends in any way.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    pub(crate) fn take(path: &Path) -> Result<Self, JournalOpenError> {
        let io = JournalOpenError::io;
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(lock_path(path))
            .map_err(io("open the lock file"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(JournalOpenError::Locked { pid: pid_in(&file) });
            }
            Err(TryLockError::Error(error)) => return Err(io("lock the journal")(error)),
        }
        // The number only serves messages, so its loss in a crash is no harm and it is not synced.
        file.set_len(0).map_err(io("write the lock file"))?;
        writeln!(file, "{}", std::process::id()).map_err(io("write the lock file"))?;
        Ok(Self { _file: file })
    }
}

fn pid_in(mut file: &File) -> Option<u32> {
    let mut text = String::new();
    file.read_to_string(&mut text).ok()?;
    text.trim().parse().ok()
}

fn lock_path(path: &Path) -> PathBuf {
    crate::rotate::beside(path, "lock")
}
