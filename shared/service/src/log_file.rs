//! The services' logs: files that the services themselves append to, so that nothing is lost when
//! either side dies and no writer waits for a reader. The supervisor only bounds their size.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, Read, Seek, SeekFrom};
use std::os::unix::fs::{OpenOptionsExt, PermissionsExt};
use std::path::Path;

use config::Log;
use safe_files::{Draft, Readers, make_room, suffixed};

use crate::printable::one_line;

/// Mode of a log: its owner's alone.
const PRIVATE: u32 = 0o600;
/// Lines and bytes of a log's tail that is shown to an operator.
const TAIL_LINES_MAX: usize = 12;
const TAIL_BYTES_MAX: u64 = 4096;

/// Opens a log for appending, after rotating a large one.
///
/// # Errors
/// The file cannot be opened.
pub fn open(path: &Path, limits: &Log) -> io::Result<File> {
    let log = appended(path)?;
    if size(path) > limits.file_bytes_max {
        make_room(limits.files_kept, |number| suffixed(path, number))?;
        if limits.files_kept > 0 {
            fs::rename(path, suffixed(path, 1))?;
        } else {
            fs::remove_file(path)?;
        }
        return appended(path);
    }
    Ok(log)
}

/// Opens a file, which only its owner can then read: logs hold utterances of people.
fn appended(path: &Path) -> io::Result<File> {
    let log = OpenOptions::new().append(true).create(true).mode(PRIVATE).open(path)?;
    if log.metadata()?.permissions().mode() & 0o7777 != PRIVATE {
        log.set_permissions(Permissions::from_mode(PRIVATE))?;
    }
    Ok(log)
}

/// Puts the newest part of an overgrown log aside and empties it, under the feet of the service
/// that appends to it. Lines written during the copy are lost: a log that grows this fast has
/// already reported its cause.
///
/// # Errors
/// The copy cannot be made; the log is truncated nevertheless.
pub fn bound(path: &Path, limits: &Log) -> io::Result<bool> {
    let bytes = size(path);
    if bytes <= limits.file_bytes_max {
        return Ok(false);
    }
    let kept = if limits.files_kept > 0 {
        make_room(limits.files_kept, |number| suffixed(path, number))
            .and_then(|()| copy_end(path, bytes, limits.file_bytes_max))
    } else {
        Ok(())
    };
    OpenOptions::new().write(true).open(path)?.set_len(0)?;
    kept.map(|()| true)
}

/// Returns the last lines of a log from byte `from` on: those of the last incarnation.
pub fn tail(path: &Path, from: u64) -> Vec<String> {
    let read = || -> io::Result<String> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        // A log that has been put aside meanwhile is shorter than it was.
        let from = if from <= length { from } else { 0 };
        file.seek(SeekFrom::Start(from.max(length.saturating_sub(TAIL_BYTES_MAX))))?;
        let mut bytes = Vec::new();
        file.take(TAIL_BYTES_MAX).read_to_end(&mut bytes)?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    };
    let text = read().unwrap_or_default();
    let lines: Vec<&str> = text.lines().collect();
    let last = &lines[lines.len().saturating_sub(TAIL_LINES_MAX)..];
    last.iter().map(|line| one_line(line).into_owned()).collect()
}

/// Returns the size of a log, bytes; 0 if it does not exist.
pub fn size(path: &Path) -> u64 {
    path.metadata().map_or(0, |meta| meta.len())
}

fn copy_end(path: &Path, bytes: u64, bytes_max: u64) -> io::Result<()> {
    let mut log = File::open(path)?;
    log.seek(SeekFrom::Start(bytes.saturating_sub(bytes_max)))?;
    let mut kept = Draft::of(&suffixed(path, 1), Readers::Owner)?;
    io::copy(&mut log.take(bytes_max), &mut kept)?;
    kept.replace()
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    fn limits(files_kept: u32) -> Log {
        Log { level: "info".into(), json: false, file_bytes_max: 100, files_kept }
    }

    fn read(path: &Path) -> String {
        fs::read_to_string(path).unwrap_or_default()
    }

    #[test]
    fn large_log_is_rotated_at_the_next_start() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("arm.log");
        for round in 0..5 {
            let mut log = open(&path, &limits(2)).unwrap();
            write!(log, "{round}{}", "x".repeat(100)).unwrap();
        }
        assert!(read(&path).starts_with('4'));
        assert!(read(&suffixed(&path, 1)).starts_with('3'));
        assert!(read(&suffixed(&path, 2)).starts_with('2'));
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3);
    }

    #[test]
    fn log_is_its_owners_alone() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("supervisor.log");
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        // Whatever the umask is: that of a file that every user could write.
        for old in ["", "small", &"large".repeat(100)] {
            fs::write(&path, old).unwrap();
            fs::set_permissions(&path, Permissions::from_mode(0o666)).unwrap();
            let mut log = open(&path, &limits(1)).unwrap();
            assert_eq!(mode(&path), 0o600);
            write!(log, "{}", "x".repeat(200)).unwrap();
            assert!(bound(&path, &limits(1)).unwrap());
            assert_eq!(mode(&suffixed(&path, 1)), 0o600);
        }
        fs::write(&path, "large".repeat(100)).unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o666)).unwrap();
        open(&path, &limits(1)).unwrap();
        assert_eq!((mode(&path), mode(&suffixed(&path, 1))), (0o600, 0o600));
    }

    #[test]
    fn a_small_log_is_continued() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("arm.log");
        for word in ["one", "two"] {
            write!(open(&path, &limits(2)).unwrap(), "{word} ").unwrap();
        }
        assert_eq!(read(&path), "one two ");
        assert!(!bound(&path, &limits(2)).unwrap());
    }

    #[test]
    fn growing_log_is_bounded() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("arm.log");
        let mut log = open(&path, &limits(2)).unwrap();
        write!(log, "old{}new", "x".repeat(200)).unwrap();
        assert!(bound(&path, &limits(2)).unwrap());
        write!(log, "next").unwrap();
        assert_eq!(read(&path), "next", "the writer continues at the beginning");
        let kept = read(&suffixed(&path, 1));
        assert_eq!(kept.len(), 100);
        assert!(kept.ends_with("new"));
        write!(log, "{}", "x".repeat(200)).unwrap();
        assert!(bound(&path, &limits(0)).unwrap());
        assert_eq!(size(&path), 0);
    }

    #[test]
    fn log_tail_holds_the_last_lines_of_the_last_incarnation() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("arm.log");
        fs::write(&path, "before\nafter\n\x1b[1mlast\n").unwrap();
        assert_eq!(tail(&path, 7), ["after", "\\u{1b}[1mlast"]);
        let many: String = (0..1000).map(|line| format!("line {line}\n")).collect();
        fs::write(&path, many).unwrap();
        let lines = tail(&path, 0);
        assert_eq!(lines.len(), TAIL_LINES_MAX);
        assert_eq!(lines.last().unwrap(), "line 999");
        assert_eq!(tail(&path, 1 << 40).len(), TAIL_LINES_MAX);
        assert_eq!(tail(&folder.path().join("none"), 0), [""; 0]);
    }
}
