//! When each token was used last: a file of the console's, to the minute, which `whichone token list` reads.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use safe_files::{read_private, replace_private};
use service::group::GroupPaths;

/// Uses that are noted at most so often, seconds.
const NOTE_EVERY_S: u64 = 60;

/// Unix seconds of the last use, by the token's name.
pub(crate) type Uses = BTreeMap<String, u64>;

/// Returns the file of the uses.
pub(crate) fn uses_file(paths: &GroupPaths) -> PathBuf {
    paths.root().join("http.uses")
}

/// Reads the file; one that cannot be read has none.
pub(crate) fn read(path: &Path) -> Uses {
    serde_json::from_str(&read_private(path).unwrap_or_default()).unwrap_or_default()
}

/// The uses, and where they are stored.
#[derive(Debug)]
pub(crate) struct UseFile {
    path: PathBuf,
    uses: Mutex<Uses>,
}

impl UseFile {
    pub(crate) fn open(path: PathBuf) -> Self {
        let uses = Mutex::new(read(&path));
        Self { path, uses }
    }

    /// Notes a use of a token that is one of `known`, and stores it where the last note is old; may block.
    pub(crate) fn note<'a>(&self, name: &str, now_s: u64, known: impl Iterator<Item = &'a str>) {
        // Every change leaves a consistent map.
        let mut uses = self.uses.lock().unwrap_or_else(PoisonError::into_inner);
        let is_recent = |last: &u64| (*last..last.saturating_add(NOTE_EVERY_S)).contains(&now_s);
        if uses.get(name).is_some_and(is_recent) {
            return;
        }
        let known: Vec<&str> = known.collect();
        uses.retain(|name, _| known.contains(&name.as_str()));
        uses.insert(name.to_owned(), now_s);
        let text = serde_json::to_string(&*uses).unwrap_or_default();
        if let Err(error) = replace_private(&self.path, text) {
            tracing::warn!(%error, "the last use of a token is not stored");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uses_are_noted_to_the_minute_and_end_with_their_token() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("http.uses");
        let uses = UseFile::open(path.clone());
        uses.note("hall", 1_000, ["hall", "kitchen"].into_iter());
        uses.note("hall", 1_059, ["hall", "kitchen"].into_iter());
        assert_eq!(read(&path), Uses::from([("hall".to_owned(), 1_000)]));
        UseFile::open(path.clone()).note("hall", 1_060, ["hall"].into_iter());
        assert_eq!(read(&path), Uses::from([("hall".to_owned(), 1_060)]));
        UseFile::open(path.clone()).note("kitchen", 5, ["kitchen"].into_iter());
        assert_eq!(read(&path), Uses::from([("kitchen".to_owned(), 5)]));
    }
}
