//! One writer per journal: a lock on a file next to it, held for life. The journal itself cannot
//! carry the lock because a rotation puts another file in its place.

use std::fs::{File, TryLockError};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use crate::JournalOpenError;

/// The lock; released when dropped and when the process ends in any way.
#[derive(Debug)]
pub(crate) struct Lock {
    _file: File,
}

impl Lock {
    pub(crate) fn take(path: &Path) -> Result<Self, JournalOpenError> {
        let io = JournalOpenError::io;
        let mut file = safe_files::open_lock(&lock_path(path)).map_err(io("open the lock file"))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(JournalOpenError::Locked { pid: pid_in(&file) });
            }
            Err(TryLockError::Error(error)) => return Err(io("lock the journal")(error)),
        }
        // The number only serves messages, so losing it in a crash or on a full disk is harmless.
        let _ = file.set_len(0).and_then(|()| writeln!(file, "{}", std::process::id()));
        Ok(Self { _file: file })
    }
}

fn pid_in(mut file: &File) -> Option<u32> {
    let mut text = String::new();
    file.read_to_string(&mut text).ok()?;
    text.trim().parse().ok()
}

fn lock_path(path: &Path) -> PathBuf {
    safe_files::suffixed(path, "lock")
}
