//! Leftovers of a crash: files and folders with a random name, no longer locked by any process.
//!
//! Their maker locks them for as long as it lives. Between creation and lock another process may
//! take them for a leftover; the maker notices that, and chooses another name.

use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

use rustix::fs::{FlockOperation, OFlags, flock};
use rustix::process::geteuid;

/// Number of random characters in a name.
pub(crate) const RANDOM: usize = 10;

/// Locks a new file or folder for the life of the descriptor.
///
/// # Errors
/// `AlreadyExists` if another process takes it for a leftover, so that another name is tried.
pub(crate) fn claim(new: &File) -> io::Result<()> {
    // File systems without locks have none against us either: there, leftovers stay.
    let is_taken = flock(new, FlockOperation::NonBlockingLockExclusive)
        .is_err_and(|error| error == rustix::io::Errno::WOULDBLOCK);
    if is_taken || new.metadata()?.nlink() == 0 {
        return Err(io::ErrorKind::AlreadyExists.into());
    }
    Ok(())
}

/// Removes leftovers with this beginning and end of their names from a folder.
pub(crate) fn remove(folder: &Path, prefix: &OsStr, suffix: &str) {
    let is_random = |name: &OsStr| {
        let middle = name.as_bytes().strip_prefix(prefix.as_bytes());
        let middle = middle.and_then(|rest| rest.strip_suffix(suffix.as_bytes()));
        middle.is_some_and(|m| m.len() == RANDOM && m.iter().all(u8::is_ascii_alphanumeric))
    };
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if is_random(&entry.file_name()) {
            // One that stays takes space and blocks nothing.
            let _ = remove_unclaimed(&entry.path());
        }
    }
}

fn remove_unclaimed(path: &Path) -> io::Result<()> {
    let flags = OFlags::NOFOLLOW | OFlags::NONBLOCK;
    let found =
        OpenOptions::new().read(true).custom_flags(flags.bits().cast_signed()).open(path)?;
    let meta = found.metadata()?;
    if meta.uid() != geteuid().as_raw() {
        return Ok(());
    }
    flock(&found, FlockOperation::NonBlockingLockExclusive)?;
    if meta.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) }
}
