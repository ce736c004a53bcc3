//! Topics on real shared memory: schema checks, overflow, history for late readers, and segments.

#![allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]

mod segments;

use iceoryx2::prelude::ZeroCopySend;
use messages::layout::Layout;
use messages::schema::{Field, Schema};
use messages::topics::{self, Topic};
use messages::{
    AppliedMark, Epoch, Incarnation, Injection, PolicyView, Presented, RequestKey, Service, Sound,
};
use runtime::bus::{AnyMessage, Bus, BusError, Identity, Joined, WakeListener};
use runtime::client::Client;
use runtime::group::{GroupName, GroupPaths};
use runtime::shm_cleanup;
use runtime::{Span, epoch};

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
#[derive(Clone, Copy, Debug, Default, PartialEq, ZeroCopySend)]
#[type_name("AppliedMark")]
struct OtherMark {
    utterance: u64,
}

// SAFETY: one number.
#[allow(unsafe_code)]
unsafe impl messages::WireMessage for OtherMark {}

impl messages::WireField for OtherMark {
    fn ros2() -> messages::definition::FieldType {
        messages::definition::FieldType::default()
    }
}

impl Schema for OtherMark {
    const NAME: &'static str = "AppliedMark";

    fn fields() -> Vec<Field> {
        Vec::new()
    }

    fn layout() -> Option<Layout> {
        Some(Layout::of::<Self>())
    }

    fn definition() -> messages::definition::Definition {
        messages::definition::Definition::Ros2Msg("uint64 utterance\n".to_owned())
    }
}

#[test]
fn topic_rejects_a_struct_of_equal_size_with_other_fields() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let _writer = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
    let other = Topic { schema: OtherMark::key, ..topics::MARK };
    assert_eq!(size_of::<OtherMark>(), size_of::<AppliedMark>());
    let error = shm.join(1, 1).reader::<OtherMark>(&other).unwrap_err();
    let BusError::Schema { topic, ours, .. } = &error else { panic!("{error}") };
    assert_eq!((topic.as_str(), ours), (topics::MARK.name, &OtherMark::key().to_string()));
}

#[test]
fn topic_is_not_opened_for_messages_of_another_type() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let expected = "expected messages AppliedMark, found Presented";
    let error = bus.writer::<Presented>(&topics::MARK).unwrap_err().to_string();
    assert!(error.contains(expected), "{error}");
    let error = bus.reader::<Presented>(&topics::MARK).unwrap_err().to_string();
    assert!(error.contains(expected), "{error}");
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

/// Returns whether a mapping of `/dev/shm` holds the address.
fn is_shared(address: usize) -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").unwrap();
    maps.lines().filter(|line| line.contains("/dev/shm/")).any(|line| {
        let (from, to) = line.split_whitespace().next().unwrap().split_once('-').unwrap();
        let number = |text| usize::from_str_radix(text, 16).unwrap();
        (number(from)..number(to)).contains(&address)
    })
}

#[test]
fn encoded_bytes_are_read_where_they_lie_and_invalid_ones_are_skipped() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let topic = Topic { buffer: 2, ..topics::VIEW };
    let writer = bus.encoded_writer::<PolicyView>(&topic).unwrap();
    let reader = bus.encoded_reader::<PolicyView>(&topic).unwrap();
    for text in ["first", "second"] {
        let view = PolicyView { text: text.to_owned(), ..PolicyView::default() };
        writer.send(&view).unwrap();
    }
    let decode = |bytes: &[u8]| {
        assert!(is_shared(bytes.as_ptr() as usize));
        let view: PolicyView = postcard::from_bytes(bytes)?;
        if view.text == "first" { Err(postcard::Error::DeserializeBadBool) } else { Ok(view.text) }
    };
    assert_eq!(reader.take_with(decode).unwrap().as_deref(), Some("second"));
    assert_eq!(reader.take_with(decode).unwrap(), None);
}

#[test]
fn submission_has_room_for_its_sound_whatever_its_size() {
    let shm = Shm::new();
    let speech = shm.join(1, 0);
    std::fs::write(shm.paths.epoch_file(), epoch::with_checksum(r#"{"epoch":1}"#)).unwrap();
    let reader = speech.encoded_reader::<Injection>(&topics::INJECTION).unwrap();
    for size in [0, 10, 100_000] {
        let sound = Sound::Text("a".repeat(size));
        let client = Client::join(&shm.paths).unwrap();
        let (writer, _receipts) = client.submission(&sound).unwrap();
        let (key, most) = (RequestKey([u8::MAX; 16]), u64::MAX);
        let from = "n".repeat(64);
        let injection =
            Injection { key, onset_ns: most, end_ns: most, seen_prompt: most, from, sound };
        writer.send(&injection).unwrap();
        assert_eq!(reader.latest().unwrap(), Some(injection));
    }
}

/// The first writer was read until it was empty, so one that kept sending was the only one heard.
#[test]
fn writers_are_read_in_turn_and_one_that_keeps_sending_does_not_hold_the_reader() {
    let shm = Shm::new();
    let [busy, other, speech] = [(); 3].map(|()| shm.join(1, 0));
    let reader = speech.encoded_reader::<Injection>(&topics::INJECTION).unwrap();
    let [busy, other] = [busy, other].map(|bus| {
        let writer = bus.encoded_writer::<Injection>(&topics::INJECTION).unwrap();
        move |text: &str| {
            let (key, sound) = (RequestKey::default(), Sound::Text(text.to_owned()));
            let from = String::new();
            let injection = Injection { key, onset_ns: 0, end_ns: 0, seen_prompt: 0, from, sound };
            // The bus is kept with its writer.
            let _ = &bus;
            writer.send(&injection).unwrap();
        }
    });
    (0..topics::WINDOW).for_each(|_| busy("busy"));
    other("other");
    let mut read = Vec::new();
    let keep_sending = |injection: Injection| {
        busy("busy");
        read.push(injection.sound == Sound::Text("other".to_owned()));
    };
    reader.drain_in_turn(keep_sending).unwrap();
    assert_eq!(read.len(), topics::WINDOW + 1, "what was there");
    assert!(read[0] || read[1], "the other one's turn comes first or second");
    let mut left = 0;
    reader.drain_in_turn(|_| left += 1).unwrap();
    assert!(left > 0, "what arrived meanwhile comes next");
}

/// A service whose pass took longer than the interval of some topic's messages never ended that
/// pass, and was killed for a missed heartbeat.
#[test]
fn writer_that_sends_as_fast_as_it_is_read_does_not_hold_the_reader() {
    let shm = Shm::new();
    let [policy, speech] = [(); 2].map(|()| shm.join(1, 1));
    let reader = speech.reader::<AppliedMark>(&topics::MARK).unwrap();
    let writer = policy.writer::<AppliedMark>(&topics::MARK).unwrap();
    writer.send(&AppliedMark { seq: 1 }).unwrap();
    let mut read = Vec::new();
    let drained = reader.drain(|mark| {
        assert!(read.len() < 1_000, "the reader is held");
        read.push(mark.seq);
        writer.send(&AppliedMark { seq: mark.seq + 1 }).unwrap();
    });
    assert_eq!((drained, read), (Ok(()), vec![1]));
    assert_eq!(reader.latest().unwrap(), Some(AppliedMark { seq: 2 }), "it comes next");
}

/// Returns whether a wake-up waits.
fn is_woken(listener: &WakeListener) -> bool {
    listener.sleep(&[], Span(0)).by_wake
}

#[test]
fn reader_that_joins_gets_the_latest_message_before_there_is_another() {
    let shm = Shm::new();
    let policy = shm.join(1, 1);
    let woken = policy.wake_listener(Service::Policy).unwrap();
    let writer = policy.writer::<AppliedMark>(&topics::MARK).unwrap();
    writer.send(&AppliedMark { seq: 7 }).unwrap();

    let client = shm.join(1, 0);
    let reader = client.reader::<AppliedMark>(&topics::MARK).unwrap();
    assert_eq!(reader.latest().unwrap(), None, "nobody has connected it yet");
    assert!(is_woken(&woken), "the writer is asked");
    let joined = woken.take().unwrap();
    assert_eq!(joined, Joined::Client);
    policy.connect(joined);
    assert_eq!(reader.latest().unwrap(), Some(AppliedMark { seq: 7 }));
    assert_eq!(woken.take(), None);
}

#[test]
fn service_that_joins_is_woken_when_it_is_connected() {
    let shm = Shm::new();
    let policy = shm.join(1, 1);
    let woken = policy.wake_listener(Service::Policy).unwrap();
    let writer = policy.writer::<AppliedMark>(&topics::MARK).unwrap();
    writer.send(&AppliedMark { seq: 7 }).unwrap();

    let identity = Identity { epoch: Epoch(1), incarnation: Incarnation(2) };
    let speech = Bus::open(&shm.paths, Service::Speech.name(), identity).unwrap();
    let listener = speech.wake_listener(Service::Speech).unwrap();
    let reader = speech.reader::<AppliedMark>(&topics::MARK).unwrap();
    assert!(!is_woken(&listener));
    policy.connect(woken.take().unwrap());
    assert!(is_woken(&listener));
    assert_eq!(reader.latest().unwrap(), Some(AppliedMark { seq: 7 }));
}

#[test]
fn any_reader_takes_every_topic_with_its_bytes_and_sequence_numbers() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let marks = bus.any_reader(&topics::MARK).unwrap();
    let writer = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
    // More than other readers of a state hold.
    let most = topics::MARK.buffer_max() as u64;
    assert!(most > topics::MARK.buffer as u64);
    (1..=most + 2).for_each(|seq| writer.send(&AppliedMark { seq }).unwrap());
    let mut taken = Vec::new();
    let mut take = |stamp: &messages::Stamp, message: AnyMessage<'_>| {
        let AnyMessage::Fixed(message) = message else { panic!("{message:?}") };
        let mark = message.get::<AppliedMark>().unwrap();
        assert_eq!(message.bytes(), mark.seq.to_le_bytes());
        taken.push((u64::from(stamp.sequence), mark.seq));
    };
    marks.drain(&mut take).unwrap();
    // The oldest gave way, and the gap shows it.
    assert_eq!(taken, (3..=most + 2).map(|n| (n, n)).collect::<Vec<_>>());

    let views = bus.any_reader(&topics::VIEW).unwrap();
    let writer = bus.encoded_writer::<PolicyView>(&topics::VIEW).unwrap();
    let view = PolicyView { text: "Is it white?".to_owned(), ..PolicyView::default() };
    writer.send(&view).unwrap();
    let mut taken = None;
    views
        .drain(&mut |stamp, message| {
            let AnyMessage::Encoded(bytes) = message else { panic!("{message:?}") };
            taken = Some((stamp.sequence, postcard::from_bytes::<PolicyView>(bytes).unwrap()));
        })
        .unwrap();
    assert_eq!(taken, Some((1, view)));
}

#[test]
fn repeated_state_wakes_its_readers_only_when_it_has_changed() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let listener = bus.wake_listener(Service::Speech).unwrap();
    let writer = bus.writer::<AppliedMark>(&topics::MARK).unwrap();
    for (seq, wakes) in [(1, true), (1, false), (2, true), (2, false), (1, true)] {
        writer.send(&AppliedMark { seq }).unwrap();
        assert_eq!(is_woken(&listener), wakes, "mark {seq}");
        if wakes {
            assert_eq!(listener.take(), None);
        }
    }
}

#[test]
fn every_message_wakes_its_reader_whoever_sends_and_however_often() {
    let shm = Shm::new();
    let bus = shm.join(1, 1);
    let listener = bus.wake_listener(Service::Speech).unwrap();
    let reader = bus.reader::<AppliedMark>(&topics::MARK).unwrap();
    let mut seq = 0;
    // Each writer is another process, which ends; some messages come while earlier ones are unread.
    for round in 0..8 {
        let writing = shm.join(1, round + 2);
        let writer = writing.writer::<AppliedMark>(&topics::MARK).unwrap();
        for burst in (1..=40).cycle().take(400) {
            for _ in 0..burst {
                seq += 1;
                writer.send(&AppliedMark { seq }).unwrap();
            }
            assert!(is_woken(&listener), "message {seq}");
            assert_eq!(listener.take(), None);
            assert_eq!(reader.latest().unwrap(), Some(AppliedMark { seq }));
        }
    }
}

#[test]
fn reader_that_starts_again_is_woken_by_a_writer_that_went_on() {
    let shm = Shm::new();
    let policy = shm.join(1, 1);
    let writer = policy.writer::<AppliedMark>(&topics::MARK).unwrap();
    for seq in 1..=6 {
        let speech = shm.join(1, 2);
        let listener = speech.wake_listener(Service::Speech).unwrap();
        // By datagrams, with the offer of a counter, and by the counter.
        for seq in (20 * seq..).take(15) {
            writer.send(&AppliedMark { seq }).unwrap();
            assert!(is_woken(&listener), "message {seq}");
            assert_eq!(listener.take(), None);
        }
    }
}
