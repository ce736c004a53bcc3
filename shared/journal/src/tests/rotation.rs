//! A rotation stopped before each of its steps, and the files kept.

use std::io;

use super::{Entry, TestJournal, entry};
use crate::rotate::Step;
use crate::{Journal, KEPT, RotateError, SyncError, read};

#[test]
fn journal_rotation_starts_with_the_snapshot_and_continues_numbering() {
    let test = TestJournal::new();
    test.write(&[&[entry(1), entry(2)], &[entry(3)]]);
    let (mut journal, _) = test.open();
    journal.append(&entry(4)).unwrap();
    journal.rotate(&[entry(40), entry(41)]).unwrap();
    assert_eq!(journal.next_seq(), 7);
    journal.append(&entry(5)).unwrap();
    journal.sync().unwrap();
    drop(journal);
    let recovered = test.recover();
    assert_eq!(recovered.records, [entry(40), entry(41), entry(5)]);
    assert_eq!(recovered.first_seq, 5);
    let old = read::<Entry>(&test.old(1)).unwrap();
    assert_eq!(old.records, [entry(1), entry(2), entry(3), entry(4)]);
}

#[test]
fn journal_rotation_keeps_the_latest_old_journals() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    let rotations = KEPT + 3;
    for n in 1..=rotations {
        journal.rotate(&[entry(n)]).unwrap();
    }
    assert_eq!(test.names().len(), KEPT as usize + 2, "{:?}", test.names());
    for n in 1..=KEPT {
        let old = read::<Entry>(&test.old(n)).unwrap();
        assert_eq!(old.records, [entry(rotations - n)]);
    }
}

#[test]
fn journal_that_is_erased_holds_the_snapshot_alone() {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    (1..=KEPT + 1).for_each(|n| journal.rotate(&[entry(n)]).unwrap());
    journal.erase(&[entry(9)]).unwrap();
    journal.append(&entry(10)).unwrap();
    journal.sync().unwrap();
    drop(journal);
    assert_eq!(test.recover().records, [entry(9), entry(10)]);
    let old = (1..=KEPT).filter(|n| test.old(*n).exists());
    assert_eq!(old.count(), 0, "{:?}", test.names());
}

/// A journal with one old one, and a rotation to `entry(9)` that stops before `step`.
fn stopped_before(step: Step) -> (TestJournal, Journal<Entry>, RotateError) {
    let test = TestJournal::new();
    let (mut journal, _) = test.open();
    journal.rotate(&[entry(1)]).unwrap();
    let before = |now| if now == step { Err(io::Error::other("stopped")) } else { Ok(()) };
    let error = journal.rotate_until(&[entry(9)], before).unwrap_err();
    (test, journal, error)
}

#[test]
fn journal_rotation_crash_leaves_the_old_or_the_new_journal() {
    for step in Step::ALL {
        let (test, journal, _) = stopped_before(step);
        drop(journal);
        let expected = if step == Step::SyncFolder { entry(9) } else { entry(1) };
        assert_eq!(test.recover().records, [expected], "before {step:?}");
        assert!(!test.names().contains(&"policy.journal.new".into()), "before {step:?}");

        let (mut journal, _) = test.open();
        journal.rotate(&[entry(10)]).unwrap();
        drop(journal);
        assert_eq!(test.recover().records, [entry(10)], "after a crash before {step:?}");
        let kept = [1, 2, 3].map(|n| read::<Entry>(&test.old(n)).map(|r| r.records).ok());
        let twice = kept.iter().flatten().filter(|r| **r == kept[0].clone().unwrap()).count();
        assert_eq!(twice, 1, "no old journal is kept twice, before {step:?}: {kept:?}");
    }
}

#[test]
fn journal_rotation_failure_before_the_replacement_keeps_the_old_journal() {
    for step in [Step::WriteNew, Step::ShiftOld, Step::LinkOld, Step::Replace] {
        let (test, mut journal, error) = stopped_before(step);
        assert!(matches!(error, RotateError::Io { .. }), "{error}");
        journal.append(&entry(2)).unwrap();
        journal.sync().unwrap();
        drop(journal);
        assert_eq!(test.recover().records, [entry(1), entry(2)], "before {step:?}");
    }
}

#[test]
fn journal_rotation_without_a_synced_folder_poisons() {
    let (_place, mut journal, error) = stopped_before(Step::SyncFolder);
    assert!(matches!(error, RotateError::Sync(SyncError::Unknown(_))), "{error}");
    journal.append(&entry(2)).unwrap();
    assert!(matches!(journal.sync(), Err(SyncError::Poisoned)));
    assert!(matches!(journal.rotate(&[]), Err(RotateError::Sync(SyncError::Poisoned))));
}

#[test]
fn journal_open_removes_a_partial_new_file() {
    let test = TestJournal::new();
    test.write(&[&[entry(1)]]);
    std::fs::write(test.folder.path().join("policy.journal.new"), b"WHICHJ").unwrap();
    assert_eq!(test.recover().records, [entry(1)]);
    assert_eq!(test.names(), ["policy.journal", "policy.journal.lock"]);
}
