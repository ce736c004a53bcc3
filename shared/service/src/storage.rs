//! Space on the file systems of a group's folders.

use std::path::Path;

/// Free space of the file system that holds `folder`, bytes; `None` if it cannot be asked.
pub(crate) fn free_bytes(folder: &Path) -> Option<u64> {
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;

    #[test]
    fn free_space_is_reported_in_kib_of_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        assert!(free_text(folder.path()).contains(" KiB free in /"));
    }
}
