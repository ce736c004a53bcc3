//! A file that an administrator changes while a server runs.

use std::fs;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use service::exit::Failure;

/// A file, read again when it has changed.
#[derive(Debug)]
pub struct Followed<T> {
    path: PathBuf,
    load: fn(&Path) -> Result<T, Failure>,
    read: Mutex<(Option<Stamp>, Arc<T>)>,
}

/// Identity of a version of the file.
type Stamp = (u64, i64, i64, u64);

impl<T> Followed<T> {
    /// Reads the file by `load`.
    ///
    /// # Errors
    /// As of `load`.
    pub fn open(path: PathBuf, load: fn(&Path) -> Result<T, Failure>) -> Result<Self, Failure> {
        let stamp = stamp(&path);
        let read = Mutex::new((stamp, Arc::new(load(&path)?)));
        Ok(Self { path, load, read })
    }

    /// The content as of now. A file that became unreadable leaves the former one, with a line in the log.
    pub fn current(&self) -> Arc<T> {
        // Every change leaves a consistent pair.
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let now = stamp(&self.path);
        if now != read.0 {
            read.0 = now;
            match (self.load)(&self.path) {
                Ok(content) => read.1 = Arc::new(content),
                Err(error) => tracing::error!("{error}; its former content stays in force"),
            }
        }
        Arc::clone(&read.1)
    }
}

impl<T: Default> Followed<T> {
    /// As [`Followed::open`], but begins with the default and reads the file at the first use: a server that does more
    /// than serve this file's people starts without it.
    pub fn new(path: PathBuf, load: fn(&Path) -> Result<T, Failure>) -> Self {
        Self { path, load, read: Mutex::default() }
    }
}

fn stamp(path: &Path) -> Option<Stamp> {
    let file = fs::metadata(path).ok()?;
    Some((file.ino(), file.mtime(), file.mtime_nsec(), file.size()))
}
