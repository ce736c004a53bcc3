//! One log file, read from its end and then on as it grows.

use std::fs::File;
use std::io::{self, ErrorKind, Read, Seek, SeekFrom};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};

/// Bytes read from the end, at most; a longer tail is cut at its beginning.
const TAIL_BYTES_MAX: u64 = 4 << 20;
/// Bytes read at a time while following.
const NEW_BYTES_MAX: u64 = 4 << 20;

/// A log and how far it has been read.
#[derive(Debug)]
pub struct LogFile {
    service: String,
    path: PathBuf,
    /// Inode of the file that has been read; another file of that name is read from its beginning.
    inode: u64,
    at: u64,
    /// The beginning of a line whose end is not there yet.
    begun: Vec<u8>,
}

impl LogFile {
    /// A log that has not been read yet.
    pub fn new(service: &str, path: PathBuf) -> Self {
        Self { service: service.to_owned(), path, inode: 0, at: 0, begun: Vec::new() }
    }

    /// The service that writes the log.
    pub fn service(&self) -> &str {
        &self.service
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The last lines, `count` at most; [`LogFile::new_lines`] continues after them.
    ///
    /// # Errors
    /// The file cannot be read; a missing file has no lines.
    pub fn last_lines(&mut self, count: usize) -> io::Result<Vec<String>> {
        let Some(mut file) = open(&self.path)? else { return Ok(Vec::new()) };
        let metadata = file.metadata()?;
        let from = metadata.len().saturating_sub(TAIL_BYTES_MAX);
        (self.inode, self.at) = (metadata.ino(), from);
        let mut lines = self.read(&mut file, TAIL_BYTES_MAX)?;
        // The first line may be incomplete.
        lines.drain(..usize::from(from > 0 && !lines.is_empty()));
        Ok(lines.split_off(lines.len().saturating_sub(count)))
    }

    /// The lines that have been completed since the last look. A log that was put aside or emptied
    /// meanwhile is read from its beginning.
    ///
    /// # Errors
    /// As [`LogFile::last_lines`].
    pub fn new_lines(&mut self) -> io::Result<Vec<String>> {
        let Some(mut file) = open(&self.path)? else { return Ok(Vec::new()) };
        let metadata = file.metadata()?;
        if metadata.ino() != self.inode || metadata.len() < self.at {
            (self.inode, self.at) = (metadata.ino(), 0);
            self.begun.clear();
        }
        self.read(&mut file, NEW_BYTES_MAX)
    }

    fn read(&mut self, file: &mut File, bytes_max: u64) -> io::Result<Vec<String>> {
        file.seek(SeekFrom::Start(self.at))?;
        let read = file.take(bytes_max).read_to_end(&mut self.begun)?;
        self.at += read as u64;
        let Some(end) = self.begun.iter().rposition(|&byte| byte == b'\n') else {
            return Ok(Vec::new());
        };
        let rest = self.begun.split_off(end + 1);
        let whole = std::mem::replace(&mut self.begun, rest);
        Ok(String::from_utf8_lossy(&whole).lines().map(str::to_owned).collect())
    }
}

fn open(path: &Path) -> io::Result<Option<File>> {
    match File::open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        opened => opened.map(Some),
    }
}
