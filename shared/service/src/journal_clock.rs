//! Wall time of journal records. Records carry times of the monotonic clock, which restarts with
//! the machine; a small file beside each journal has the offsets to the wall clock by record. It is
//! an aid for readers: no service depends on it, and a failed write is only logged.

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::{Time, clock};

/// Change of the offset that is noted: the clock was set, the machine slept or was restarted, ns.
const CHANGE_NS: u64 = 1_000_000_000;
/// Most entries; the oldest are dropped.
const ENTRIES_MAX: usize = 256;

/// Lead of the wall clock over the monotonic one, from a record on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Entry {
    seq: u64,
    wall_minus_monotonic_ns: i64,
}

/// Writes the offsets of a journal.
#[derive(Debug)]
pub(crate) struct JournalClock {
    file: PathBuf,
    /// The offset noted last; `None` before the first record of this process.
    noted_ns: Option<i64>,
}

impl JournalClock {
    /// The clock of the journal at `journal`.
    pub(crate) fn of(journal: &Path) -> Self {
        Self { file: file_of(journal), noted_ns: None }
    }

    /// Notes the present offset for record `seq` and those after it, if it has changed.
    pub(crate) fn note(&mut self, seq: u64) {
        self.note_offset(seq, wall_minus_monotonic_ns());
    }

    fn note_offset(&mut self, seq: u64, offset_ns: i64) {
        let is_near = |known: i64| known.abs_diff(offset_ns) < CHANGE_NS;
        if self.noted_ns.is_some_and(is_near) {
            return;
        }
        // Whatever becomes of the write: it is not tried again with every record.
        self.noted_ns = Some(offset_ns);
        // Entries from this number on are of a journal that was set aside.
        let mut entries = read(&self.file);
        entries.retain(|entry| entry.seq < seq);
        if entries.last().is_some_and(|last| is_near(last.wall_minus_monotonic_ns)) {
            return;
        }
        entries.push(Entry { seq, wall_minus_monotonic_ns: offset_ns });
        let oldest = entries.len().saturating_sub(ENTRIES_MAX);
        let lines = entries[oldest..].iter().filter_map(|entry| serde_json::to_string(entry).ok());
        let text: String = lines.map(|line| line + "\n").collect();
        if let Err(error) = safe_files::replace_private(&self.file, text) {
            tracing::debug!(%error, file = %self.file.display(), "wall time not noted");
        }
    }
}

/// The offsets of a journal, to be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct WallTimes(Vec<Entry>);

impl WallTimes {
    /// Reads the offsets of the journal at `journal`; `None` if they are unknown.
    pub(crate) fn of(journal: &Path) -> Self {
        Self(read(&file_of(journal)))
    }

    /// Returns the wall time of record `seq`, which was written at `at`: milliseconds since 1970.
    pub(crate) fn unix_ms(&self, seq: u64, at: Time) -> Option<u64> {
        let entry = self.0.iter().rfind(|entry| entry.seq <= seq)?;
        let ns = i128::from(at.ns()) + i128::from(entry.wall_minus_monotonic_ns);
        u64::try_from(ns / 1_000_000).ok()
    }
}

fn wall_minus_monotonic_ns() -> i64 {
    let wall = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let wall_ns = i64::try_from(wall.as_nanos()).unwrap_or(i64::MAX);
    wall_ns.saturating_sub_unsigned(clock::now().ns())
}

fn read(file: &Path) -> Vec<Entry> {
    let text = fs::read_to_string(file).unwrap_or_default();
    text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect()
}

/// The file `policy.clock` next to `policy.journal`.
fn file_of(journal: &Path) -> PathBuf {
    journal.with_extension("clock")
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: i64 = 1_000_000_000;

    #[test]
    fn wall_time_follows_the_offset_of_its_record() {
        let folder = tempfile::tempdir().unwrap();
        let journal = folder.path().join("policy.journal");
        let mut clock = JournalClock::of(&journal);
        clock.note_offset(1, 1_700_000_000 * S);
        clock.note_offset(4, 1_700_000_000 * S + S / 2);
        // The wall clock was set; then the machine restarted, with it the service.
        clock.note_offset(7, 1_700_000_500 * S);
        JournalClock::of(&journal).note_offset(9, 1_800_000_000 * S);
        let times = WallTimes::of(&journal);
        let unix_s = |seq| times.unix_ms(seq, Time(10 * S as u64)).map(|ms| ms / 1_000);
        assert_eq!([1, 6, 7, 8, 9].map(unix_s), {
            let (first, set, restarted) = (1_700_000_010, 1_700_000_510, 1_800_000_010);
            [first, first, set, set, restarted].map(Some)
        });
        assert_eq!(times.0.len(), 3, "a second is no change");
        assert_eq!(unix_s(0), None);
    }

    #[test]
    fn wall_time_of_a_journal_that_begins_again_forgets_the_former_one() {
        let folder = tempfile::tempdir().unwrap();
        let journal = folder.path().join("arm.journal");
        JournalClock::of(&journal).note_offset(500, 100 * S);
        JournalClock::of(&journal).note_offset(1, 100 * S);
        assert_eq!(WallTimes::of(&journal).0, [Entry { seq: 1, wall_minus_monotonic_ns: 100 * S }]);
        assert_eq!(WallTimes::of(&folder.path().join("none.journal")), WallTimes::default());
    }

    #[test]
    fn wall_time_file_is_bounded() {
        let folder = tempfile::tempdir().unwrap();
        let journal = folder.path().join("arm.journal");
        let mut clock = JournalClock::of(&journal);
        (1..=2 * ENTRIES_MAX as u64).for_each(|n| clock.note_offset(n, 10 * S * n as i64));
        assert_eq!(WallTimes::of(&journal).0.len(), ENTRIES_MAX);
    }
}
