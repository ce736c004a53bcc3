//! Reading of files.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::{Path, PathBuf};

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

/// Reads a file of this user that no other user can read or change.
///
/// # Errors
/// It cannot be read, is not a file of this user alone, or is not UTF-8.
pub fn read_private(path: &Path) -> io::Result<String> {
    let file = fs::symlink_metadata(path)?;
    let is_own = file.uid() == geteuid().as_raw();
    if !file.is_file() || !is_own || file.mode() & 0o077 != 0 {
        let what = "other users can read or change it, or it is another user's; help: chmod 600";
        return Err(io::Error::new(io::ErrorKind::PermissionDenied, what));
    }
    String::from_utf8(fs::read(path)?).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let what =
            format!("expected UTF-8, found another byte at offset {at}; help: save it as UTF-8");
        io::Error::new(io::ErrorKind::InvalidData, what)
    })
}

fn judge(found: &Metadata) -> io::Result<()> {
    if found.is_file() {
        return Ok(());
    }
    let found = if found.is_dir() { "a folder" } else { "a pipe, socket or device" };
    let what = format!("expected a regular file, found {found}");
    Err(io::Error::new(io::ErrorKind::InvalidData, what))
}

/// Returns the files with an extension in a folder, by name, with their texts; empty if the folder
/// does not exist.
///
/// # Errors
/// The file that cannot be read, and why.
pub fn read_folder(
    folder: &Path,
    ending: &str,
) -> Result<Vec<(PathBuf, String)>, (PathBuf, io::Error)> {
    let entries = match fs::read_dir(folder) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(|error| (folder.to_owned(), error))?,
    };
    let mut files: Vec<PathBuf> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|found| found == ending))
        .collect();
    files.sort();
    let read = |path: PathBuf| match fs::read_to_string(&path) {
        Ok(text) => Ok((path, text)),
        Err(error) => Err((path, error)),
    };
    files.into_iter().map(read).collect()
}

#[cfg(test)]
mod tests {
    use std::fs::Permissions;
    use std::os::unix::fs::{PermissionsExt, symlink};

    use rustix::fs::{CWD, FileType, Mode, mknodat};

    use super::*;

    #[test]
    fn private_file_of_other_bytes_says_so() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("http.tokens");
        crate::replace_private(&file, b"# caf\xe9\n").unwrap();
        let error = read_private(&file).unwrap_err().to_string();
        assert!(error.contains("expected UTF-8") && error.contains("offset 5"), "{error}");
        fs::set_permissions(&file, Permissions::from_mode(0o640)).unwrap();
        assert!(read_private(&file).unwrap_err().to_string().contains("chmod 600"));
    }

    #[test]
    fn private_file_is_for_its_owner_alone() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("console.token");
        crate::replace_private(&file, "secret\n").unwrap();
        assert_eq!(read_private(&file).unwrap(), "secret\n");
        for mode in [0o640, 0o602, 0o604] {
            fs::set_permissions(&file, Permissions::from_mode(mode)).unwrap();
            assert!(read_private(&file).is_err(), "{mode:o}");
        }
        fs::set_permissions(&file, Permissions::from_mode(0o600)).unwrap();
        let link = folder.path().join("link");
        symlink(&file, &link).unwrap();
        assert!(read_private(&link).is_err());
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

    #[test]
    fn folder_of_texts_is_read_by_extension_and_may_be_missing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("A.jsonl");
        assert!(read_folder(&folder.path().join("none"), "jsonl").unwrap().is_empty());
        fs::write(folder.path().join("B.csv"), "other").unwrap();
        fs::write(&path, "one\n").unwrap();
        let files = read_folder(folder.path(), "jsonl").unwrap();
        assert_eq!(files, [(path.clone(), "one\n".to_owned())]);
        fs::write(&path, b"\xff\n").unwrap();
        assert_eq!(read_folder(folder.path(), "jsonl").unwrap_err().0, path);
    }
}
