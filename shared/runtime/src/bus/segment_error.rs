//! Reasons for refusing a segment, which iceoryx2's errors have no room for: noted when the segment
//! is refused, taken when the error is reported, on the same thread.

use std::cell::RefCell;
use std::fs;

use rustix::process::{Resource, getrlimit};

use crate::group::SHM;

/// Most descriptors of one port: its own files, and those of the peers that it connects to.
const DESCRIPTORS_OF_PORT: u64 = 64;

/// Room of the smallest file, bytes.
const PAGE: u64 = 4096;

/// Reason for refusing a segment of shared memory.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SegmentError {
    /// Shared memory is full.
    #[error(
        "shared memory is full: {needed_kib} KiB needed, {free_kib} KiB free in {SHM}; help: free \
         some (see `df {SHM}`); services try again by themselves"
    )]
    Room {
        /// Size of the segment, KiB.
        needed_kib: u64,
        /// Free memory, KiB.
        free_kib: u64,
    },
    /// Nearly all descriptors of this process are in use.
    #[error(
        "file descriptors are short: {used} of {allowed} in use; help: raise the limit of the user (`ulimit -n`); \
         services try again by themselves"
    )]
    Descriptors {
        /// Number in use.
        used: u64,
        /// Greatest number.
        allowed: u64,
    },
    /// A segment of another user has the name.
    #[error(
        "{SHM}/{file} belongs to user {user}; help: run the command as that user, whose group it may be \
         (`sudo -u '#{user}' whichone …`), or end that group first"
    )]
    Foreign {
        /// The file in shared memory.
        file: String,
        /// User id of the segment's owner.
        user: u32,
    },
    /// A segment is empty or was never completed.
    #[error(
        "{SHM}/{file} is damaged, or its creator has not completed it in time; help: restart the \
         group with `whichone down` and `whichone up`"
    )]
    Incomplete {
        /// The file in shared memory.
        file: String,
    },
}

thread_local! {
    static NOTED: RefCell<Option<SegmentError>> = const { RefCell::new(None) };
}

impl SegmentError {
    /// Lack of `bytes` of shared memory.
    pub(super) fn room(bytes: u64) -> Self {
        let free = rustix::fs::statvfs(SHM).map_or(0, |stat| stat.f_bavail * stat.f_frsize);
        Self::Room { needed_kib: bytes.div_ceil(1024), free_kib: free / 1024 }
    }
}

/// Notes why a segment is refused; the first reason counts.
pub(super) fn note(error: SegmentError) {
    NOTED.with_borrow_mut(|noted| {
        noted.get_or_insert(error);
    });
}

/// Takes the reason noted since the last call.
pub(super) fn take() -> Option<SegmentError> {
    NOTED.take()
}

/// Takes the reason of a failure: the one noted, or else lack of room for a small file of
/// iceoryx2's, or of a descriptor.
pub(super) fn of_failure() -> Option<SegmentError> {
    let is_full =
        || rustix::fs::statvfs(SHM).is_ok_and(|stat| stat.f_bavail.min(stat.f_ffree) == 0);
    take().or_else(|| is_full().then(|| SegmentError::room(PAGE))).or_else(few_descriptors)
}

/// Want of descriptors, if there may be: those of the port that has failed are closed again.
fn few_descriptors() -> Option<SegmentError> {
    let allowed = getrlimit(Resource::Nofile).current?;
    // Not even one to count them.
    let used = fs::read_dir("/proc/self/fd").map_or(allowed, |all| all.count() as u64);
    (used + DESCRIPTORS_OF_PORT > allowed).then_some(SegmentError::Descriptors { used, allowed })
}
