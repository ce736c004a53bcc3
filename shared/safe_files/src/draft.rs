//! Atomic replacement of files.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};

use rustix::fs::OFlags;
use rustix::process::geteuid;
use tempfile::{Builder, NamedTempFile};

use crate::leftovers::{self, RANDOM};

/// End of the names of drafts.
const SUFFIX: &str = ".new";
/// Beginning of the names of files that are only written to see whether they can be.
const PROBE: &str = ".whichone-probe.";
/// Longest part of a file's name in that of its draft, bytes: file systems allow 255 in all.
const NAME_MAX: usize = 200;
/// Mode of a file for its owner alone.
const PRIVATE: u32 = 0o600;
/// Mode of a new file before the umask.
const PUBLIC: u32 = 0o666;

/// Permitted readers of the new file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers {
    /// Readable by the owner alone.
    Owner,
    /// Readers of the replaced file of the same user; for a new file those whom the umask lets.
    AsBefore,
    /// Readers by this mode, whatever the umask.
    Mode(u32),
}

/// A new file next to the one that it will replace, under a random name. Dropping it removes it.
#[derive(Debug)]
pub struct Draft {
    file: NamedTempFile<File>,
    path: PathBuf,
}

impl Draft {
    /// Creates the draft of a file, and removes those that a crash has left of it.
    ///
    /// # Errors
    /// The folder cannot be written, or the path names no file.
    pub fn of(path: &Path, readers: Readers) -> io::Result<Self> {
        let name = path.file_name().ok_or(ErrorKind::InvalidInput)?;
        let folder = folder_of(path);
        let (mode, is_exact) = match readers {
            Readers::Owner => (PRIVATE, true),
            Readers::Mode(mode) => (mode & 0o777, true),
            Readers::AsBefore => mode_of_own(path).map_or((PUBLIC, false), |mode| (mode, true)),
        };
        let prefix = prefix(name);
        leftovers::remove(folder, &prefix, SUFFIX);
        // Wider only once it is complete.
        let first = if is_exact { mode & PRIVATE } else { mode };
        let file = make(folder, &prefix, SUFFIX, first)?;
        if is_exact && mode != first {
            file.as_file().set_permissions(Permissions::from_mode(mode))?;
        }
        Ok(Self { file, path: path.to_owned() })
    }

    /// Syncs the draft's content to the disk.
    ///
    /// # Errors
    /// The disk is full or broken.
    pub fn sync(&self) -> io::Result<()> {
        self.file.as_file().sync_all()
    }

    /// Puts the draft in the file's place. Readers see the old or the new content, never a part.
    ///
    /// # Errors
    /// The file cannot be replaced; it is as before.
    pub fn replace(self) -> io::Result<()> {
        self.file.persist(&self.path).map(drop).map_err(|error| error.error)
    }

    /// Puts the draft in place unless the file exists.
    ///
    /// # Errors
    /// `AlreadyExists`, or the folder cannot be written.
    pub fn put_if_absent(self) -> io::Result<()> {
        self.file.persist_noclobber(&self.path).map(drop).map_err(|error| error.error)
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_file_mut().flush()
    }
}

/// Replaces the content of a file; readers see the old or the new one, never a part. After a power
/// loss either may be there, or neither.
///
/// # Errors
/// The file cannot be written; the old content remains.
pub fn replace(path: &Path, content: impl AsRef<[u8]>, readers: Readers) -> io::Result<()> {
    let mut draft = Draft::of(path, readers)?;
    draft.write_all(content.as_ref())?;
    draft.replace()
}

/// Replaces the content of a file for its owner alone, as [`replace`] does.
///
/// # Errors
/// As [`replace`].
pub fn replace_private(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    replace(path, content, Readers::Owner)
}

/// As [`replace_private`], and a power loss leaves the old or the new content, whole.
///
/// # Errors
/// As [`replace`].
pub fn replace_private_synced(path: &Path, content: impl AsRef<[u8]>) -> io::Result<()> {
    let mut draft = Draft::of(path, Readers::Owner)?;
    draft.write_all(content.as_ref())?;
    draft.sync()?;
    draft.replace()?;
    File::open(folder_of(path))?.sync_all()
}

/// Creates an empty file for its owner alone, in place of any other, for a program to write to.
///
/// # Errors
/// The folder cannot be written.
pub fn create_private(path: &Path) -> io::Result<File> {
    let draft = Draft::of(path, Readers::Owner)?;
    draft.file.persist(path).map_err(|error| error.error)
}

/// Opens a file that processes lock; it is created if missing, and never replaced.
///
/// # Errors
/// It cannot be opened, or is a link.
pub fn open_lock(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    options.read(true).write(true).create(true).truncate(false).mode(PRIVATE);
    options.custom_flags((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed()).open(path)
}

/// Checks that files can be written in a folder.
///
/// # Errors
/// They cannot.
pub fn probe(folder: &Path) -> io::Result<()> {
    leftovers::remove(folder, OsStr::new(PROBE), SUFFIX);
    make(folder, OsStr::new(PROBE), SUFFIX, PRIVATE)?.as_file_mut().write_all(b"x")
}

/// The folder of a file.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn make(folder: &Path, prefix: &OsStr, suffix: &str, mode: u32) -> io::Result<NamedTempFile<File>> {
    let open = |path: &Path| {
        let mut options = OpenOptions::new();
        options.write(true).create_new(true).mode(mode);
        let file = options.custom_flags(OFlags::NOFOLLOW.bits().cast_signed()).open(path)?;
        leftovers::claim(&file).map(|()| file)
    };
    Builder::new().prefix(prefix).suffix(suffix).rand_bytes(RANDOM).make_in(folder, open)
}

/// `.NAME.`, of a long name only the beginning.
fn prefix(name: &OsStr) -> OsString {
    let mut prefix = OsString::from(".");
    prefix.push(OsStr::from_bytes(&name.as_bytes()[..name.len().min(NAME_MAX)]));
    prefix.push(".");
    prefix
}

/// The mode of a regular file of this user.
fn mode_of_own(path: &Path) -> Option<u32> {
    let found = fs::symlink_metadata(path).ok()?;
    let is_own = found.is_file() && found.uid() == geteuid().as_raw();
    is_own.then_some(found.mode() & 0o777)
}

#[cfg(test)]
#[path = "draft_tests.rs"]
mod tests;
