//! Journals: files with any damage, and whole files of any records.

use std::fs;
use std::path::Path;
use std::sync::LazyLock;

use arm::shell::ArmProgram;
use journal::{Header, Journal};
use policy::shell::PolicyProgram;
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use service::inspection::Part;
use service::service_loop::{Program, Record};
use speech::shell::SpeechProgram;
use tempfile::TempDir;

use super::bytes::{Input, MemoryFile, chosen};
use super::group::{Group, SETTINGS};

/// A record of any bytes.
struct Raw(Vec<u8>);

impl Serialize for Raw {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut bytes = to.serialize_tuple(self.0.len())?;
        self.0.iter().try_for_each(|byte| bytes.serialize_element(byte))?;
        bytes.end()
    }
}

impl<'de> Deserialize<'de> for Raw {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Vec::deserialize(from).map(Self)
    }
}

thread_local! {
    static FOLDER: TempDir = folder();
}

/// A folder in memory if possible: journals sync their files.
fn folder() -> TempDir {
    let memory = tempfile::tempdir_in("/dev/shm");
    memory.or_else(|_| tempfile::tempdir()).expect("a folder")
}

fn header() -> Header {
    Header { record: "fuzz/1".to_owned(), group: "fuzz".to_owned(), epoch: 7, generation: 1 }
}

/// Writes a new journal at `path`, one sync for each batch.
fn write<R: Serialize + for<'a> Deserialize<'a>>(path: &Path, batches: &[Vec<R>]) {
    let (mut journal, _) = Journal::open_or_create(path, &header()).expect("a new journal");
    for batch in batches {
        batch.iter().for_each(|record| journal.append(record).expect("small records"));
        journal.sync().expect("space in memory");
    }
}

/// The records of a valid journal, and its bytes.
static VALID: LazyLock<(Vec<String>, Vec<u8>)> = LazyLock::new(|| {
    let folder = folder();
    let path = folder.path().join("valid.journal");
    let batch = |n: usize| (0..n).map(|k| "word ".repeat(n + k)).collect::<Vec<_>>();
    let batches: Vec<_> = [1, 3, 2, 1].map(batch).into();
    write(&path, &batches);
    (batches.concat(), fs::read(&path).expect("it was written"))
});

/// A valid journal with damage: what is read is a beginning of what was written, never more and
/// never other records, and a journal that opens takes further ones.
pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    let (records, bytes) = &*VALID;
    let mut bytes = bytes.clone();
    input.patch(&mut bytes);
    if input.byte() % 2 == 1 {
        bytes.truncate(usize::from(input.u16()) % (bytes.len() + 1));
    }
    bytes.extend_from_slice(input.0);
    let file = MemoryFile::new(&bytes);
    if let Ok(reading) = journal::read::<String>(&file.path()) {
        assert!(records.starts_with(&reading.records), "{:?}", reading.records);
    }
    FOLDER.with(|folder| reopened(&folder.path().join("damaged.journal"), &bytes, records));
}

fn reopened(path: &Path, bytes: &[u8], records: &[String]) {
    fs::write(path, bytes).expect("space in memory");
    if let Ok((mut journal, recovered)) = Journal::<String>::open(path, &header()) {
        assert!(records.starts_with(&recovered.records), "{:?}", recovered.records);
        let next = "next".to_owned();
        journal.append(&next).expect("a small record");
        journal.sync().expect("space in memory");
        let read = journal::read::<String>(path).expect("it is valid now");
        assert_eq!(read.records, [recovered.records, vec![next]].concat());
    }
    fs::remove_file(path).expect("it was there");
}

/// A valid journal of any records, as `whichone journal` lists and verifies it.
pub(super) fn run_records(input: &[u8]) {
    let mut input = Input(input);
    match input.byte() % 3 {
        0 => inspected::<SpeechProgram>(&mut input),
        1 => inspected::<PolicyProgram>(&mut input),
        _ => inspected::<ArmProgram<drivers::Shipped>>(&mut input),
    }
}

fn inspected<P: Program>(input: &mut Input<'_>) {
    let mut records = Vec::new();
    while !input.is_empty() {
        let count = usize::from(input.u16());
        records.push(Raw(input.take(count).to_vec()));
    }
    FOLDER.with(|folder| {
        let path = folder.path().join("records.journal");
        write(&path, &[records]);
        let part = Part::<Record<P>>::read(&path);
        fs::remove_file(&path).expect("it was there");
        let Ok(part) = part else { return };
        let settings = std::slice::from_ref(&*SETTINGS);
        for record in part.records() {
            drop((P::describe(settings, record), P::explain(settings, record)));
            drop((P::describe(&[], record), P::explain(&[], record)));
        }
        let parts = [part];
        let _ = P::verify(std::slice::from_ref(&SETTINGS), &parts);
        let _ = P::shared_facts(&parts);
    });
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    vec![
        vec![],
        vec![1, 90, 0, 1, 255, 0],
        vec![0, 1, 120, 0],
        vec![2, 30, 0, 4, 0, 0, 0, 0, 100, 0, 1, 7, 1, 200, 0],
        chosen(0, chosen(0, b"WHICHJNL appended")),
    ]
}

/// The journals of one dialogue.
pub(super) fn record_seeds() -> Vec<Vec<u8>> {
    let mut group = Group::new();
    group.dialogue();
    let [speech, policy, arm] = group.journals();
    let seed = |(kind, records): (u8, Vec<Vec<u8>>)| {
        let records = records.into_iter().filter(|record| record.len() <= usize::from(u16::MAX));
        let framed =
            records.map(|record| [&(record.len() as u16).to_le_bytes()[..], &record].concat());
        chosen(kind, framed.take(6).collect::<Vec<_>>().concat())
    };
    (0..).zip([speech, policy, arm]).map(seed).collect()
}
