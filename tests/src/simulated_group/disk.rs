//! A journal on a simulated disk: the real journal over a real file, whose unsynced bytes a crash may
//! leave in any state in which a disk may leave them.

use std::fs;
use std::path::{Path, PathBuf};

use journal::{Header, Journal};
use serde::Serialize;
use serde::de::DeserializeOwned;
use tempfile::TempDir;
use vocabulary::Rng;

/// Bytes that a disk writes as a whole.
const SECTOR: usize = 512;
/// Bytes from which a journal is cut short where nothing is in progress: little, so that every
/// dialogue sees it.
const ROTATE_BYTES: u64 = 8 << 10;

/// The journal of one process, and what must be in it.
pub(super) struct Disk<R> {
    folder: TempDir,
    header: Header,
    journal: Option<Journal<R>>,
    /// Whether it was made: from then on it must be there.
    exists: bool,
    /// Content of the file.
    file: Vec<R>,
    /// Records whose write was cut short by a crash: all of them are there, or none.
    unknown: Vec<R>,
    /// Every record that was ever durable.
    all: Vec<R>,
}

impl<R: Serialize + DeserializeOwned + Clone + PartialEq> Disk<R> {
    pub(super) fn new(record: &str) -> Self {
        // In memory where the machine has a place for it: a real sync costs more than a dialogue.
        let memory = Path::new("/dev/shm");
        let folder = match memory.is_dir() {
            true => tempfile::tempdir_in(memory),
            false => tempfile::tempdir(),
        };
        let header =
            Header { record: record.to_owned(), group: "sim".to_owned(), epoch: 1, generation: 1 };
        Self {
            folder: folder.expect("a folder for the journal"),
            header,
            journal: None,
            exists: false,
            file: Vec::new(),
            unknown: Vec::new(),
            all: Vec::new(),
        }
    }

    fn path(&self) -> PathBuf {
        self.folder.path().join("journal")
    }

    /// Every record that was ever durable, oldest first.
    pub(super) fn all(&self) -> &[R] {
        &self.all
    }

    /// Opens the journal after a start, and returns its records.
    ///
    /// # Panics
    /// If what was durable is not there, or a batch in part: the journal's invariant is broken.
    pub(super) fn open(&mut self) -> Vec<R> {
        self.close();
        let opened = match std::mem::replace(&mut self.exists, true) {
            true => Journal::open(&self.path(), &self.header),
            false => Journal::open_or_create(&self.path(), &self.header),
        };
        let (journal, recovered) = opened.unwrap_or_else(|e| panic!("recovery of a journal: {e}"));
        let found = recovered.records;
        let written = std::mem::take(&mut self.unknown);
        if found.len() > self.file.len() {
            self.file.extend(written.iter().cloned());
            self.all.extend(written);
        }
        assert!(found == self.file, "{} records found of {}", found.len(), self.file.len());
        self.journal = Some(journal);
        found
    }

    /// The process has ended; what it had not synced is lost.
    pub(super) fn close(&mut self) {
        self.journal = None;
    }

    /// Makes records durable, as the service loop does.
    pub(super) fn write(&mut self, records: Vec<R>) {
        self.append(&records);
        self.journal().sync().expect("a sync");
        self.file.extend(records.iter().cloned());
        self.all.extend(records);
    }

    /// Continues in a new file if this one is long.
    pub(super) fn shorten(&mut self, snapshot: impl FnOnce() -> Option<Vec<R>>) {
        if self.journal().bytes() < ROTATE_BYTES {
            return;
        }
        let Some(snapshot) = snapshot() else { return };
        self.journal().rotate(&snapshot).expect("a rotation");
        self.file = snapshot;
    }

    /// The machine dies while it writes records: of the file's new bytes any sector may be missing,
    /// and any length of them may be known.
    pub(super) fn tear(&mut self, records: Vec<R>, rng: &mut Rng) {
        let durable = self.journal().bytes() as usize;
        self.append(&records);
        self.journal().sync().expect("a sync");
        self.close();
        let mut bytes = fs::read(self.path()).expect("the journal's file");
        match rng.below(4) {
            // All of it was written, and never acknowledged.
            0 => {}
            1 => cut(&mut bytes, durable, rng),
            2 => lose_sectors(&mut bytes, durable, rng),
            _ => {
                lose_sectors(&mut bytes, durable, rng);
                cut(&mut bytes, durable, rng);
            }
        }
        fs::write(self.path(), bytes).expect("the journal's file");
        self.unknown = records;
    }

    fn append(&mut self, records: &[R]) {
        let journal = self.journal();
        records.iter().for_each(|record| journal.append(record).expect("a record that fits"));
    }

    fn journal(&mut self) -> &mut Journal<R> {
        self.journal.as_mut().expect("a running process has its journal open")
    }
}

fn cut(bytes: &mut Vec<u8>, durable: usize, rng: &mut Rng) {
    bytes.truncate(durable + rng.below(bytes.len() - durable + 1));
}

fn lose_sectors(bytes: &mut [u8], durable: usize, rng: &mut Rng) {
    let mut from = durable;
    while from < bytes.len() {
        let to = ((from / SECTOR + 1) * SECTOR).min(bytes.len());
        if rng.below(2) == 0 {
            bytes[from..to].fill(0);
        }
        from = to;
    }
}
