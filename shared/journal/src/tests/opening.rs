//! Ownership, locking and recovery of a journal.

use std::path::Path;

use super::{Entry, TestJournal, entry, header};
use crate::{
    AppendError, BODY_BYTES_MAX, Ending, Header, Journal, JournalOpenError, inspect, read,
};

const SERVICES: [&str; 3] = ["speech", "policy", "arm"];

#[test]
fn journal_is_made_where_there_is_no_file() {
    let test = TestJournal::new();
    let recovered = test.recover();
    assert_eq!((recovered.records, recovered.first_seq, recovered.truncated_bytes), (vec![], 1, 0));
    assert_eq!(read::<Entry>(&test.path).unwrap().header, header());
    assert_eq!(inspect(&test.path).unwrap().header, header());
    assert_eq!(test.names(), ["policy.journal", "policy.journal.lock"]);
}

#[test]
fn journal_that_is_missing_or_empty_is_rejected() {
    let test = TestJournal::new();
    let open = || Journal::<Entry>::open(&test.path, &header()).map(drop);
    assert!(matches!(open(), Err(JournalOpenError::Missing)));
    assert!(matches!(read::<Entry>(&test.path), Err(JournalOpenError::Missing)));
    test.overwrite(b"");
    let make = || Journal::<Entry>::open_or_create(&test.path, &header()).map(drop);
    for opened in [open(), make(), inspect(&test.path).map(drop)] {
        assert!(matches!(opened, Err(JournalOpenError::Empty)), "{opened:?}");
        assert!(opened.unwrap_err().is_lost());
    }
    assert_eq!(test.bytes(), b"");
}

#[test]
fn journal_of_another_generation_is_rejected_and_left_unchanged() {
    let test = TestJournal::new();
    test.write(&[&[entry(1)]]);
    let before = test.bytes();
    let next = Header { generation: 2, ..header() };
    let error = Journal::<Entry>::open_or_create(&test.path, &next).unwrap_err();
    assert!(matches!(error, JournalOpenError::Generation { expected: 2, found: 1 }), "{error}");
    assert_eq!(test.bytes(), before);
}

#[test]
fn journal_returns_records_in_order_over_several_openings() {
    let test = TestJournal::new();
    test.write(&[&[entry(1), entry(2)], &[entry(3)]]);
    let (mut journal, recovered) = test.open();
    assert_eq!(recovered.records, [entry(1), entry(2), entry(3)]);
    assert_eq!(journal.next_seq(), 4);
    journal.append(&entry(4)).unwrap();
    journal.sync().unwrap();
    drop(journal);
    assert_eq!(test.recover().records, [entry(1), entry(2), entry(3), entry(4)]);
}

#[test]
fn journal_returns_synced_records_only() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    journal.append(&entry(1)).unwrap();
    assert_eq!(journal.next_seq(), 1);
    drop(journal);
    assert_eq!(test.recover().records, []);
}

#[test]
fn journal_sync_without_records_writes_nothing() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    let before = test.bytes();
    journal.sync().unwrap();
    assert_eq!(test.bytes(), before);
}

#[test]
fn journal_rejects_a_batch_above_the_bound_and_keeps_the_rest() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    journal.append(&entry(1)).unwrap();
    let huge = Entry { text: "x".repeat(BODY_BYTES_MAX), ..entry(2) };
    assert!(matches!(journal.append(&huge), Err(AppendError::TooLarge { .. })));
    journal.sync().unwrap();
    drop(journal);
    assert_eq!(test.recover().records, [entry(1)]);
}

#[test]
fn journal_rejects_a_second_writer_with_the_pid_of_the_first() {
    let test = TestJournal::new();
    let pid = Some(std::process::id());
    let (journal, _) = test.open();
    let second = Journal::<Entry>::open(&test.path, &header());
    assert!(matches!(second, Err(JournalOpenError::Locked { pid: found }) if found == pid));
    drop(journal);
    test.recover();
}

#[test]
fn journal_reading_needs_no_lock_and_changes_nothing() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    journal.append(&entry(1)).unwrap();
    journal.sync().unwrap();
    let before = test.bytes();
    let reading = read::<Entry>(&test.path).unwrap();
    assert_eq!((reading.header, reading.records), (header(), vec![entry(1)]));
    assert_eq!((reading.first_seq, reading.ending), (1, Ending::Whole));
    assert_eq!(test.bytes(), before);
}

#[test]
fn journal_of_another_owner_or_kind_is_rejected_and_left_unchanged() {
    let kept = "`whichone up --fresh`, which keeps the old file";
    let cases = [
        (
            Header { group: "lab".into(), ..header() },
            ["group `kitchen`, found one of group `lab`"; 2],
        ),
        (Header { epoch: 2, ..header() }, ["epoch 3, found a journal of epoch 2", kept]),
        (Header { record: "entry/1".into(), ..header() }, ["`entry/2`, found `entry/1`", kept]),
    ];
    for (found, parts) in cases {
        let test = TestJournal::new();
        drop(Journal::<Entry>::open_or_create(&test.path, &found).unwrap());
        let before = test.bytes();
        let error = Journal::<Entry>::open(&test.path, &header()).unwrap_err();
        let message = error.to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        assert!(matches!(error, JournalOpenError::Foreign(_)));
        assert_eq!(test.bytes(), before);
    }
}

#[test]
fn journals_of_former_formats_are_rejected_with_a_way_out_and_left_unchanged() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures/journals");
    for (format, service) in [1, 2].into_iter().flat_map(|format| SERVICES.map(|s| (format, s))) {
        let old = fixtures.join(format!("format_{format}")).join(format!("{service}.journal"));
        let bytes = std::fs::read(old).unwrap();
        let test = TestJournal::new();
        test.overwrite(&bytes);
        let error = Journal::<Entry>::open(&test.path, &header()).unwrap_err();
        assert!(matches!(error, JournalOpenError::Foreign(_)), "{error}");
        let message = error.to_string();
        assert!(message.contains(&format!("format 3, found {format}")), "{message}");
        assert!(message.contains("`whichone up --fresh`, which keeps the old file"), "{message}");
        assert_eq!(test.bytes(), bytes);
    }
}

#[test]
fn journal_open_leaves_other_files_unchanged() {
    let test = TestJournal::new();
    test.overwrite(b"dear diary");
    let error = Journal::<Entry>::open(&test.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::NotAJournal));
    assert_eq!(test.bytes(), b"dear diary");
}

#[test]
fn journal_distinguishes_another_record_layout_from_damage() {
    let test = TestJournal::new();
    test.write(&[&[entry(1)]]);
    let error = Journal::<(u8, String, bool)>::open(&test.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::Undecodable { seq: 1, .. }), "{error}");
}
