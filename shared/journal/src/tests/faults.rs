//! A disk that fails: nothing half written stays, nothing unacknowledged is believed.

use std::cell::Cell;
use std::io::{self, ErrorKind};
use std::rc::Rc;

use super::{Entry, entry, header};
use crate::SyncError;
use crate::header;
use crate::scan::{Ending, Position, Scan, scan};
use crate::tail::{Storage, Tail};

/// A disk with faults that are set before each operation.
#[derive(Debug, Default)]
struct Disk {
    bytes: Vec<u8>,
    /// The next write stops after this many bytes, with this error.
    write_fault: Option<(usize, ErrorKind)>,
    sync_fault: bool,
    truncate_fault: bool,
    /// True if no more space is given.
    full: Rc<Cell<bool>>,
    syncs: usize,
}

impl Storage for &mut Disk {
    fn write_at(&mut self, bytes: &[u8], at: u64) -> io::Result<()> {
        assert_eq!(at, self.bytes.len() as u64, "every write appends");
        let fault = self.write_fault.take();
        let len = fault.map_or(bytes.len(), |(len, _)| len.min(bytes.len()));
        self.bytes.extend_from_slice(&bytes[..len]);
        fault.map_or(Ok(()), |(_, kind)| Err(kind.into()))
    }

    fn truncate(&mut self, len: u64) -> io::Result<()> {
        if std::mem::take(&mut self.truncate_fault) {
            return Err(ErrorKind::Other.into());
        }
        self.bytes.truncate(len as usize);
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        self.syncs += 1;
        if std::mem::take(&mut self.sync_fault) { Err(ErrorKind::Other.into()) } else { Ok(()) }
    }

    fn reserve(&mut self, _: u64, _: u64) -> io::Result<()> {
        if self.full.get() { Err(ErrorKind::StorageFull.into()) } else { Ok(()) }
    }
}

impl Disk {
    fn new() -> Self {
        Self { bytes: header::encode(&header(), 1, 0).unwrap().0, ..Self::default() }
    }

    fn tail(&mut self) -> Tail<&mut Self> {
        let position = self.scan().position;
        Tail::new(self, position)
    }

    fn scan(&self) -> Scan<Entry> {
        scan(&self.bytes, &header::decode(&self.bytes).unwrap()).unwrap()
    }

    fn records(&self) -> Vec<Entry> {
        let Scan { records, ending, .. } = self.scan();
        assert_eq!(ending, Ending::Whole);
        records
    }
}

/// Appends and syncs one record.
fn put(tail: &mut Tail<&mut Disk>, record: &Entry) -> Result<(), SyncError> {
    tail.append_all(std::slice::from_ref(record)).unwrap();
    tail.sync(false)
}

#[test]
fn journal_sync_writes_once() {
    let mut disk = Disk::new();
    let mut tail = disk.tail();
    (1..=9).for_each(|n| tail.append_all(&[entry(n)]).unwrap());
    tail.sync(false).unwrap();
    assert_eq!(disk.syncs, 1);
    assert_eq!(disk.records(), (1..=9).map(entry).collect::<Vec<_>>());
}

#[test]
fn journal_on_a_full_disk_stays_valid_and_keeps_its_records() {
    for written in 0..60 {
        let mut disk = Disk::new();
        put(&mut disk.tail(), &entry(1)).unwrap();
        disk.write_fault = Some((written, ErrorKind::StorageFull));
        let mut tail = disk.tail();
        assert!(matches!(put(&mut tail, &entry(2)), Err(SyncError::Full(_))));
        tail.append_all(&[entry(3)]).unwrap();
        tail.sync(false).unwrap();
        assert_eq!(disk.records(), [entry(1), entry(2), entry(3)], "after {written} bytes");
    }
}

#[test]
fn journal_truncates_a_failed_write() {
    let mut disk = Disk::new();
    put(&mut disk.tail(), &entry(1)).unwrap();
    disk.write_fault = Some((11, ErrorKind::Other));
    assert!(matches!(put(&mut disk.tail(), &entry(2)), Err(SyncError::Write(_))));
    assert_eq!(disk.records(), [entry(1)]);
}

#[test]
fn journal_is_poisoned_after_a_failed_sync() {
    let mut disk = Disk::new();
    put(&mut disk.tail(), &entry(1)).unwrap();
    disk.sync_fault = true;
    let mut tail = disk.tail();
    assert!(matches!(put(&mut tail, &entry(2)), Err(SyncError::Unknown(_))));
    assert!(matches!(tail.sync(false), Err(SyncError::Poisoned)));
    assert!(matches!(put(&mut tail, &entry(3)), Err(SyncError::Poisoned)));
    assert_eq!(disk.records(), [entry(1)], "the record was not acknowledged");
}

#[test]
fn journal_is_poisoned_by_a_partial_write_that_cannot_be_truncated() {
    let mut disk = Disk::new();
    put(&mut disk.tail(), &entry(1)).unwrap();
    disk.write_fault = Some((30, ErrorKind::StorageFull));
    disk.truncate_fault = true;
    let mut tail = disk.tail();
    assert!(matches!(put(&mut tail, &entry(2)), Err(SyncError::Unknown(_))));
    assert!(matches!(tail.sync(false), Err(SyncError::Poisoned)));
    let Scan { records, ending, position: Position { end, .. } } = disk.scan();
    assert_eq!(records, [entry(1)]);
    assert_eq!(ending, Ending::Torn { at: end, bytes: 30 });
}

#[test]
fn journal_syncs_found_records_before_returning_them() {
    let mut disk = Disk::new();
    put(&mut disk.tail(), &entry(1)).unwrap();
    let Position { end, .. } = disk.scan().position;
    disk.bytes.extend_from_slice(&[7; 50]);
    let position = disk.scan().position;
    disk.sync_fault = true;
    Tail::resume(&mut disk, position, true).unwrap_err();

    disk.syncs = 0;
    let mut tail = Tail::resume(&mut disk, position, true).unwrap();
    put(&mut tail, &entry(2)).unwrap();
    assert_eq!(
        (position.end, disk.syncs),
        (end, 2),
        "once for what was found, once for the record"
    );
    assert_eq!(disk.records(), [entry(1), entry(2)]);
}

#[test]
fn reserve_is_kept_for_vital_records() {
    let mut disk = Disk::new();
    let is_full = Rc::clone(&disk.full);
    let mut tail = disk.tail();
    is_full.set(true);
    let mut count = 0;
    let full = loop {
        count += 1;
        tail.append_all(&[entry(count)]).unwrap();
        if let Err(error) = tail.sync(false) {
            break error;
        }
    };
    assert!(matches!(full, SyncError::Full(_)), "{full}");
    // The record that waits becomes durable with the vital one after it.
    tail.append_all(&[entry(count + 1)]).unwrap();
    tail.sync(true).unwrap();
    tail.append_all(&[entry(count + 2)]).unwrap();
    assert!(matches!(tail.sync(false), Err(SyncError::Full(_))));
    drop(tail);
    assert_eq!(disk.records(), (1..=count + 1).map(entry).collect::<Vec<_>>());
}

#[test]
fn records_of_one_pass_are_queued_as_a_whole_or_not_at_all() {
    let mut disk = Disk::new();
    let mut tail = disk.tail();
    let huge = Entry { text: "x".repeat(crate::BODY_BYTES_MAX), ..entry(2) };
    assert!(tail.append_all(&[entry(1), huge]).is_err());
    tail.append_all(&[entry(1)]).unwrap();
    tail.sync(false).unwrap();
    drop(tail);
    assert_eq!(disk.records(), [entry(1)]);
}
