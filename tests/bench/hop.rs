//! One message from a sleeping process's writer to another one's reader: 64 bytes with its stamp, one way,
//! both on one processor, so that every hop is a wake-up. Beside it a bare datagram with postcard.

use crate::report::{Report, percentile};
use messages::topics::{self, Topic};
use messages::{ArmStatus, Service};
use rustix::event::{EventfdFlags, eventfd};
use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use service::Span;
use service::bus::{Bus, Identity};
use service::group::GroupPaths;
use service::shm_cleanup;
use std::os::fd::{AsFd, OwnedFd};
use std::os::unix::net::UnixDatagram;
use std::time::Instant;

/// Rounds of each transport, there and back.
const ROUNDS: usize = 20_000;
/// Rounds before those that count.
const WARM_UP: usize = 1_000;
/// Other descriptors that a service sleeps on: signals, lifeline, journal, devices, urgent messages.
const OTHERS: usize = 5;
/// Longest sleep of a service.
const LONGEST: Span = Span::from_ms(500);
const DATAGRAM: &str = "64 B in a datagram with postcard, one way, one CPU";

const PING: Topic =
    Topic { name: "bench/ping", buffer: 4, readers: &[Service::Policy], ..topics::STATUS };
const PONG: Topic =
    Topic { name: "bench/pong", buffer: 4, readers: &[Service::Speech], ..topics::STATUS };

pub(crate) fn measure(report: &mut Report) {
    let datagrams = on_one_cpu(datagrams);
    report.add(DATAGRAM, "µs", &datagrams, "");
    let hops = on_one_cpu(topics);
    let note = format!("p50 of the round trip {:.1} µs", 2.0 * percentile(&hops, 0.5));
    report.add_beside("64 B through a topic, one way, one CPU", "µs", &hops, DATAGRAM, &note);
}

/// Runs `work`, and the threads that it starts, on the first processor.
fn on_one_cpu<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let work = || {
        let allowed = sched_getaffinity(None).expect("this thread's processors");
        let first = (0..CpuSet::MAX_CPU).find(|&cpu| allowed.is_set(cpu)).expect("a processor");
        let mut one = CpuSet::new();
        one.set(first);
        sched_setaffinity(None, &one).expect("a processor of this thread");
        work()
    };
    std::thread::scope(|scope| scope.spawn(work).join().expect("a thread of ours"))
}

/// Calls `round` often. Returns half of each duration, microseconds.
fn rounds(mut round: impl FnMut(u64)) -> Vec<f64> {
    let mut timed = |n| {
        let started = Instant::now();
        round(n);
        started.elapsed().as_secs_f64() * 1e6 / 2.0
    };
    let all: Vec<f64> = (1..=(WARM_UP + ROUNDS) as u64).map(&mut timed).collect();
    all[WARM_UP..].to_vec()
}

fn datagrams() -> Vec<f64> {
    let (here, there) = UnixDatagram::pair().expect("a pair of sockets");
    let exchange = |socket: &UnixDatagram, message: [u64; 8]| {
        let bytes = postcard::to_stdvec(&message).expect("room for a message");
        socket.send(&bytes).expect("a socket with room");
    };
    let receive = |socket: &UnixDatagram| -> [u64; 8] {
        let mut bytes = [0; 128];
        let length = socket.recv(&mut bytes).expect("a datagram");
        postcard::from_bytes(&bytes[..length]).expect("a message")
    };
    std::thread::scope(|scope| {
        scope.spawn(|| {
            loop {
                let message = receive(&there);
                exchange(&there, message);
                if message[0] == 0 {
                    return;
                }
            }
        });
        let samples = rounds(|n| {
            exchange(&here, [u64::MAX - n; 8]);
            assert_eq!(receive(&here)[0], u64::MAX - n);
        });
        exchange(&here, [0; 8]);
        samples
    })
}

fn topics() -> Vec<f64> {
    let home = tempfile::Builder::new().prefix("wo").tempdir().expect("a temporary folder");
    let name = "hop".parse().expect("a name");
    let paths = GroupPaths::in_home(home.path(), &name).expect("a short path");
    shm_cleanup::create_place(&paths).expect("shared memory");
    // It keeps the topics, as the supervisor does.
    let keeper = Bus::open(&paths, "bench", Identity::default()).expect("shared memory");
    let (there, here) = (Service::Policy, Service::Speech);
    let _kept = (keeper.wake_listener(Service::Console), keeper.reader::<ArmStatus>(&PONG));
    let samples = std::thread::scope(|scope| {
        let (opened, is_open) = std::sync::mpsc::channel();
        let paths = &paths;
        scope.spawn(move || {
            let end = End::open(paths, there, (&PING, &PONG));
            opened.send(()).expect("the other end");
            loop {
                let message = end.receive();
                end.send(message);
                if message.interaction == 0 {
                    return;
                }
            }
        });
        is_open.recv().expect("the other end");
        let end = End::open(paths, here, (&PONG, &PING));
        let message = |interaction| ArmStatus { interaction, ..ArmStatus::default() };
        let samples = rounds(|n| {
            end.send(message(n));
            assert_eq!(end.receive().interaction, n);
        });
        end.send(message(0));
        samples
    });
    drop(keeper);
    shm_cleanup::remove_leftovers(&paths);
    samples
}

/// One process, with what it sleeps on.
struct End {
    reader: service::bus::Reader<ArmStatus>,
    writer: service::bus::Writer<ArmStatus>,
    listener: service::bus::WakeListener,
    others: [OwnedFd; OTHERS],
    _bus: Bus,
}

impl End {
    fn open(paths: &GroupPaths, service: Service, (reads, writes): (&Topic, &Topic)) -> Self {
        let bus = Bus::open(paths, service.name(), Identity::default()).expect("shared memory");
        Self {
            listener: bus.wake_listener(service).expect("a listener"),
            reader: bus.reader(reads).expect("a reader"),
            writer: bus.writer(writes).expect("a writer"),
            others: [(); OTHERS].map(|()| eventfd(0, EventfdFlags::CLOEXEC).expect("a descriptor")),
            _bus: bus,
        }
    }

    fn send(&self, message: ArmStatus) {
        self.writer.send(&message).expect("a topic that can be written");
    }

    /// Sleeps until there is a message, as the main loop of a service does.
    fn receive(&self) -> ArmStatus {
        loop {
            let sources = self.others.each_ref().map(|fd| Some(fd.as_fd()));
            self.listener.sleep(&sources, LONGEST);
            self.listener.take();
            if let Some(message) = self.reader.take(|message| *message).expect("a topic") {
                return message;
            }
        }
    }
}
