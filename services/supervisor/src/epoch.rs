//! Epochs of a group's journals.
//!
//! Every identifier that is ever written counts within an epoch. A fresh start puts the old
//! journals aside, under the old epoch's number, and begins a new one, so that nothing that was
//! published before can be mistaken for a new message.

use std::fs;
use std::io::{self, ErrorKind};
use std::path::PathBuf;
use std::time::{SystemTime, UNIX_EPOCH};

use service::group::GroupPaths;
use service::journal_set::{Behind, JournalSet, Unusable, check_agreement};
use thiserror::Error;

/// A group's journals cannot be used.
#[derive(Debug, Error)]
pub enum EpochError {
    /// The set of journals cannot be read or written.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// Every journal that is missing, damaged, or not of this set.
    #[error("{}", lines(.0))]
    Journals(Vec<Unusable>),
    /// A journal that is older than another.
    #[error("{0}")]
    Behind(#[from] Behind),
}

fn lines(unusable: &[Unusable]) -> String {
    unusable.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Returns the current epoch, whose journals are all there; a new one if there is none or `fresh` is
/// set.
pub(crate) fn open(paths: &GroupPaths, fresh: bool) -> Result<u64, EpochError> {
    let found = match JournalSet::load(paths) {
        // A fresh start replaces an invalid file.
        Err(error) if fresh && error.kind() == ErrorKind::InvalidData => None,
        found => found?,
    };
    let old = found.as_ref().map_or(0, |set| set.epoch);
    let (set, is_new) = match found {
        Some(set) if !fresh => (set, false),
        found => (JournalSet::renewed(paths, found.as_ref(), now_s().max(old + 1)), true),
    };
    if fresh {
        put_journals_aside(paths, old)?;
    }
    let unusable = set.check(paths);
    if !unusable.is_empty() {
        return Err(EpochError::Journals(unusable));
    }
    if !is_new {
        check_agreement(paths, &set)?;
    }
    // On a full disk a group starts as long as nothing has to be written.
    if is_new {
        set.save(paths)?;
    }
    Ok(set.epoch)
}

fn put_journals_aside(paths: &GroupPaths, epoch: u64) -> io::Result<()> {
    let journals = paths.journal();
    let aside = free_folder(paths, epoch);
    match fs::rename(&journals, &aside) {
        Err(error) if error.kind() == ErrorKind::NotFound => {}
        moved => {
            moved?;
            tracing::info!(to = %aside.display(), "old journals put aside");
        }
    }
    fs::create_dir_all(journals)
}

/// `journal-EPOCH`, or with a further number where an interrupted start has left one.
fn free_folder(paths: &GroupPaths, epoch: u64) -> PathBuf {
    let numbered = (2..).map(|n| format!("journal-{epoch}-{n}"));
    let names = std::iter::once(format!("journal-{epoch}")).chain(numbered);
    let mut folders = names.map(|name| paths.root().join(name));
    folders.find(|folder| !folder.exists()).expect("there are more numbers than folders")
}

/// Seconds since 1970: later epochs are larger even where the file of the earlier one is lost.
fn now_s() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(1, |time| time.as_secs())
}

#[cfg(test)]
mod tests {
    use service::group::GroupName;

    use super::*;

    fn lab(home: &tempfile::TempDir) -> GroupPaths {
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("lab").unwrap()).unwrap();
        fs::create_dir_all(paths.journal()).unwrap();
        paths
    }

    #[test]
    fn epoch_lasts_until_a_fresh_start_moves_its_journals() {
        let home = tempfile::tempdir().unwrap();
        let paths = lab(&home);
        let first = open(&paths, false).unwrap();
        assert_eq!(open(&paths, false).unwrap(), first);
        fs::write(paths.journal().join("facts"), "facts").unwrap();
        let second = open(&paths, true).unwrap();
        assert!(second > first);
        assert_eq!(fs::read_dir(paths.journal()).unwrap().count(), 0);
        let aside = paths.root().join(format!("journal-{first}")).join("facts");
        assert_eq!(fs::read_to_string(aside).unwrap(), "facts");
        assert_eq!(open(&paths, false).unwrap(), second);
    }

    #[test]
    fn epoch_file_that_is_damaged_is_rejected() {
        let home = tempfile::tempdir().unwrap();
        let paths = lab(&home);
        open(&paths, false).unwrap();
        let text = fs::read_to_string(paths.epoch_file()).unwrap();
        for damaged in ["", "1795365207\n", &text.replace("false", "true"), &text[1..]] {
            fs::write(paths.epoch_file(), damaged).unwrap();
            let error = open(&paths, false).unwrap_err().to_string();
            assert!(error.contains("--fresh"), "{damaged:?}: {error}");
        }
        open(&paths, true).unwrap();
    }

    #[test]
    fn every_unusable_journal_is_named_with_its_way_out() {
        let home = tempfile::tempdir().unwrap();
        let paths = lab(&home);
        open(&paths, false).unwrap();
        fs::write(paths.journal_file("arm"), "").unwrap();
        fs::write(paths.journal_file("speech"), "dear diary").unwrap();
        let error = open(&paths, false).unwrap_err().to_string();
        assert!(error.contains("arm.journal: the file is empty"), "{error}");
        assert!(error.contains("`whichone journal set-aside arm`"), "{error}");
        assert!(error.contains("speech.journal: not a journal"), "{error}");
        assert!(!error.contains("policy"), "{error}");
    }
}
