//! Topics of a group, with everything that a service sleeps on.

use super::Link;
use messages::definition::Definition;
use messages::schema::{Field, Schema};
use messages::topics::{self, Topic};
use messages::{ArmStatus, Observation, Service};
use rustix::event::{EventfdFlags, eventfd};
use serde::{Deserialize, Serialize};
use service::Span;
use service::bus::{Bus, EncodedReader, EncodedWriter, Identity, Reader, WakeListener, Writer};
use service::group::GroupPaths;
use service::shm_cleanup;
use std::os::fd::{AsFd, OwnedFd};

/// Other descriptors that a service sleeps on: signals, lifeline, journal, devices, urgent messages.
const OTHERS: usize = 5;
/// Longest sleep of a service.
const LONGEST: Span = Span::from_ms(500);

/// The services at the two ends, and the topics that they write.
const SERVICES: [Service; 2] = [Service::Speech, Service::Policy];
const FIXED: [Topic; 2] = [
    Topic { name: "bench/ping", buffer: 4, readers: &[Service::Policy], ..topics::STATUS },
    Topic { name: "bench/pong", buffer: 4, readers: &[Service::Speech], ..topics::STATUS },
];
const LARGE: [Topic; 2] = [
    Topic { name: "bench/ping/large", readers: &[Service::Policy], ..topics::OBSERVATION },
    Topic { name: "bench/pong/large", readers: &[Service::Speech], ..topics::OBSERVATION },
];
const ENCODED: [Topic; 2] =
    [encoded("bench/ping/bytes", &FIXED[0]), encoded("bench/pong/bytes", &FIXED[1])];

const fn encoded(name: &'static str, like: &Topic) -> Topic {
    let (readers, buffer) = (like.readers, like.buffer);
    Topic { readers, buffer, ..Topic::new::<Blob<'_>>(name, like.writer) }
}

/// A group's shared memory.
pub(super) struct Group {
    paths: GroupPaths,
    _home: tempfile::TempDir,
}

impl Group {
    pub(super) fn new() -> Self {
        let home = tempfile::Builder::new().prefix("wo").tempdir().expect("a temporary folder");
        let name = "hop".parse().expect("a name");
        let paths = GroupPaths::in_home(home.path(), &name).expect("a short path");
        shm_cleanup::create_place(&paths).expect("shared memory");
        Self { paths, _home: home }
    }

    /// The two ends, each opened in its own thread.
    pub(super) fn pair<L: Link>(
        &self,
        open: impl Fn(&Self, usize) -> L + Copy + Send,
    ) -> (impl FnOnce() -> L + Send, impl FnOnce() -> L + Send) {
        (move || open(self, 0), move || open(self, 1))
    }
}

impl Drop for Group {
    fn drop(&mut self) {
        shm_cleanup::remove_leftovers(&self.paths);
    }
}

/// What one process sleeps on.
struct Sleep {
    listener: WakeListener,
    others: [OwnedFd; OTHERS],
    bus: Bus,
}

impl Sleep {
    fn open(group: &Group, side: usize) -> Self {
        let service = SERVICES[side];
        let bus = Bus::open(&group.paths, service.name(), Identity::default());
        let bus = bus.expect("shared memory");
        Self {
            listener: bus.wake_listener(service).expect("a listener"),
            others: [(); OTHERS].map(|()| eventfd(0, EventfdFlags::CLOEXEC).expect("a descriptor")),
            bus,
        }
    }

    /// Sleeps until there is a message, as the main loop of a service does.
    fn until<T>(&self, take: impl Fn() -> Option<T>) -> T {
        loop {
            let sources = self.others.each_ref().map(|fd| Some(fd.as_fd()));
            self.listener.sleep(&sources, LONGEST);
            self.listener.take();
            if let Some(message) = take() {
                return message;
            }
        }
    }
}

/// Messages of fixed size, filled and read in place.
pub(super) struct Fixed {
    reader: Reader<ArmStatus>,
    writer: Writer<ArmStatus>,
    place: Place,
    sleep: Sleep,
}

impl Fixed {
    pub(super) fn open(group: &Group, side: usize) -> Self {
        let sleep = Sleep::open(group, side);
        let reader = sleep.bus.reader(&FIXED[1 - side]).expect("a reader");
        let writer = sleep.bus.writer(&FIXED[side]).expect("a writer");
        Self { reader, writer, place: Place::default(), sleep }
    }
}

impl Link for Fixed {
    fn send(&mut self, number: u64) {
        let place = &mut self.place;
        let sent = self.writer.send_with(|message| {
            place.check(std::ptr::from_mut(message) as usize);
            message.interaction = number;
        });
        sent.expect("a topic that can be written");
    }

    fn receive(&mut self) -> u64 {
        let read =
            |message: &ArmStatus| (message.interaction, std::ptr::from_ref(message) as usize);
        let Self { reader, place, sleep, .. } = self;
        let (number, address) = sleep.until(|| reader.take(read).expect("a topic"));
        place.check(address);
        number
    }
}

/// The largest messages of fixed size but one, copied into their place by the writer, as a reducer's outputs are.
pub(super) struct Large {
    reader: Reader<Observation>,
    writer: Writer<Observation>,
    message: Box<Observation>,
    place: Place,
    sleep: Sleep,
}

impl Large {
    pub(super) fn open(group: &Group, side: usize) -> Self {
        let sleep = Sleep::open(group, side);
        let reader = sleep.bus.reader(&LARGE[1 - side]).expect("a reader");
        let writer = sleep.bus.writer(&LARGE[side]).expect("a writer");
        Self { reader, writer, message: Box::default(), place: Place::default(), sleep }
    }
}

impl Link for Large {
    fn send(&mut self, number: u64) {
        self.message.seq = number;
        self.writer.send(&self.message).expect("a topic that can be written");
    }

    fn receive(&mut self) -> u64 {
        let read = |message: &Observation| (message.seq, std::ptr::from_ref(message) as usize);
        let Self { reader, place, sleep, .. } = self;
        let (number, address) = sleep.until(|| reader.take(read).expect("a topic"));
        place.check(address);
        number
    }
}

/// Bytes with a number, borrowed from where they lie.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Blob<'a> {
    number: u64,
    #[serde(borrow, serialize_with = "as_bytes")]
    bytes: &'a [u8],
}

/// Serde's own way of writing bytes is one at a time.
fn as_bytes<S: serde::Serializer>(bytes: &[u8], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_bytes(bytes)
}

impl Schema for Blob<'_> {
    const NAME: &'static str = "Blob";

    fn fields() -> Vec<Field> {
        Vec::new()
    }

    fn layout() -> Option<messages::layout::Layout> {
        None
    }

    fn definition() -> Definition {
        Definition::Payload(Default::default())
    }
}

/// Encoded payloads, written into shared memory and read from there.
pub(super) struct Bytes {
    reader: EncodedReader<Blob<'static>>,
    writer: EncodedWriter<Blob<'static>>,
    place: Place,
    bytes: &'static [u8],
    sleep: Sleep,
}

impl Bytes {
    pub(super) fn open(group: &Group, side: usize, size: usize) -> Self {
        let sleep = Sleep::open(group, side);
        let reader = sleep.bus.encoded_reader(&ENCODED[1 - side]).expect("a reader");
        let writer = sleep.bus.encoded_writer(&ENCODED[side]).expect("a writer");
        let bytes = vec![200; size].leak();
        Self { reader, writer, place: Place::default(), bytes, sleep }
    }
}

impl Link for Bytes {
    fn send(&mut self, number: u64) {
        let blob = Blob { number, bytes: self.bytes };
        self.writer.send(&blob).expect("a topic that can be written");
    }

    fn receive(&mut self) -> u64 {
        let read = |bytes: &[u8]| {
            let blob: Blob<'_> = postcard::from_bytes(bytes)?;
            Ok((blob.number, blob.bytes.as_ptr() as usize))
        };
        let Self { reader, place, sleep, .. } = self;
        let (number, address) = sleep.until(|| reader.take_with(read).expect("a topic"));
        place.check(address);
        number
    }
}

/// The mapping of shared memory in which payloads have been seen last.
#[derive(Default)]
struct Place(Vec<std::ops::Range<usize>>);

impl Place {
    /// Checks that the payload at `address` lies in shared memory, and is no copy.
    fn check(&mut self, address: usize) {
        if self.0.iter().any(|mapping| mapping.contains(&address)) {
            return;
        }
        let maps = std::fs::read_to_string("/proc/self/maps").expect("this process's mappings");
        let shared = maps.lines().filter(|line| line.contains("/dev/shm/"));
        let range = |line: &str| {
            let (from, to) = line.split_whitespace().next()?.split_once('-')?;
            let number = |text| usize::from_str_radix(text, 16).ok();
            Some(number(from)?..number(to)?)
        };
        let found = shared.filter_map(range).find(|mapping| mapping.contains(&address));
        self.0.push(found.expect("a payload in shared memory"));
    }
}
