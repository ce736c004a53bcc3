//! Space on the file systems of a group's folders.

use std::path::Path;

/// Below this a failed operation is put down to the lack of space, bytes.
const SHORT_BYTES: u64 = 256 << 10;

/// Free space of the file system that holds `folder`, bytes; `None` if it cannot be asked.
fn free_bytes(folder: &Path) -> Option<u64> {
    let stat = rustix::fs::statvfs(folder).ok()?;
    // A file system without files left is as full as one without blocks.
    let no_file = stat.f_files > 0 && stat.f_favail == 0;
    Some(if no_file { 0 } else { stat.f_bavail.saturating_mul(stat.f_frsize) })
}

/// Free space of the file system that holds `folder`, in words.
pub(crate) fn free_text(folder: &Path) -> String {
    match free_bytes(folder) {
        Some(bytes) => format!("{} KiB free in {}", bytes >> 10, folder.display()),
        None => format!("in {}", folder.display()),
    }
}

/// Returns why an operation in `folder` may have failed, in words, if the file system is full.
pub fn shortage(folder: &Path) -> Option<String> {
    free_bytes(folder).filter(|bytes| *bytes < SHORT_BYTES)?;
    Some(format!("storage is full: {}; help: free some space", free_text(folder)))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    #[test]
    fn free_space_is_reported_in_kib_of_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        assert!(free_text(folder.path()).contains(" KiB free in /"));
        assert_eq!(shortage(Path::new("/nowhere/at/all")), None);
    }
}
