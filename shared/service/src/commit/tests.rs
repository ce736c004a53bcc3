use super::*;
use std::sync::{Arc, Mutex};

/// A journal in memory whose disk fails on request.
#[derive(Clone, Default)]
struct Disk(Arc<Mutex<State>>);

#[derive(Default)]
struct State {
    waiting: Vec<Vec<u32>>,
    /// One entry a sync: the passes that it made durable.
    synced: Vec<Vec<Vec<u32>>>,
    is_full: bool,
    /// Syncs with the reserve that succeed on a full disk.
    reserve: u32,
    is_broken: bool,
    attempts: u32,
    snapshots: Vec<Vec<u32>>,
    erasures: u32,
    bytes: u64,
}

impl Disk {
    fn set(&self, change: impl FnOnce(&mut State)) {
        change(&mut self.0.lock().unwrap());
    }

    fn get<T>(&self, read: impl FnOnce(&State) -> T) -> T {
        read(&self.0.lock().unwrap())
    }

    fn durable(&self) -> Vec<Vec<u32>> {
        self.get(|state| state.synced.concat())
    }
}

impl Store<u32> for Disk {
    fn append_all(&mut self, records: &[u32]) -> Result<(), AppendError> {
        let mut state = self.0.lock().unwrap();
        let count: usize = state.waiting.iter().map(Vec::len).sum();
        if count + records.len() > 100 {
            return Err(AppendError::TooLarge { bytes: count, max: 100 });
        }
        state.waiting.push(records.to_vec());
        Ok(())
    }

    fn sync(&mut self, vital: bool) -> Result<(), SyncError> {
        let mut state = self.0.lock().unwrap();
        state.attempts += 1;
        if state.is_broken {
            return Err(SyncError::Poisoned);
        }
        if state.is_full {
            if !vital || state.reserve == 0 {
                return Err(SyncError::Full(io::ErrorKind::StorageFull.into()));
            }
            state.reserve -= 1;
        }
        let waiting = std::mem::take(&mut state.waiting);
        state.synced.push(waiting);
        Ok(())
    }

    fn erase(&mut self, snapshot: &[u32]) -> Result<(), RotateError> {
        self.rotate(snapshot)?;
        self.0.lock().unwrap().erasures += 1;
        Ok(())
    }

    fn rotate(&mut self, snapshot: &[u32]) -> Result<(), RotateError> {
        let mut state = self.0.lock().unwrap();
        state.attempts += 1;
        if state.is_full {
            let source = io::ErrorKind::StorageFull.into();
            return Err(RotateError::Io { doing: "write", source });
        }
        state.snapshots.push(snapshot.to_vec());
        state.bytes = 10;
        Ok(())
    }

    fn bytes(&self) -> u64 {
        self.get(|state| state.bytes)
    }

    fn next_seq(&self) -> u64 {
        1
    }
}

type Outputs = Vec<&'static str>;

fn start(disk: &Disk) -> Commit<&'static str, u32> {
    Commit::start(Some(disk.clone()), Path::new("/nowhere/fixture.journal")).unwrap()
}

fn pass(
    commit: &mut Commit<&'static str, u32>,
    records: &[u32],
    outputs: &[&'static str],
) -> Outputs {
    let mut effects = Effects::default();
    records.iter().for_each(|record| effects.append(*record));
    outputs.iter().for_each(|output| effects.publish(*output));
    commit.state(&mut effects).unwrap()
}

/// Collects visible outputs until `holds`.
fn until(
    commit: &mut Commit<&'static str, u32>,
    mut holds: impl FnMut(&Commit<&'static str, u32>) -> bool,
) -> Outputs {
    let mut seen = Vec::new();
    while !holds(commit) {
        seen.extend(commit.settle().unwrap());
        std::thread::yield_now();
    }
    seen
}

#[test]
fn outputs_follow_their_records_and_keep_their_order() {
    let disk = Disk::default();
    let mut commit = start(&disk);
    assert_eq!(pass(&mut commit, &[], &["before"]), ["before"], "nothing to wait for");
    disk.set(|state| state.is_full = true);
    assert!(pass(&mut commit, &[1, 2], &["one", "two"]).is_empty());
    assert!(pass(&mut commit, &[], &["three"]).is_empty(), "it may tell of an earlier record");
    assert!(pass(&mut commit, &[3], &["four"]).is_empty());
    assert!(until(&mut commit, Commit::is_short).is_empty());
    disk.set(|state| state.is_full = false);
    assert_eq!(until(&mut commit, Commit::is_settled), ["one", "two", "three", "four"]);
    assert_eq!((disk.durable(), commit.is_short()), (vec![vec![1, 2], vec![3]], false));
}

#[test]
fn full_disk_is_tried_again_until_there_is_space() {
    let disk = Disk::default();
    disk.set(|state| state.is_full = true);
    let mut commit = start(&disk);
    pass(&mut commit, &[1], &["one"]);
    until(&mut commit, Commit::is_short);
    let tried = disk.get(|state| state.attempts);
    until(&mut commit, |_| disk.get(|state| state.attempts) > tried + 1);
    assert!(disk.durable().is_empty() && !commit.is_settled());
    disk.set(|state| state.is_full = false);
    assert_eq!(until(&mut commit, Commit::is_settled), ["one"]);
}

#[test]
fn vital_record_takes_what_waits_before_it_into_the_reserve() {
    let disk = Disk::default();
    disk.set(|state| (state.is_full, state.reserve) = (true, 1));
    let mut commit = start(&disk);
    pass(&mut commit, &[1], &["one"]);
    until(&mut commit, Commit::is_short);
    let mut effects = Effects::default();
    effects.append_vital(2);
    commit.state(&mut effects).unwrap();
    assert_eq!(until(&mut commit, Commit::is_settled), ["one"]);
    assert_eq!(disk.durable(), [vec![1], vec![2]]);
    pass(&mut commit, &[3], &["three"]);
    until(&mut commit, Commit::is_short);
    assert_eq!(disk.durable(), [vec![1], vec![2]], "an ordinary record leaves the reserve alone");
}

#[test]
fn what_waits_is_bounded_and_larger_than_one_sync() {
    let disk = Disk::default();
    disk.set(|state| state.is_full = true);
    let mut commit = start(&disk);
    let mut count = 0;
    while !commit.is_behind() {
        pass(&mut commit, &[count, count], &["seen"]);
        count += 1;
    }
    assert_eq!(count as usize, WAITING_MAX);
    disk.set(|state| state.is_full = false);
    assert_eq!(until(&mut commit, Commit::is_settled).len(), WAITING_MAX);
    assert_eq!(disk.durable(), (0..count).map(|n| vec![n, n]).collect::<Vec<_>>());
    assert!(!commit.is_behind());
}

#[test]
fn journal_that_fails_ends_the_service_as_storage() {
    let disk = Disk::default();
    disk.set(|state| state.is_broken = true);
    let mut commit = start(&disk);
    pass(&mut commit, &[1], &["one"]);
    let failure = loop {
        match commit.settle() {
            Ok(outputs) => assert!(outputs.is_empty()),
            Err(failure) => break failure,
        }
    };
    assert_eq!(failure.exit, Exit::Storage);
}

#[test]
fn long_journal_is_rotated_when_all_is_durable_and_a_failure_is_tried_again_later() {
    let disk = Disk::default();
    disk.set(|state| state.bytes = ROTATE_BYTES);
    let mut commit = start(&disk);
    assert!(commit.wants_snapshot());
    pass(&mut commit, &[1], &[]);
    assert!(!commit.wants_snapshot(), "a record is not durable yet");
    until(&mut commit, Commit::is_settled);
    disk.set(|state| (state.is_full, state.attempts) = (true, 0));
    commit.rotate(vec![7]).unwrap();
    until(&mut commit, |_| disk.get(|state| state.attempts) > 0);
    assert!(!commit.wants_snapshot());
    disk.set(|state| (state.is_full, state.bytes) = (false, ROTATE_BYTES + ROTATE_AGAIN_BYTES));
    pass(&mut commit, &[2], &[]);
    until(&mut commit, Commit::is_settled);
    assert!(commit.wants_snapshot());
    commit.rotate(vec![8]).unwrap();
    until(&mut commit, |commit| commit.bytes == 10);
    assert_eq!(disk.get(|state| state.snapshots.clone()).last(), Some(&vec![8]));
    assert!(!commit.wants_snapshot());
}

#[test]
fn journal_is_erased_at_once_and_again_after_a_failure() {
    let disk = Disk::default();
    let mut commit = start(&disk);
    commit.erase();
    pass(&mut commit, &[1], &[]);
    until(&mut commit, Commit::is_settled);
    assert!(commit.wants_snapshot(), "a short journal, too");
    disk.set(|state| (state.is_full, state.attempts) = (true, 0));
    commit.rotate(vec![7]).unwrap();
    until(&mut commit, |_| disk.get(|state| state.attempts) > 0);
    disk.set(|state| (state.is_full, state.bytes) = (false, ROTATE_AGAIN_BYTES));
    pass(&mut commit, &[2], &[]);
    until(&mut commit, Commit::is_settled);
    assert!(commit.wants_snapshot(), "later");
    commit.rotate(vec![8]).unwrap();
    until(&mut commit, |commit| !commit.erases);
    assert_eq!(disk.get(|state| state.erasures), 1);
    pass(&mut commit, &[3], &[]);
    until(&mut commit, Commit::is_settled);
    assert!(!commit.wants_snapshot());
}

#[test]
fn stateless_service_publishes_at_once() {
    let mut commit =
        Commit::<&str, u32>::start(None::<Disk>, Path::new("/nowhere/fixture.journal")).unwrap();
    assert_eq!(pass(&mut commit, &[], &["seen"]), ["seen"]);
    assert!(commit.is_settled() && !commit.is_behind() && !commit.wants_snapshot());
}
