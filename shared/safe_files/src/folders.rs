//! Folders that only their owner can enter.

use std::fs::{self, DirBuilder, Permissions};
use std::io;
use std::os::unix::fs::{DirBuilderExt, MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};

use rustix::process::geteuid;
use thiserror::Error;

/// Mode of a folder for its owner only.
const PRIVATE: u32 = 0o700;
/// Others may write, and so rename entries of the folder …
const OTHERS_WRITE: u32 = 0o002;
/// … unless each may rename only their own.
const STICKY: u32 = 0o1000;

/// A folder cannot be made private.
#[derive(Debug, Error)]
pub enum FolderError {
    /// The folder belongs to another user.
    #[error(
        "{}: expected a folder of user {own}, found one of user {owner}; help: run the command as that user, whose \
         group it may be, or set WHICHONE_HOME to a folder of your own",
        path.display()
    )]
    Foreign {
        /// The folder.
        path: PathBuf,
        /// User id of the process.
        own: u32,
        /// User id of the folder's owner.
        owner: u32,
    },
    /// Any user can rename entries of the folder.
    #[error(
        "{}: any user can replace folders in it; help: `chmod o-w` it, or set WHICHONE_HOME (for \
         temporary files TMPDIR) to another folder",
        .0.display()
    )]
    Open(PathBuf),
    /// An error of the operating system.
    #[error("{}: {}", .0.display(), .1)]
    Io(PathBuf, io::Error),
}

/// Creates a folder that only its owner can enter, or makes an existing one so. The folders above
/// it are created in the same way.
///
/// # Errors
/// It cannot be created, or belongs to another user.
pub fn make_private(folder: &Path) -> Result<(), FolderError> {
    let failed = |error| FolderError::Io(folder.to_owned(), error);
    DirBuilder::new().recursive(true).mode(PRIVATE).create(folder).map_err(failed)?;
    let found = fs::metadata(folder).map_err(failed)?;
    let own = geteuid().as_raw();
    if found.uid() != own {
        return Err(FolderError::Foreign { path: folder.to_owned(), own, owner: found.uid() });
    }
    if found.mode() & 0o077 != 0 {
        fs::set_permissions(folder, Permissions::from_mode(PRIVATE)).map_err(failed)?;
    }
    Ok(())
}

/// Creates a group's own folder as [`make_private`] does, in a folder where no other user can
/// replace it.
///
/// # Errors
/// As [`make_private`]; or the folder above it is open to others.
pub fn make_root(root: &Path) -> Result<(), FolderError> {
    make_private(root)?;
    root.parent().map_or(Ok(()), check_parent)
}

/// Checks that no other user can replace this user's entries in a folder.
pub(crate) fn check_parent(home: &Path) -> Result<(), FolderError> {
    let found = fs::metadata(home).map_err(|error| FolderError::Io(home.to_owned(), error))?;
    let own = geteuid().as_raw();
    if found.uid() != own && found.uid() != 0 {
        return Err(FolderError::Foreign { path: home.to_owned(), own, owner: found.uid() });
    }
    if found.mode() & OTHERS_WRITE != 0 && found.mode() & STICKY == 0 {
        return Err(FolderError::Open(home.to_owned()));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(path: &Path) -> u32 {
        fs::metadata(path).unwrap().mode() & 0o7777
    }

    fn open_to_all(path: &Path, mode: u32) {
        fs::create_dir_all(path).unwrap();
        fs::set_permissions(path, Permissions::from_mode(mode)).unwrap();
    }

    #[test]
    fn new_and_existing_folders_become_private() {
        let home = tempfile::tempdir().unwrap();
        let deep = home.path().join("a/b");
        make_private(&deep).unwrap();
        assert_eq!((mode(&deep), mode(&home.path().join("a"))), (0o700, 0o700));
        open_to_all(&deep, 0o777);
        make_private(&deep).unwrap();
        assert_eq!(mode(&deep), 0o700);
    }

    #[test]
    fn home_in_which_anybody_can_rename_is_refused() {
        let top = tempfile::tempdir().unwrap();
        let home = top.path().join("home");
        open_to_all(&home, 0o777);
        let error = make_root(&home.join("lab")).unwrap_err().to_string();
        assert!(error.contains("chmod o-w"), "{error}");
        for allowed in [0o1777, 0o775, 0o755] {
            open_to_all(&home, allowed);
            make_root(&home.join("lab")).unwrap();
        }
    }
}
