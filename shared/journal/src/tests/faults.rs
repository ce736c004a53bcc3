//! A disk that fails: nothing half written stays, nothing unacknowledged is believed.

use std::io::{self, ErrorKind};

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
}

impl Disk {
    fn new() -> Self {
        Self { bytes: header::encode(&header(), 1).unwrap().0, ..Self::default() }
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
    tail.append(record).unwrap();
    tail.sync()
}

#[test]
fn journal_sync_writes_once() {
    let mut disk = Disk::new();
    let mut tail = disk.tail();
    (1..=9).for_each(|n| tail.append(&entry(n)).unwrap());
    tail.sync().unwrap();
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
        tail.append(&entry(3)).unwrap();
        tail.sync().unwrap();
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
    assert!(matches!(tail.sync(), Err(SyncError::Poisoned)));
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
    assert!(matches!(tail.sync(), Err(SyncError::Poisoned)));
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
