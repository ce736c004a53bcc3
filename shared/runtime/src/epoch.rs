//! The epoch of a group, and the file that holds it: one line of JSON, then its checksum. The line
//! holds the set of journals as well, which only services with a journal read.

use std::fs;
use std::io::{self, ErrorKind};

use messages::Epoch;
use serde::Deserialize;

use crate::group::GroupPaths;

/// The part of the file's line that every process of the group reads.
#[derive(Deserialize)]
struct Line {
    epoch: u64,
}

/// Returns the group's epoch; `None` before its first start.
///
/// # Errors
/// The file cannot be read, is damaged or of another version (`InvalidData`).
pub fn read(paths: &GroupPaths) -> io::Result<Option<Epoch>> {
    let path = paths.epoch_file();
    match fs::read_to_string(&path) {
        Ok(text) => match whole_line(&text).and_then(|line| serde_json::from_str(line).ok()) {
            Some(Line { epoch }) => Ok(Some(Epoch(epoch))),
            None => {
                let what = format!("{}: expected a group's epoch, found damage", path.display());
                Err(io::Error::new(ErrorKind::InvalidData, what))
            }
        },
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error),
    }
}

/// Returns the first line of the file's text if its checksum follows.
pub fn whole_line(text: &str) -> Option<&str> {
    let (line, sum) = text.split_once('\n')?;
    (sum.trim() == checksum(line)).then_some(line)
}

/// Returns the file's text for this line.
pub fn with_checksum(line: &str) -> String {
    format!("{line}\n{}\n", checksum(line))
}

fn checksum(line: &str) -> String {
    let mut hash = scene::StableHash::default();
    hash.bytes(line.as_bytes());
    format!("{:016x}", hash.value())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use crate::group::GroupName;

    #[test]
    fn epoch_is_read_from_a_whole_file_only() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        assert_eq!(read(&paths).unwrap(), None);
        fs::create_dir_all(paths.root()).unwrap();
        let text = with_checksum(r#"{"epoch":7,"numbers_over":0,"journals":{}}"#);
        fs::write(paths.epoch_file(), &text).unwrap();
        assert_eq!(read(&paths).unwrap(), Some(Epoch(7)));
        for damaged in ["", "7\n", &text.replace('7', "8")] {
            fs::write(paths.epoch_file(), damaged).unwrap();
            assert_eq!(read(&paths).unwrap_err().kind(), ErrorKind::InvalidData, "{damaged:?}");
        }
    }
}
