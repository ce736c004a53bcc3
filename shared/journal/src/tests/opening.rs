//! Whose journal it is, who may write it, and that it comes back as it was.

use super::{Place, Said, header, said};
use crate::{
    AppendError, BODY_BYTES_MAX, Ending, FORMAT, Header, Journal, JournalOpenError, lock_holder,
    read, read_header,
};

#[test]
fn a_new_or_empty_file_is_a_fresh_start() {
    let place = Place::new();
    assert_eq!(place.recover().records, []);
    place.overwrite(b"");
    let recovered = place.recover();
    assert_eq!((recovered.records, recovered.first_seq, recovered.truncated_bytes), (vec![], 1, 0));
    assert_eq!(read_header(&place.path).unwrap(), header());
    assert_eq!(place.names(), ["policy.journal", "policy.journal.lock"]);
}

#[test]
fn records_come_back_in_order_over_several_openings() {
    let place = Place::new();
    place.write(&[&[said(1), said(2)], &[said(3)]]);
    let (mut journal, recovered) = place.open();
    assert_eq!(recovered.records, [said(1), said(2), said(3)]);
    assert_eq!(journal.next_seq(), 4);
    journal.append(&said(4)).unwrap();
    journal.sync().unwrap();
    drop(journal);
    assert_eq!(place.recover().records, [said(1), said(2), said(3), said(4)]);
}

#[test]
fn only_synced_records_are_there() {
    let place = Place::new();
    let (mut journal, _) = place.open();
    journal.append(&said(1)).unwrap();
    assert_eq!((journal.waiting(), journal.next_seq()), (1, 1));
    drop(journal);
    assert_eq!(place.recover().records, []);
}

#[test]
fn a_sync_without_records_writes_nothing() {
    let place = Place::new();
    let (mut journal, _) = place.open();
    let before = place.bytes();
    journal.sync().unwrap();
    assert_eq!(place.bytes(), before);
}

#[test]
fn a_batch_above_the_bound_is_refused_and_the_rest_kept() {
    let place = Place::new();
    let (mut journal, _) = place.open();
    journal.append(&said(1)).unwrap();
    let huge = Said { text: "x".repeat(BODY_BYTES_MAX), ..said(2) };
    assert!(matches!(journal.append(&huge), Err(AppendError::TooLarge { .. })));
    journal.sync().unwrap();
    drop(journal);
    assert_eq!(place.recover().records, [said(1)]);
}

#[test]
fn a_second_writer_is_told_who_the_first_is() {
    let place = Place::new();
    let pid = Some(std::process::id());
    assert_eq!(lock_holder(&place.path).unwrap(), None);
    let (journal, _) = place.open();
    let second = Journal::<Said>::open(&place.path, &header());
    assert!(matches!(second, Err(JournalOpenError::Locked { pid: found }) if found == pid));
    assert_eq!(lock_holder(&place.path).unwrap().unwrap().pid, pid);
    drop(journal);
    assert_eq!(lock_holder(&place.path).unwrap(), None);
    place.recover();
}

#[test]
fn reading_needs_no_lock_and_changes_nothing() {
    let place = Place::new();
    let (mut journal, _) = place.open();
    journal.append(&said(1)).unwrap();
    journal.sync().unwrap();
    let before = place.bytes();
    let reading = read::<Said>(&place.path).unwrap();
    assert_eq!((reading.header, reading.records), (header(), vec![said(1)]));
    assert_eq!((reading.first_seq, reading.ending), (1, Ending::Whole));
    assert_eq!(place.bytes(), before);
}

/// Opens a journal of `found` as `header()` and returns the refusal; the file must stay as it was.
fn refusal(found: &Header) -> JournalOpenError {
    let place = Place::new();
    drop(Journal::<Said>::open(&place.path, found).unwrap());
    let before = place.bytes();
    let error = Journal::<Said>::open(&place.path, &header()).unwrap_err();
    assert_eq!(place.bytes(), before);
    error
}

#[test]
fn the_journal_of_somebody_else_is_refused() {
    let group = Header { group: "lab".into(), ..header() };
    let message = refusal(&group).to_string();
    assert!(message.contains("`lab`") && message.contains("`kitchen`"), "{message}");
    assert!(matches!(refusal(&group), JournalOpenError::Group { .. }));

    let epoch = refusal(&Header { epoch: 2, ..header() });
    assert!(matches!(epoch, JournalOpenError::Epoch { found: 2, expected: 3 }), "{epoch}");
    let scene = refusal(&Header { scene: 8, ..header() });
    assert!(matches!(scene, JournalOpenError::Scene { found: 8, expected: 7 }), "{scene}");
    let schema = refusal(&Header { schema: 1, ..header() });
    assert!(matches!(schema, JournalOpenError::Record { found_schema: 1, .. }), "{schema}");
    let record = refusal(&Header { record: "heard".into(), ..header() });
    assert!(matches!(record, JournalOpenError::Record { .. }), "{record}");
}

#[test]
fn another_format_is_refused_by_its_number() {
    let place = Place::new();
    place.write(&[&[said(1)]]);
    let mut bytes = place.bytes();
    bytes[8..12].copy_from_slice(&(FORMAT + 1).to_le_bytes());
    place.overwrite(&bytes);
    let error = Journal::<Said>::open(&place.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::Format { found, .. } if found == FORMAT + 1));
    assert_eq!(place.bytes(), bytes);
}

#[test]
fn a_file_that_is_no_journal_is_left_alone() {
    let place = Place::new();
    place.overwrite(b"dear diary");
    let error = Journal::<Said>::open(&place.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::NotAJournal));
    assert_eq!(place.bytes(), b"dear diary");
}

#[test]
fn whole_frames_of_another_layout_are_not_taken_for_damage() {
    let place = Place::new();
    place.write(&[&[said(1)]]);
    let error = Journal::<(u8, String, bool)>::open(&place.path, &header()).unwrap_err();
    assert!(matches!(error, JournalOpenError::Undecodable { seq: 1, .. }), "{error}");
}
