//! Older versions of a file, under numbers: 1 is the latest.

use std::fmt::Display;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Returns the path of a file with a suffix: `arm.log.1`.
pub fn suffixed(path: &Path, suffix: impl Display) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(format!(".{suffix}"));
    name.into()
}

/// Makes room for a new number 1: each older version moves one number up, and number `kept` goes.
///
/// # Errors
/// If a file cannot be renamed or removed; a missing one is not an error.
pub fn make_room(kept: u32, path_of: impl Fn(u32) -> PathBuf) -> io::Result<()> {
    if kept == 0 {
        return Ok(());
    }
    absent_is_fine(fs::remove_file(path_of(kept)))?;
    let mut upwards = (1..kept).rev();
    upwards.try_for_each(|n| absent_is_fine(fs::rename(path_of(n), path_of(n + 1))))
}

/// Takes a missing file for one that is removed already.
///
/// # Errors
/// Any other error.
pub fn absent_is_fine(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn older_versions_move_up_over_gaps_and_the_last_goes() {
        let folder = tempfile::tempdir().unwrap();
        let path_of = |number: u32| suffixed(&folder.path().join("a.log"), number);
        for number in [1, 3, 4] {
            fs::write(path_of(number), number.to_string()).unwrap();
        }
        make_room(0, path_of).unwrap();
        make_room(4, path_of).unwrap();
        let found = (1..=5).map(|number| fs::read_to_string(path_of(number)).unwrap_or_default());
        assert_eq!(found.collect::<Vec<_>>(), ["", "1", "", "3", ""]);
    }
}
