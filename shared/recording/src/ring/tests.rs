use std::cell::Cell;
use std::rc::Rc;
use std::time::Duration;

use mcap::records::Record;

use super::*;
use crate::channels::{ChannelId, Picture};
use crate::list::{State, incomplete};
use crate::records::each_record;
use crate::recover::recover_all;

const MIB: u64 = 1 << 20;
const HOUR: u64 = 3600;

fn limits() -> Recorder {
    Recorder {
        bytes_max: 8 * MIB,
        age_max: Duration::from_secs(24 * HOUR),
        file_max: Duration::from_secs(600),
        free_min: 100 * MIB,
        sound: false,
    }
}

fn at(s: u64) -> Time {
    Time(s * 1_000_000_000)
}

/// The wall clock is two days ahead of the monotonic one.
fn clock() -> WallClock {
    WallClock { offset_ns: 2 * 86_400 * 1_000_000_000 }
}

/// Makes a ring with the free space of the cell.
fn ring(folder: &Path, limits: Recorder) -> (Ring, Rc<Cell<u64>>) {
    let free = Rc::new(Cell::new(1000 * MIB));
    let asked = Rc::clone(&free);
    let attached = Attached {
        files: vec![("settings.toml".to_owned(), "application/toml", "x".repeat(10_000))],
        ..Attached::default()
    };
    (Ring::new(folder.to_owned(), limits, attached, Box::new(move |_| Ok(asked.get()))), free)
}

fn write(ring: &mut Ring, sequence: u64) {
    let (id, now) = (ChannelId::from(Picture::Log), at(sequence));
    // Noise, so that it does not compress.
    let mut state = sequence.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let data: Vec<u8> = std::iter::repeat_with(|| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state as u8
    })
    .take(300)
    .collect();
    let at_ns = clock().wall_ns(now);
    ring.write(Sample { channel: id, sequence: sequence as u32, at_ns, data: &data }, now);
}

/// Sequence numbers in the files of a folder, oldest file first.
fn sequences(folder: &Path) -> Vec<Vec<u32>> {
    let read = |entry: Entry| {
        let mut found = Vec::new();
        each_record(&entry.path, |record| {
            if let Record::Message { header, .. } = record {
                found.push(header.sequence);
            }
            Ok(())
        })
        .unwrap();
        found
    };
    entries(folder).into_iter().map(read).collect()
}

#[test]
fn a_week_stays_in_bounds_and_has_no_gap_at_a_change_of_file() {
    let folder = tempfile::tempdir().unwrap();
    let (mut ring, _) = ring(folder.path(), limits());
    let (week, step) = (7 * 24 * HOUR, 10_u64);
    let mut most = 0;
    for s in (0..week).step_by(step as usize) {
        ring.tend(at(s), clock());
        write(&mut ring, s);
        if s % 500 == 0 {
            most = most.max(entries(folder.path()).iter().map(|entry| entry.bytes).sum());
        }
    }
    ring.finish(at(week));
    assert!(ring.paused().is_none());
    assert!((4 * MIB..=8 * MIB).contains(&most), "{most} bytes at most");
    let files = sequences(folder.path());
    let all: Vec<u32> = files.iter().flatten().copied().collect();
    let kept = all.len() as u64;
    // A day of files of ten minutes, each message once and none missing.
    assert!((24 * HOUR / step..=25 * HOUR / step).contains(&kept), "{kept} messages");
    assert!((144..=150).contains(&files.len()), "{} files", files.len());
    let expected: Vec<u32> = (0..week).step_by(step as usize).map(|s| s as u32).collect();
    assert_eq!(all, expected[expected.len() - all.len()..]);
    assert!(files.iter().skip(1).all(|file| file.len() as u64 == 600 / step));
}

#[test]
fn files_of_others_are_neither_deleted_nor_completed() {
    let folder = tempfile::tempdir().unwrap();
    let others = ["day.mcap", "tuesday.mcap.part"].map(|name| folder.path().join(name));
    others.iter().for_each(|file| fs::write(file, "mine").unwrap());
    let (mut ring, _) = ring(folder.path(), limits());
    for s in (0..48 * HOUR).step_by(600) {
        ring.tend(at(s), clock());
        write(&mut ring, s);
    }
    ring.finish(at(48 * HOUR));
    recover_all(&incomplete(folder.path()));
    others.iter().for_each(|file| assert_eq!(fs::read(file).unwrap(), b"mine"));
}

#[test]
fn size_bounds_the_ring_where_age_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let (mut ring, _) = ring(folder.path(), Recorder { age_max: Duration::MAX, ..limits() });
    for s in 0..60_000 {
        ring.tend(at(s), clock());
        write(&mut ring, s);
        if s % 100 == 0 {
            let bytes: u64 = entries(folder.path()).iter().map(|entry| entry.bytes).sum();
            assert!(bytes <= 8 * MIB, "{bytes} after {s} s");
        }
    }
    ring.finish(at(60_000));
    let all: Vec<u32> = sequences(folder.path()).concat();
    assert!(all.len() > 10_000 && all.windows(2).all(|pair| pair[1] == pair[0] + 1));
    assert_eq!(all.last(), Some(&59_999));
}

#[test]
fn nearly_full_disk_pauses_the_recording_until_there_is_space() {
    let folder = tempfile::tempdir().unwrap();
    let (mut ring, free) = ring(folder.path(), limits());
    assert!(ring.tend(at(0), clock()));
    write(&mut ring, 0);
    free.set(99 * MIB);
    assert!(!ring.tend(at(1), clock()));
    assert!(ring.current().is_none(), "the file is complete");
    let why = ring.paused().unwrap();
    assert!(why.contains("99 MiB free") && why.contains("free_min_mib is 100"), "{why}");
    write(&mut ring, 1);
    // A little more than the minimum would make it pause again at once.
    free.set(110 * MIB);
    assert!(!ring.tend(at(2), clock()));
    free.set(200 * MIB);
    assert!(ring.tend(at(3), clock()) && ring.paused().is_none());
    write(&mut ring, 3);
    ring.finish(at(4));
    assert_eq!(sequences(folder.path()), [[0], [3]]);
}

#[test]
fn failure_to_write_is_tried_again_later() {
    let folder = tempfile::tempdir().unwrap();
    let gone = folder.path().join("gone");
    let (mut ring, _) = ring(&gone, limits());
    assert!(!ring.tend(at(0), clock()));
    let why = ring.paused().unwrap();
    assert!(why.contains("No such file") && why.contains("help: create the folder"), "{why}");
    fs::create_dir(&gone).unwrap();
    assert!(!ring.tend(at(1), clock()), "not at once");
    assert!(ring.tend(at(10), clock()) && ring.paused().is_none());
}

#[test]
fn failure_says_what_a_person_can_do_about_it() {
    let failed = |kind: ErrorKind| help(&RecordingError::Io("r".into(), kind.into()));
    assert!(failed(ErrorKind::PermissionDenied).contains("help: make the folder writable"));
    assert_eq!(failed(ErrorKind::StorageFull), "", "the status has help for a shortage");
}

#[test]
fn recordings_are_listed_with_what_is_known_of_them() {
    let folder = tempfile::tempdir().unwrap();
    let (mut ring, _) = ring(folder.path(), limits());
    for s in [0, 60, 600] {
        ring.tend(at(s), clock());
        write(&mut ring, s);
    }
    ring.tend(at(601), clock());
    let named = |name: &str, content: &[u8]| {
        fs::write(folder.path().join(name), content).unwrap();
    };
    let whole = fs::read(&entries(folder.path())[0].path).unwrap();
    named("2026-01-01T00-00-00.000Z.mcap", &[7; 5_000]);
    named("2026-01-02T00-00-00.000Z.mcap.part", &whole[..whole.len() / 2]);
    named("day.mcap", &whole);
    let found = |entry: &Entry| (entry.state(), entry.seconds().is_some());
    let all = entries(folder.path());
    assert_eq!(
        all.iter().map(found).collect::<Vec<_>>(),
        [
            (State::Foreign, false),
            (State::Complete, true),
            (State::BeingWritten, true),
            (State::Damaged, false),
            (State::Incomplete, true),
        ]
    );
    assert_eq!(all[1].seconds(), Some(60.0), "from the first message to the last one");
    drop(ring);
    assert_eq!(entries(folder.path())[2].state(), State::Incomplete);
}

#[test]
fn new_file_begins_when_the_wall_clock_is_set() {
    let folder = tempfile::tempdir().unwrap();
    let (mut ring, _) = ring(folder.path(), limits());
    assert!(ring.tend(at(0), clock()));
    assert!(!ring.tend(at(1), clock()));
    let set = WallClock { offset_ns: clock().offset_ns + 5_000_000_000 };
    assert!(ring.tend(at(2), set));
    assert_eq!(ring.clock(), Some(set));
    write(&mut ring, 2);
    drop(ring);
    recover_all(&incomplete(folder.path()));
    assert_eq!(entries(folder.path()).len(), 2);
}

/// Writes a message each minute for `minutes`, with the wall clock at `clock`. Returns the end.
fn record(ring: &mut Ring, from_s: u64, minutes: u64, clock: WallClock) -> u64 {
    for s in (from_s..from_s + minutes * 60).step_by(60) {
        ring.tend(at(s), clock);
        write(ring, s);
    }
    from_s + minutes * 60
}

#[test]
fn clock_that_is_set_deletes_nothing() {
    const MONTH_NS: u64 = 30 * 86_400 * 1_000_000_000;
    let folder = tempfile::tempdir().unwrap();
    let (mut ring, _) = ring(folder.path(), limits());
    // A computer without a battery: 1970, until the first answer from the network.
    let now = record(&mut ring, 0, 30, clock());
    let set = WallClock { offset_ns: 20 * MONTH_NS };
    let now = record(&mut ring, now, 30, set);
    // A month ahead, and back.
    let now = record(&mut ring, now, 30, WallClock { offset_ns: 21 * MONTH_NS });
    let now = record(&mut ring, now, 30, set);
    ring.finish(at(now));
    let mut all = sequences(folder.path()).concat();
    all.sort_unstable();
    assert_eq!(all, (0..now as u32).step_by(60).collect::<Vec<_>>());
}

#[test]
fn first_recorded_is_the_first_to_go_whatever_the_clock_said() {
    let folder = tempfile::tempdir().unwrap();
    let (mut ahead, _) = ring(folder.path(), limits());
    let wrong = WallClock { offset_ns: clock().offset_ns + 400 * 86_400 * 1_000_000_000 };
    let now = record(&mut ahead, 0, 20 * 60, wrong);
    ahead.finish(at(now));
    // The next start knows the order from the files.
    let (mut right, _) = ring(folder.path(), limits());
    let end = record(&mut right, now, 20 * 60, clock());
    right.finish(at(end));
    let mut all = sequences(folder.path()).concat();
    all.sort_unstable();
    assert!(all[0] > 0 && all[0] < now as u32, "a day is kept: {}", all[0]);
    assert_eq!(all, (all[0]..end as u32).step_by(60).collect::<Vec<_>>());
}
