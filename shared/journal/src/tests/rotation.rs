//! A rotation that is stopped before each of its steps, and what it keeps.

use std::io;

use super::{Place, Said, header, said};
use crate::rotate::Step;
use crate::{Journal, JournalOpenError, RotateError, SyncError, read, set_aside};

#[test]
fn a_rotated_journal_starts_with_its_snapshot_and_numbers_go_on() {
    let place = Place::new();
    place.write(&[&[said(1), said(2)], &[said(3)]]);
    let (mut journal, _) = place.open();
    journal.append(&said(4)).unwrap();
    journal.rotate(&[said(40), said(41)]).unwrap();
    assert_eq!(journal.next_seq(), 7);
    journal.append(&said(5)).unwrap();
    journal.sync().unwrap();
    drop(journal);
    let recovered = place.recover();
    assert_eq!(recovered.records, [said(40), said(41), said(5)]);
    assert_eq!(recovered.first_seq, 5);
    let old = read::<Said>(&place.old(1)).unwrap();
    assert_eq!(old.records, [said(1), said(2), said(3), said(4)]);
}

#[test]
fn the_last_n_are_kept() {
    let place = Place::new();
    let (journal, _) = place.open();
    let mut journal = journal.keeping(2);
    for n in 1..=5 {
        journal.rotate(&[said(n)]).unwrap();
    }
    let files = ["policy.journal", "policy.journal.1", "policy.journal.2", "policy.journal.lock"];
    assert_eq!(place.names(), files);
    assert_eq!(read::<Said>(&place.old(1)).unwrap().records, [said(4)]);
    assert_eq!(read::<Said>(&place.old(2)).unwrap().records, [said(3)]);
}

#[test]
fn without_archives_a_rotation_replaces() {
    let place = Place::new();
    let (journal, _) = place.open();
    journal.keeping(0).rotate(&[said(1)]).unwrap();
    assert_eq!(place.names(), ["policy.journal", "policy.journal.lock"]);
    assert_eq!(place.recover().records, [said(1)]);
}

/// A journal with one old one, and a rotation to `said(9)` that stops before `step`.
fn stopped_before(step: Step) -> (Place, Journal<Said>, RotateError) {
    let place = Place::new();
    let (mut journal, _) = place.open();
    journal.rotate(&[said(1)]).unwrap();
    let before = |now| if now == step { Err(io::Error::other("stopped")) } else { Ok(()) };
    let error = journal.rotate_until(&[said(9)], before).unwrap_err();
    (place, journal, error)
}

#[test]
fn a_crash_before_each_step_leaves_the_old_or_the_new() {
    for step in Step::ALL {
        let (place, journal, _) = stopped_before(step);
        drop(journal);
        let expected = if step == Step::SyncFolder { said(9) } else { said(1) };
        assert_eq!(place.recover().records, [expected], "before {step:?}");
        assert!(!place.names().contains(&"policy.journal.new".into()), "before {step:?}");

        let (mut journal, _) = place.open();
        journal.rotate(&[said(10)]).unwrap();
        drop(journal);
        assert_eq!(place.recover().records, [said(10)], "after a crash before {step:?}");
        let kept = [1, 2, 3].map(|n| read::<Said>(&place.old(n)).map(|r| r.records).ok());
        let twice = kept.iter().flatten().filter(|r| **r == kept[0].clone().unwrap()).count();
        assert_eq!(twice, 1, "no old journal is kept twice, before {step:?}: {kept:?}");
    }
}

#[test]
fn a_rotation_that_fails_before_the_replacement_lets_the_old_journal_go_on() {
    for step in [Step::WriteNew, Step::ShiftOld, Step::LinkOld, Step::Replace] {
        let (place, mut journal, error) = stopped_before(step);
        assert!(matches!(error, RotateError::Io { .. }), "{error}");
        journal.append(&said(2)).unwrap();
        journal.sync().unwrap();
        drop(journal);
        assert_eq!(place.recover().records, [said(1), said(2)], "before {step:?}");
    }
}

#[test]
fn a_rotation_whose_folder_was_not_synced_poisons() {
    let (_place, mut journal, error) = stopped_before(Step::SyncFolder);
    assert!(matches!(error, RotateError::Sync(SyncError::Unknown(_))), "{error}");
    journal.append(&said(2)).unwrap();
    assert!(matches!(journal.sync(), Err(SyncError::Poisoned)));
    assert!(matches!(journal.rotate(&[]), Err(RotateError::Sync(SyncError::Poisoned))));
}

#[test]
fn half_a_new_file_is_forgotten() {
    let place = Place::new();
    place.write(&[&[said(1)]]);
    std::fs::write(place.folder.path().join("policy.journal.new"), b"WHICHJ").unwrap();
    assert_eq!(place.recover().records, [said(1)]);
    assert_eq!(place.names(), ["policy.journal", "policy.journal.lock"]);
}

#[test]
fn a_journal_set_aside_is_kept_and_its_place_is_free() {
    let place = Place::new();
    place.write(&[&[said(1)]]);
    let (journal, _) = place.open();
    assert!(matches!(set_aside(&place.path, 4), Err(JournalOpenError::Locked { .. })));
    drop(journal);
    set_aside(&place.path, 4).unwrap();
    set_aside(&place.path, 4).unwrap();
    let other = crate::Header { epoch: 4, ..header() };
    let (_journal, recovered) = Journal::<Said>::open(&place.path, &other).unwrap();
    assert_eq!(recovered.records, []);
    let kept = read::<Said>(&place.old(1)).unwrap();
    assert_eq!(kept.records, [said(1)], "neither a second time nor opening anew moves it");
}
