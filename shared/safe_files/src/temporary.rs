//! Temporary folders.

use std::env;
use std::ffi::OsStr;
use std::fs::{self, File, Permissions};
use std::io;
use std::os::unix::fs::{MetadataExt, PermissionsExt};
use std::path::{Path, PathBuf};

use rustix::process::geteuid;
use tempfile::{Builder, TempDir};

use crate::folders::check_parent;
use crate::leftovers::{self, RANDOM};

const PREFIX: &str = "whichone-";
const SUFFIX: &str = ".tmp";
/// The folder of a user's session, which only this user can enter.
const ENV_RUNTIME: &str = "XDG_RUNTIME_DIR";

/// A new folder that only its owner can enter. Dropping it removes it with everything in it.
#[derive(Debug)]
pub struct TemporaryFolder {
    folder: TempDir,
    /// Locked for as long as the folder is in use.
    _claimed: File,
}

impl TemporaryFolder {
    /// Creates a folder in a private `$XDG_RUNTIME_DIR`, else in the system's temporary folder.
    ///
    /// # Errors
    /// It cannot be created, or any user could replace it.
    pub fn new() -> io::Result<Self> {
        let session = env::var_os(ENV_RUNTIME).map(PathBuf::from).filter(|it| is_private(it));
        Self::within(&session.unwrap_or_else(env::temp_dir))
    }

    /// Creates a folder in `parent`.
    ///
    /// # Errors
    /// As [`TemporaryFolder::new`].
    pub fn within(parent: &Path) -> io::Result<Self> {
        check_parent(parent).map_err(io::Error::other)?;
        leftovers::remove(parent, OsStr::new(PREFIX), SUFFIX);
        let mut builder = Builder::new();
        builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM);
        builder.permissions(Permissions::from_mode(0o700));
        loop {
            let folder = builder.tempdir_in(parent)?;
            let claimed =
                File::open(folder.path()).and_then(|it| leftovers::claim(&it).map(|()| it));
            match claimed {
                Ok(claimed) => return Ok(Self { folder, _claimed: claimed }),
                Err(error) if is_gone(&error) => {}
                Err(error) => return Err(error),
            }
        }
    }

    /// The folder.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Gives the folder its final name, under which it stays.
    ///
    /// # Errors
    /// Another one has the name, or the folder above it cannot be written; then it is removed.
    pub fn keep_as(self, path: &Path) -> io::Result<()> {
        fs::rename(self.folder.path(), path)?;
        let _ = self.folder.keep();
        Ok(())
    }
}

/// Another process has taken it for a leftover.
fn is_gone(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::AlreadyExists | io::ErrorKind::NotFound)
}

/// Returns true for a folder of this user that no other can enter.
fn is_private(folder: &Path) -> bool {
    let own = geteuid().as_raw();
    let is_own = |found: fs::Metadata| found.is_dir() && found.uid() == own;
    fs::symlink_metadata(folder).is_ok_and(|found| found.mode() & 0o077 == 0 && is_own(found))
}

#[cfg(test)]
mod tests {
    use std::os::unix::fs::symlink;

    use super::*;

    fn entries(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn folder_is_private_and_goes_with_its_owner() {
        let top = tempfile::tempdir().unwrap();
        let (one, other) =
            (TemporaryFolder::within(top.path()), TemporaryFolder::within(top.path()));
        let (one, other) = (one.unwrap(), other.unwrap());
        assert_ne!(one.path(), other.path());
        assert_eq!(fs::metadata(one.path()).unwrap().mode() & 0o7777, 0o700);
        fs::write(one.path().join("file"), "x").unwrap();
        drop((one, other));
        assert_eq!(entries(top.path()), 0);
    }

    #[test]
    fn leftover_is_removed_by_the_next_and_a_used_folder_is_not() {
        let top = tempfile::tempdir().unwrap();
        let left = top.path().join("whichone-abcdefghij.tmp");
        fs::create_dir(&left).unwrap();
        fs::write(left.join("file"), "x").unwrap();
        let elsewhere = tempfile::tempdir().unwrap();
        let link = top.path().join("whichone-ABCDEFGHIJ.tmp");
        symlink(elsewhere.path(), &link).unwrap();
        let used = TemporaryFolder::within(top.path()).unwrap();
        assert!(!left.exists());
        let _next = TemporaryFolder::within(top.path()).unwrap();
        assert!(used.path().exists() && elsewhere.path().exists());
        assert_eq!(entries(top.path()), 3, "the link leads elsewhere and is not followed");
    }

    #[test]
    fn folder_that_any_user_can_rename_is_refused() {
        let top = tempfile::tempdir().unwrap();
        fs::set_permissions(top.path(), Permissions::from_mode(0o777)).unwrap();
        let error = TemporaryFolder::within(top.path()).unwrap_err().to_string();
        assert!(error.contains("TMPDIR"), "{error}");
        assert_eq!(entries(top.path()), 0);
    }

    #[test]
    fn kept_folder_has_its_final_name() {
        let top = tempfile::tempdir().unwrap();
        let path = top.path().join("kept");
        let folder = TemporaryFolder::within(top.path()).unwrap();
        fs::write(folder.path().join("file"), "x").unwrap();
        folder.keep_as(&path).unwrap();
        assert!(TemporaryFolder::within(top.path()).unwrap().keep_as(&path).is_err());
        assert_eq!((entries(top.path()), entries(&path)), (1, 1));
    }
}
