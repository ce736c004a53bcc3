//! The files of this user in shared memory.

use crate::group::SHM;
use iceoryx2::prelude::{FileName, SemanticString};
use rustix::fs::{AtFlags, FileType, Mode, OFlags, RawDir, open, statat};
use rustix::process::geteuid;

/// Room for the entries that one system call returns, bytes: those of a group or two.
const LISTING_BYTES: usize = 64 << 10;

/// Returns the names of this user's files in shared memory that `is_named` accepts.
///
/// iceoryx2 lists them for each port of a dead process, and other groups' segments, of which there
/// may be many, lie in the same folder: nothing is allocated for those.
pub(super) fn own_files(is_named: impl Fn(&[u8]) -> bool) -> rustix::io::Result<Vec<FileName>> {
    let own = geteuid().as_raw();
    let folder = open(SHM, OFlags::RDONLY | OFlags::DIRECTORY | OFlags::CLOEXEC, Mode::empty())?;
    let mut space = Vec::with_capacity(LISTING_BYTES);
    let mut entries = RawDir::new(&folder, space.spare_capacity_mut());
    let mut files = Vec::new();
    while let Some(entry) = entries.next() {
        let entry = entry?;
        let name = entry.file_name();
        if !is_named(name.to_bytes()) {
            continue;
        }
        // One that is gone by now is none.
        let Ok(stat) = statat(&folder, name, AtFlags::SYMLINK_NOFOLLOW) else { continue };
        if FileType::from_raw_mode(stat.st_mode).is_file() && stat.st_uid == own {
            files.extend(FileName::new(name.to_bytes()).ok());
        }
    }
    Ok(files)
}
