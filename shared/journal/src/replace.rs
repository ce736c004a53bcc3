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
    fs::write(&new, content)?;
    fs::rename(new, path)
}

/// As [`replace_file`], and the new content is on the disk before the file is replaced, so that a
/// power loss leaves the old or the new one.
///
/// # Errors
/// The file cannot be written.
pub fn replace_file_synced(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let new = path.with_extension("new");
    let mut file = File::create(&new)?;
    file.write_all(content.as_ref())?;
    file.sync_all()?;
    fs::rename(new, path)?;
    File::open(path.parent().unwrap_or(Path::new(".")))?.sync_all()
}
