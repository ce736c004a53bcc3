//! Files and folders that a user names for output, wherever they are.
//!
//! Another user may have placed a link to have a file of this user overwritten. Links are therefore
//! followed one by one, each through its own descriptor, and only those of this user and of root.

use std::collections::VecDeque;
use std::ffi::{OsStr, OsString};
use std::io::{self, ErrorKind, Write};
use std::os::fd::{AsRawFd, OwnedFd};
use std::os::unix::ffi::OsStringExt;
use std::path::{Component, Path, PathBuf};

use rustix::fs::{CWD, FileType, Mode, OFlags, fstat, mkdirat, openat, readlinkat};
use rustix::io::Errno;
use rustix::process::geteuid;

use crate::draft::folder_of;
use crate::{Draft, Readers};

/// Links that may follow each other, as the kernel has it.
const LINKS_MAX: usize = 40;
const ROOT: u32 = 0;

/// An existing folder for files of a user, whatever has become of its path.
#[derive(Debug)]
pub struct OutputFolder(OwnedFd);

impl OutputFolder {
    /// Opens a folder, creating it and those above it if missing.
    ///
    /// # Errors
    /// It cannot be created or entered, or a link of another user leads to it.
    pub fn open(path: &Path) -> io::Result<Self> {
        Ok(Self(walk(path, End::Folder)?.0))
    }

    /// Replaces a file in the folder.
    ///
    /// # Errors
    /// The file cannot be written, or is not a regular file.
    pub fn write(&self, name: impl AsRef<OsStr>, content: &[u8]) -> io::Result<()> {
        let (folder, name) =
            follow(self.0.try_clone()?, [name.as_ref().to_owned()].into(), End::File)?;
        replace_in(&folder, &name, content)
    }

    /// Writes a new file in the folder.
    ///
    /// # Errors
    /// `AlreadyExists`, or it cannot be written.
    pub fn write_new(
        &self,
        name: impl AsRef<OsStr>,
        content: &[u8],
        readers: Readers,
    ) -> io::Result<()> {
        new_in(&self.0, name.as_ref(), content, readers)
    }
}

/// Replaces the content of a file that a user has named.
///
/// # Errors
/// The file cannot be written, is not a regular file, or is behind a link of another user.
pub fn write_output(path: &Path, content: &[u8]) -> io::Result<()> {
    let (folder, name) = walk(path, End::File)?;
    replace_in(&folder, &name, content)
}

/// Writes a new file that a user has named.
///
/// # Errors
/// `AlreadyExists`, it cannot be written, or a link of another user leads to it.
pub fn write_new_output(path: &Path, content: &[u8], readers: Readers) -> io::Result<()> {
    let name = path.file_name().ok_or(ErrorKind::IsADirectory)?;
    let (folder, _) = walk(folder_of(path), End::Existing)?;
    new_in(&folder, name, content, readers)
}

/// Checks that no link of another user leads to a new file that a user has named.
///
/// # Errors
/// A link of another user leads to the file, or the folder is missing.
pub fn check_new_output(path: &Path) -> io::Result<()> {
    walk(folder_of(path), End::Existing).map(drop)
}

fn new_in(folder: &OwnedFd, name: &OsStr, content: &[u8], readers: Readers) -> io::Result<()> {
    let mut draft = Draft::of(&path_in(folder, name), readers)?;
    draft.write_all(content)?;
    draft.put_if_absent()
}

fn replace_in(folder: &OwnedFd, name: &OsStr, content: &[u8]) -> io::Result<()> {
    crate::replace(&path_in(folder, name), content, Readers::AsBefore)
}

/// A path that leads through an open descriptor.
fn path_in(folder: &OwnedFd, name: &OsStr) -> PathBuf {
    Path::new("/proc/self/fd").join(folder.as_raw_fd().to_string()).join(name)
}

/// Required end of a path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// A regular file, or nothing so far.
    File,
    /// A folder, created if missing.
    Folder,
    /// An existing folder.
    Existing,
}

/// Finds the folder and the name that a path leads to; the name of a folder is empty.
fn walk(path: &Path, end: End) -> io::Result<(OwnedFd, OsString)> {
    let start = if path.is_absolute() { Path::new("/") } else { Path::new(".") };
    follow(open_folder(CWD, start.as_os_str())?, names(path), end)
}

fn follow(
    mut folder: OwnedFd,
    mut names: VecDeque<OsString>,
    end: End,
) -> io::Result<(OwnedFd, OsString)> {
    let mut links = 0;
    while let Some(name) = names.pop_front() {
        let is_file = end == End::File && names.is_empty();
        let flags = OFlags::PATH | OFlags::NOFOLLOW | OFlags::CLOEXEC;
        let found = match openat(&folder, &name, flags, Mode::empty()) {
            Err(Errno::NOENT) if is_file => return Ok((folder, name)),
            Err(Errno::NOENT) if end == End::Folder => {
                match mkdirat(&folder, &name, Mode::from_raw_mode(0o777)) {
                    Ok(()) | Err(Errno::EXIST) => openat(&folder, &name, flags, Mode::empty())?,
                    Err(error) => return Err(error.into()),
                }
            }
            found => found?,
        };
        let stat = fstat(&found)?;
        match FileType::from_raw_mode(stat.st_mode) {
            FileType::Symlink => {
                links += 1;
                if links > LINKS_MAX {
                    return Err(Errno::LOOP.into());
                }
                own_link(&name, stat.st_uid)?;
                let target = readlinkat(&found, "", Vec::new())?.into_bytes();
                let target = PathBuf::from(OsString::from_vec(target));
                if target.is_absolute() {
                    folder = open_folder(CWD, OsStr::new("/"))?;
                }
                for name in self::names(&target).into_iter().rev() {
                    names.push_front(name);
                }
            }
            FileType::RegularFile if is_file => return Ok((folder, name)),
            FileType::Directory if is_file => return Err(ErrorKind::IsADirectory.into()),
            _ if is_file => {
                let what = "expected a regular file, found a pipe, socket or device";
                return Err(io::Error::new(ErrorKind::InvalidData, what));
            }
            FileType::Directory => folder = found,
            _ => return Err(ErrorKind::NotADirectory.into()),
        }
    }
    match end {
        End::Folder | End::Existing => Ok((folder, OsString::new())),
        End::File => Err(ErrorKind::IsADirectory.into()),
    }
}

fn own_link(name: &OsStr, owner: u32) -> io::Result<()> {
    let own = geteuid().as_raw();
    if owner == own || owner == ROOT {
        return Ok(());
    }
    let what = format!(
        "{} is a link of user {owner}; expected one of user {own}; help: name another place",
        name.display()
    );
    Err(io::Error::new(ErrorKind::PermissionDenied, what))
}

fn names(path: &Path) -> VecDeque<OsString> {
    let names = path.components().filter_map(|part| match part {
        Component::Normal(name) => Some(name.to_owned()),
        Component::ParentDir => Some("..".into()),
        _ => None,
    });
    names.collect()
}

fn open_folder(at: rustix::fd::BorrowedFd<'_>, name: &OsStr) -> io::Result<OwnedFd> {
    let flags = OFlags::PATH | OFlags::DIRECTORY | OFlags::CLOEXEC;
    Ok(openat(at, name, flags, Mode::empty())?)
}

#[cfg(test)]
#[path = "output_tests.rs"]
mod tests;
