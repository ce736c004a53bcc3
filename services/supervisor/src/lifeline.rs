//! The connection between the supervisor and the whole tree of its service processes.
//!
//! Every service, and whatever it starts, inherits two descriptors. One is the read end of the
//! *lifeline*, a pipe that only the supervisor could write to: it reads as ended when the
//! supervisor is gone, however it went. The other is an open file with a shared lock: while any
//! process of the tree exists, the file cannot be locked exclusively, so a later supervisor knows
//! for certain when the last one has ended.

use std::fs::File;
use std::io;
use std::os::fd::{AsFd, AsRawFd, BorrowedFd, OwnedFd, RawFd};

use rustix::fs::{FlockOperation, flock};
use rustix::pipe::{PipeFlags, pipe_with};

/// The supervisor's ends of the connection.
#[derive(Debug)]
pub(crate) struct Lifeline {
    read_end: OwnedFd,
    _write_end: OwnedFd,
    alive: File,
}

impl Lifeline {
    /// Creates a lifeline, and a shared lock on `alive`.
    pub(crate) fn new(alive: File) -> io::Result<Self> {
        let (read_end, write_end) = pipe_with(PipeFlags::CLOEXEC)?;
        flock(&alive, FlockOperation::NonBlockingLockShared)?;
        Ok(Self { read_end, _write_end: write_end, alive })
    }

    /// Descriptors that every service inherits.
    pub(crate) fn inherited(&self) -> [BorrowedFd<'_>; 2] {
        [self.read_end.as_fd(), self.alive.as_fd()]
    }

    /// Number of the lifeline's descriptor, the same in every service.
    pub(crate) fn descriptor(&self) -> RawFd {
        self.read_end.as_raw_fd()
    }
}

/// Returns true if no other process holds the lock.
pub(crate) fn is_free(lock: &File) -> bool {
    flock(lock, FlockOperation::NonBlockingLockExclusive).is_ok()
        && flock(lock, FlockOperation::Unlock).is_ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lifeline_is_locked_while_any_copy_of_the_descriptor_is_open() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("alive.lock");
        let later = safe_files::open_lock(&path).unwrap();
        assert!(is_free(&later));
        let lifeline = Lifeline::new(safe_files::open_lock(&path).unwrap()).unwrap();
        assert!(!is_free(&later));
        let inherited = rustix::io::dup(lifeline.inherited()[1]).unwrap();
        drop(lifeline);
        assert!(!is_free(&later), "a child still lives");
        drop(inherited);
        assert!(is_free(&later));
    }
}
