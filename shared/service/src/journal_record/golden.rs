//! Golden files of `whichone journal --json`, for the tests of services that write records.

use messages::Service;

use super::{JournalLine, JournalRecord};
use crate::Time;
use crate::json_schema::with_schema;

/// Wall time at the beginning of the monotonic clock, milliseconds since 1970.
const BEGAN_MS: u64 = 1_700_000_000_000;

/// Returns timed records with texts as `whichone journal --json` prints them, numbered from 1.
///
/// # Panics
/// If one cannot be written as JSON.
pub fn lines(records: impl IntoIterator<Item = (Time, String, JournalRecord)>) -> String {
    let line = |(seq, (at, text, record)): (u64, (Time, String, JournalRecord))| {
        let (at_ns, unix_ms) = (at.ns(), Some(BEGAN_MS + at.ns() / 1_000_000));
        let line = serde_json::to_string(&JournalLine { seq, at_ns, unix_ms, text, record });
        let line = line.unwrap_or_else(|error| panic!("record {seq}: {error}"));
        with_schema(&line) + "\n"
    };
    (1..).zip(records).map(line).collect()
}

/// Compares lines with the golden file of a service. `WHICHONE_BLESS=1` rewrites it.
///
/// # Panics
/// If they differ, or if the file cannot be written.
pub fn check(service: Service, found: &str) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");
    let file = format!("{folder}/journal_{}.jsonl", service.name());
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        let written = std::fs::write(&file, found);
        written.unwrap_or_else(|error| panic!("{file}: {error}"));
    }
    let golden = std::fs::read_to_string(&file).unwrap_or_default();
    assert_eq!(found, golden, "if the change is intended, run this test with WHICHONE_BLESS=1");
}
