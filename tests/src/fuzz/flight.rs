//! Flights: files with any content that is sealed as it should be, replayed and listed.

use std::fs;

use grounding::shell::GroundingProgram;
use policy::shell::PolicyProgram;
use service::Time;
use service::flight::{Head, file_of, lines, replay};
use service::lifecycle::Environment;
use service::service_loop::Program;
use speech::shell::SpeechProgram;
use tempfile::TempDir;

use super::bytes::{Input, chosen};
use super::group::SETTINGS;

thread_local! {
    static FOLDER: TempDir = tempfile::tempdir().expect("a folder");
}

/// Whatever a file holds, it is replayed, or refused.
pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    match input.byte() % 3 {
        0 => replayed::<SpeechProgram>(input.0),
        1 => replayed::<GroundingProgram>(input.0),
        _ => replayed::<PolicyProgram>(input.0),
    }
}

fn replayed<P: Program>(entries: &[u8]) {
    let head = Head::of::<P>(&Environment::nowhere(), &SETTINGS, Time(1), 1);
    let head = postcard::to_stdvec(&head).expect("it was made here");
    let file = file_of(&[&head, entries].concat()).expect("memory");
    FOLDER.with(|folder| {
        let path = folder.path().join("any.flight");
        fs::write(&path, file).expect("space for a small file");
        if let Ok(report) = replay::<P>(&path, &[]) {
            assert!(report.events as usize <= entries.len(), "{report:?}");
        }
        let mut listed = 0;
        let count = |_| {
            listed += 1;
            Ok(())
        };
        let _ = lines::<P>(&path, count);
        assert!(listed <= entries.len(), "{listed}");
    });
}

/// No records; then `Started` at 5 ns, nothing stated, durable, a tick, and nothing stated.
pub(super) fn seeds() -> Vec<Vec<u8>> {
    let entries = [0, 0, 0, 5, 1, 2, 0, 0, 0, 0, 0, 1, 0, 6, 3, 2, 0, 0, 0, 0, 0];
    (0..3).map(|kind| chosen(kind, entries)).collect()
}
