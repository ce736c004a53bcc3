//! Epochs of a group's journals.
//!
//! Every identifier that is ever written counts within an epoch. A fresh start puts the old
//! journals aside, under the old epoch's number, and begins a new one, so that nothing that was
//! published before can be mistaken for a new message.

use std::fs;
use std::io::{self, ErrorKind};
use std::time::{SystemTime, UNIX_EPOCH};

use service::group::GroupPaths;

/// Returns the current epoch; a new one if there is none or `fresh` is set.
pub(crate) fn open(paths: &GroupPaths, fresh: bool) -> io::Result<u64> {
    let found = match read(paths) {
        // A fresh start replaces an invalid file.
        Err(error) if fresh && error.kind() == ErrorKind::InvalidData => None,
        found => found?,
    };
    match found {
        Some(epoch) if !fresh => return Ok(epoch),
        Some(epoch) => put_journals_aside(paths, epoch)?,
        None if fresh => put_journals_aside(paths, 0)?,
        None => {}
    }
    let epoch = now_s().max(found.map_or(1, |epoch| epoch + 1));
    service::replace_file_synced(&paths.epoch_file(), format!("{epoch}\n"))?;
    Ok(epoch)
}

fn read(paths: &GroupPaths) -> io::Result<Option<u64>> {
    let path = paths.epoch_file();
    let text = match fs::read_to_string(&path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        text => text?,
    };
    let number = text.trim().parse().map_err(|_| {
        let what = format!(
            "{}: expected an epoch number, found {text:?}; help: start with `whichone up --fresh`",
            path.display()
        );
        io::Error::new(ErrorKind::InvalidData, what)
    });
    number.map(Some)
}

fn put_journals_aside(paths: &GroupPaths, epoch: u64) -> io::Result<()> {
    let journals = paths.journal();
    let aside = paths.root().join(format!("journal-{epoch}"));
    match fs::rename(&journals, &aside) {
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        moved => {
            moved?;
            tracing::info!(to = %aside.display(), "old journals put aside");
        }
    }
    fs::create_dir_all(journals)
}

/// Seconds since 1970: later epochs are larger even where the file of the earlier one is lost.
fn now_s() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs())
}

#[cfg(test)]
mod tests {
    use service::group::GroupName;

    use super::*;

    #[test]
    fn epoch_lasts_until_a_fresh_start_moves_its_journals() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        fs::create_dir_all(paths.journal()).unwrap();
        let first = open(&paths, false).unwrap();
        assert_eq!(open(&paths, false).unwrap(), first);
        fs::write(paths.journal().join("arm.journal"), "facts").unwrap();
        let second = open(&paths, true).unwrap();
        assert!(second > first);
        assert_eq!(fs::read_dir(paths.journal()).unwrap().count(), 0);
        let aside = paths.root().join(format!("journal-{first}")).join("arm.journal");
        assert_eq!(fs::read_to_string(aside).unwrap(), "facts");
        assert_eq!(open(&paths, false).unwrap(), second);
    }

    #[test]
    fn epoch_file_without_a_number_is_rejected() {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        fs::create_dir_all(paths.root()).unwrap();
        fs::write(paths.epoch_file(), "soon").unwrap();
        assert!(open(&paths, false).unwrap_err().to_string().contains("--fresh"));
        open(&paths, true).unwrap();
    }
}
