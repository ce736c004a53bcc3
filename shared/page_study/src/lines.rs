//! Append-only files of text lines, for people and their programs.
//!
//! Invariant: lines acknowledged by [`Lines::append`] are on the disk. A crash may leave the
//! beginning of one more line, without its end; readers ignore that.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::Path;

/// A file of lines, open for its only writer.
#[derive(Debug)]
pub(crate) struct Lines {
    file: File,
    bytes: u64,
}

impl Lines {
    /// A new file. A missing folder is created, and both are on the disk afterwards.
    ///
    /// # Errors
    /// It exists already, or cannot be written.
    pub(crate) fn create(path: &Path) -> io::Result<Self> {
        let folder = path.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(folder)?;
        let file = OpenOptions::new().append(true).create_new(true).open(path)?;
        File::open(folder)?.sync_all()?;
        Ok(Self { file, bytes: 0 })
    }

    /// An existing file and its whole lines. Text after the last line end was never acknowledged
    /// and is cut off.
    ///
    /// # Errors
    /// It cannot be read or written, or is not UTF-8.
    pub(crate) fn open(path: &Path) -> io::Result<(Self, String)> {
        let mut file = OpenOptions::new().read(true).append(true).open(path)?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        file.set_len(bytes.len() as u64)?;
        let lines = Self { file, bytes: bytes.len() as u64 };
        let text =
            String::from_utf8(bytes).map_err(|e| io::Error::new(ErrorKind::InvalidData, e))?;
        Ok((lines, text))
    }

    /// Appends whole lines, all or none, and waits until they are on the disk.
    ///
    /// # Errors
    /// They cannot be written.
    ///
    /// # Panics
    /// If `lines` does not end with a line end: a bug.
    pub(crate) fn append(&mut self, lines: &str) -> io::Result<()> {
        assert!(lines.ends_with('\n'), "only whole lines are appended");
        let written = self.file.write_all(lines.as_bytes()).and_then(|()| self.file.sync_data());
        if let Err(error) = written {
            // The next line must not follow upon half of this one.
            self.file.set_len(self.bytes)?;
            return Err(error);
        }
        self.bytes += lines.len() as u64;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_log_returns_appended_lines_without_a_torn_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/A.jsonl");
        let mut lines = Lines::create(&path).unwrap();
        lines.append("one\ntwo\n").unwrap();
        assert_eq!(Lines::create(&path).unwrap_err().kind(), ErrorKind::AlreadyExists);
        fs::OpenOptions::new().append(true).open(&path).unwrap().write_all(b"thr").unwrap();
        let (mut lines, text) = Lines::open(&path).unwrap();
        assert_eq!(text, "one\ntwo\n");
        lines.append("four\n").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "one\ntwo\nfour\n");
    }

    #[test]
    fn line_log_reports_a_file_that_is_not_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("A.jsonl");
        fs::write(&path, b"\xff\n").unwrap();
        assert_eq!(Lines::open(&path).unwrap_err().kind(), ErrorKind::InvalidData);
    }
}
