//! Opening of files for reading.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;

use rustix::fs::OFlags;
use rustix::process::geteuid;

/// Opens a regular file for reading. Never waits: another user may have put a pipe there.
///
/// # Errors
/// It cannot be opened, or is something else.
pub fn open_regular(path: &Path) -> io::Result<File> {
    // Before it is opened, which moves some devices.
    judge(&fs::metadata(path)?)?;
    let flags = (OFlags::NONBLOCK | OFlags::NOCTTY).bits().cast_signed();
    let file = OpenOptions::new().read(true).custom_flags(flags).open(path)?;
    judge(&file.metadata()?)?;
    Ok(file)
}

/// Reads the text of a regular file, as [`open_regular`] opens it.
///
/// # Errors
/// As [`open_regular`], or it is not UTF-8.
pub fn read_regular(path: &Path) -> io::Result<String> {
    io::read_to_string(open_regular(path)?)
}

/// Reads a file of this user that no other user can read or change; none otherwise.
pub fn read_private(path: &Path) -> Option<String> {
    let file = fs::symlink_metadata(path).ok()?;
    let is_own = file.uid() == geteuid().as_raw();
    let is_private = file.is_file() && is_own && file.mode() & 0o077 == 0;
    is_private.then(|| fs::read_to_string(path).ok())?
}

fn judge(found: &Metadata) -> io::Result<()> {
    if found.is_file() {
        return Ok(());
    }
    let found = if found.is_dir() { "a folder" } else { "a pipe, socket or device" };
    let what = format!("expected a regular file, found {found}");
    Err(io::Error::new(io::ErrorKind::InvalidData, what))
}

#[cfg(test)]
mod tests {
    use std::fs::Permissions;
    use std::os::unix::fs::{PermissionsExt, symlink};

    use rustix::fs::{CWD, FileType, Mode, mknodat};

    use super::*;

    #[test]
    fn private_file_is_for_its_owner_alone() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("console.token");
        crate::replace_private(&file, "secret\n").unwrap();
        assert_eq!(read_private(&file).as_deref(), Some("secret\n"));
        for mode in [0o640, 0o602, 0o604] {
            fs::set_permissions(&file, Permissions::from_mode(mode)).unwrap();
            assert_eq!(read_private(&file), None, "{mode:o}");
        }
        fs::set_permissions(&file, Permissions::from_mode(0o600)).unwrap();
        let link = folder.path().join("link");
        symlink(&file, &link).unwrap();
        assert_eq!(read_private(&link), None);
    }

    #[test]
    fn pipes_and_folders_are_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        mknodat(CWD, &pipe, FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).unwrap();
        for (path, found) in [(pipe.as_path(), "a pipe"), (folder.path(), "a folder")] {
            let error = open_regular(path).unwrap_err().to_string();
            assert!(error.contains(found), "{error}");
        }
        let file = folder.path().join("file");
        assert_eq!(open_regular(&file).unwrap_err().kind(), io::ErrorKind::NotFound);
        fs::write(&file, "x").unwrap();
        assert_eq!(read_regular(&file).unwrap(), "x");
    }
}
