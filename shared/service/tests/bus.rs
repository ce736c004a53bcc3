//! Topics on real shared memory: schema checks, overflow, and history for late readers.

#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

use iceoryx2::prelude::ZeroCopySend;
use messages::schema::{Field, Schema};
use messages::topics::{self, Topic};
use messages::{AppliedMark, Epoch, Incarnation, PolicyView, Presented};
use service::bus::{Bus, BusError, Identity};
use service::group::{GroupName, GroupPaths};
use service::shm_cleanup;

/// A group's shared memory for one test; removed with it.
struct Shm {
    _home: tempfile::TempDir,
    paths: GroupPaths,
}

impl Shm {
    fn new() -> Self {
        let home = tempfile::Builder::new().prefix("wo").tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &GroupName::new("bus").unwrap()).unwrap();
        shm_cleanup::create_place(&paths).unwrap();
        Self { _home: home, paths }
    }

    fn join(&self, epoch: u64, incarnation: u32) -> Bus {
        let identity = Identity { epoch: Epoch(epoch), incarnation: Incarnation(incarnation) };
        Bus::open(&self.paths, "test", identity).unwrap()
    }
}

impl Drop for Shm {
    fn drop(&mut self) {
        shm_cleanup::remove_leftovers(&self.paths);
    }
}

/// As large as [`AppliedMark`] and of its name, but with another field.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, ZeroCopySend)]
#[type_name("AppliedMark")]
struct OtherMark {
    utterance: u64,
}

impl messages::WireField for OtherMark {}

impl Schema for OtherMark {
    const NAME: &'static str = "AppliedMark";

    fn fields() -> Vec<Field> {
        Vec::new()
    }

    fn size() -> usize {
        8
    }
}

#[test]
fn topic_rejects_a_struct_of_equal_size_with_other_fields() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let _writer = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
    let other = Topic { schema: OtherMark::key, ..topics::MARK };
    assert_eq!(OtherMark::size(), AppliedMark::size());
    let error = shm.join(1, 1).reader::<OtherMark>(&other).unwrap_err();
    let BusError::Schema { topic, ours, .. } = &error else { panic!("{error}") };
    assert_eq!((topic.as_str(), ours), (topics::MARK.name, &OtherMark::key().to_string()));
}

#[test]
fn late_reader_receives_the_newest_messages() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let writer = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
    for seq in 1..=5 {
        writer.send(&AppliedMark { seq }).unwrap();
    }
    let late = shm.join(1, 0);
    let reader = late.reader::<AppliedMark>(&topics::MARK).unwrap();
    writer.send(&AppliedMark { seq: 6 }).unwrap();
    assert_eq!(reader.latest().unwrap(), Some(AppliedMark { seq: 6 }));
    assert_eq!(reader.latest().unwrap(), None);
}

#[test]
fn another_epoch_is_not_heard() {
    let shm = Shm::new();
    let (old, new) = (shm.join(1, 1), shm.join(2, 1));
    let writer = old.writer::<AppliedMark>(&topics::MARK).unwrap();
    let reader = new.reader::<AppliedMark>(&topics::MARK).unwrap();
    writer.send(&AppliedMark { seq: 9 }).unwrap();
    assert_eq!(reader.latest().unwrap(), None);
}

#[test]
fn messages_of_an_earlier_incarnation_are_dropped() {
    let shm = Shm::new();
    // The topic admits one writer at a time, as in a group: the later takes the earlier's place.
    let reading = shm.join(1, 0);
    let reader = reading.reader::<Presented>(&topics::PRESENTED).unwrap();
    for (incarnation, prompt) in [(2, 7), (1, 3), (3, 8)] {
        let bus = shm.join(1, incarnation);
        let writer = bus.writer::<Presented>(&topics::PRESENTED).unwrap();
        writer.send(&Presented { prompt, ..Presented::default() }).unwrap();
        let heard = reader.latest().unwrap().map(|presented| presented.prompt);
        assert_eq!(heard, (incarnation != 1).then_some(prompt), "incarnation {incarnation}");
    }
}

#[test]
fn payloads_grow_as_they_need() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let writer = bus.encoded_writer::<PolicyView>(&topics::VIEW).unwrap();
    let reader = bus.encoded_reader::<PolicyView>(&topics::VIEW).unwrap();
    for objects in [2, 10_000] {
        let view = PolicyView { belief: vec![0.5; objects], ..PolicyView::default() };
        writer.send(&view).unwrap();
        assert_eq!(reader.latest().unwrap(), Some(view));
    }
}
