//! Atomic replacement of small files.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::Path;

/// Replaces the content of a file; readers see the old or the new one, never a part. After a power
/// loss either may be there, or neither.
///
/// # Errors
/// The file cannot be written.
pub fn replace_file(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let new = path.with_extension("new");
    fs::write(&new, content).and_then(|()| fs::rename(&new, path)).inspect_err(|_| forget(&new))
}

/// As [`replace_file`], and the new content is on the disk before the file is replaced, so that a
/// power loss leaves the old or the new one.
///
/// # Errors
/// The file cannot be written.
pub fn replace_file_synced(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let new = path.with_extension("new");
    let write = || {
        let mut file = File::create(&new)?;
        file.write_all(content.as_ref())?;
        file.sync_all()?;
        fs::rename(&new, path)
    };
    write().inspect_err(|_| forget(&new))?;
    File::open(path.parent().unwrap_or(Path::new(".")))?.sync_all()
}

/// Removes what a full disk has left of a new file: it takes space, and nobody reads it.
fn forget(new: &Path) {
    let _ = fs::remove_file(new);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failed_replacement_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        // A folder that is not empty cannot be replaced by a file.
        let path = folder.path().join("settings.toml");
        fs::create_dir_all(path.join("kept")).unwrap();
        assert!(replace_file(&path, "new").is_err());
        assert!(replace_file_synced(&path, "new").is_err());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(path.join("kept").is_dir());
    }
}
