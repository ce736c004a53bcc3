//! Tests of the journal on real files, with the damage and crashes that it must survive.

mod damage;
mod faults;
mod opening;
mod rotation;

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use tempfile::TempDir;

use crate::{Header, Journal, Recovered};

/// A record with a body whose length the tests choose.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Entry {
    number: u32,
    text: String,
    belief: Vec<f64>,
}

fn entry(number: u32) -> Entry {
    let belief = (0..number % 4).map(|i| f64::from(i) / 7.0).collect();
    Entry { number, text: format!("utterance {number}"), belief }
}

fn header() -> Header {
    Header { record: "entry/2".into(), group: "kitchen".into(), epoch: 3, generation: 1 }
}

/// A journal's path in a temporary folder.
struct TestJournal {
    folder: TempDir,
    path: PathBuf,
}

impl TestJournal {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("policy.journal");
        Self { folder, path }
    }

    fn open(&self) -> (Journal<Entry>, Recovered<Entry>) {
        Journal::open_or_create(&self.path, &header()).unwrap()
    }

    fn recover(&self) -> Recovered<Entry> {
        self.open().1
    }

    /// A journal with one sync per batch; returns the length of the file after each.
    fn write(&self, batches: &[&[Entry]]) -> Vec<u64> {
        let (mut journal, _) = self.open();
        let mut lens = vec![journal.bytes()];
        for batch in batches {
            batch.iter().for_each(|record| journal.append(record).unwrap());
            journal.sync().unwrap();
            lens.push(journal.bytes());
        }
        lens
    }

    fn bytes(&self) -> Vec<u8> {
        std::fs::read(&self.path).unwrap()
    }

    fn overwrite(&self, bytes: &[u8]) {
        std::fs::write(&self.path, bytes).unwrap();
    }

    fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<_> =
            entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    fn old(&self, n: u32) -> PathBuf {
        Path::new(&format!("{}.{n}", self.path.display())).to_owned()
    }
}
