//! One message from a sleeping process to another one, one way, both on one processor, so that every
//! hop is a wake-up: through topics, and through the system's own means with postcard.

mod allocations;
mod peers;
mod topics;
mod zeromq;

use crate::report::{Report, percentile};
use messages::Observation;
use peers::{Datagrams, Parked, Streams};
use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use std::thread::Scope;
use std::time::Instant;
use topics::{Bytes, Fixed, Group, Large};
use zeromq::ZeroMq;

/// Rounds of each transport, there and back.
const ROUNDS: usize = 20_000;
/// Rounds before those that count.
const WARM_UP: usize = 1_000;
/// Turns of two transports that are compared: the machine is faster at times, for both then.
const TURNS: usize = 50;
/// The number that ends an exchange.
const LAST: u64 = u64::MAX;
/// Payloads beside that of 64 bytes.
const SIZES: [(&str, usize); 2] = [("1 KiB", 1 << 10), ("64 KiB", 64 << 10)];

/// One end of a transport.
trait Link {
    /// Sends a message with this number.
    fn send(&mut self, number: u64);

    /// Sleeps until there is a message. Returns its number.
    fn receive(&mut self) -> u64;
}

/// Durations of hops, microseconds, and allocations of each.
struct Hops {
    samples: Vec<f64>,
    allocations: f64,
}

impl Hops {
    fn note(&self) -> String {
        let mean = self.samples.iter().sum::<f64>() / self.samples.len() as f64;
        let p999 = percentile(&self.samples, 0.999);
        format!("mean {mean:.2}, p99.9 {p999:.1}; {:.2} allocations", self.allocations)
    }
}

pub(crate) fn measure(report: &mut Report) {
    let named = |size: &str, by: &str| format!("{size} {by}, one way, one CPU");
    let add = |report: &mut Report, what: &str, hops: Hops, peer: Option<&str>| match peer {
        Some(peer) => report.add_beside(what, "µs", &hops.samples, peer, &hops.note()),
        None => report.add(what, "µs", &hops.samples, &hops.note()),
    };
    add(report, &named("wake-up", "by a futex"), exchange(Parked::pair()), None);
    let group = Group::new();
    let (peer, topic) =
        (named("64 B", "in a datagram with postcard"), named("64 B", "through a topic"));
    let [datagrams, topics] = in_turn(Datagrams::<[u64; 8]>::pair([0; 8]), group.pair(Fixed::open));
    add(report, &peer, datagrams, None);
    add(report, &topic, topics, Some(&peer));
    if let Some(ends) = ZeroMq::<[u64; 8]>::pair([0; 8]) {
        add(report, &named("64 B", "in ZeroMQ with postcard"), exchange(ends), Some(&peer));
    }
    let whole = format!("an observation ({:.1} kB)", size_of::<Observation>() as f64 / 1e3);
    let large = exchange(group.pair(Large::open));
    add(report, &named(&whole, "through a topic"), large, Some(&topic));
    for (size, bytes) in SIZES {
        let peer = named(size, "in a datagram with postcard");
        let message = || (0, vec![200_u8; bytes]);
        let open = |group: &Group, side| Bytes::open(group, side, bytes);
        let [datagrams, topics] = in_turn(Datagrams::pair(message()), group.pair(open));
        add(report, &peer, datagrams, None);
        let stream = named(size, "in a stream with postcard");
        add(report, &stream, exchange(Streams::pair(message())), Some(&peer));
        if let Some(ends) = ZeroMq::pair(message()) {
            let name = named(size, "in ZeroMQ with postcard");
            add(report, &name, exchange(ends), Some(&peer));
        }
        add(report, &named(size, "through an encoded topic"), topics, Some(&peer));
    }
}

/// Sends messages back and forth on the first processor.
fn exchange<A: Link, B: Link>(
    (here, there): (impl FnOnce() -> A + Send, impl FnOnce() -> B + Send),
) -> Hops {
    std::thread::scope(|scope| {
        answer(scope, there);
        on_first_cpu(scope, || {
            let mut end = End::open(here());
            end.rounds(ROUNDS);
            end.close()
        })
    })
}

/// The same with two transports in turn.
fn in_turn<A: Link, B: Link, C: Link, D: Link>(
    (here, there): (impl FnOnce() -> A + Send, impl FnOnce() -> B + Send),
    (other_here, other_there): (impl FnOnce() -> C + Send, impl FnOnce() -> D + Send),
) -> [Hops; 2] {
    std::thread::scope(|scope| {
        answer(scope, there);
        answer(scope, other_there);
        on_first_cpu(scope, || {
            let (mut end, mut other) = (End::open(here()), End::open(other_here()));
            for _ in 0..TURNS {
                end.rounds(ROUNDS / TURNS);
                other.rounds(ROUNDS / TURNS);
            }
            [end.close(), other.close()]
        })
    })
}

/// Answers each message on the first processor.
fn answer<'scope, L: Link>(
    scope: &'scope Scope<'scope, '_>,
    open: impl FnOnce() -> L + Send + 'scope,
) {
    let (opened, is_open) = std::sync::mpsc::channel();
    scope.spawn(move || {
        keep_on_first_cpu();
        let mut link = open();
        opened.send(()).expect("the thread that waits for it");
        loop {
            let number = link.receive();
            link.send(number);
            if number == LAST {
                return;
            }
        }
    });
    is_open.recv().expect("the other end");
}

fn on_first_cpu<'scope, T: Send + 'scope>(
    scope: &'scope Scope<'scope, '_>,
    act: impl FnOnce() -> T + Send + 'scope,
) -> T {
    let thread = scope.spawn(move || {
        keep_on_first_cpu();
        act()
    });
    thread.join().expect("a thread of ours")
}

/// Keeps this thread on the first processor.
fn keep_on_first_cpu() {
    let allowed = sched_getaffinity(None).expect("this thread's processors");
    let first = (0..CpuSet::MAX_CPU).find(|&cpu| allowed.is_set(cpu)).expect("a processor");
    let mut one = CpuSet::new();
    one.set(first);
    sched_setaffinity(None, &one).expect("a processor of this thread");
}

/// The end that measures.
struct End<L> {
    link: L,
    number: u64,
    samples: Vec<f64>,
    allocations: u64,
}

impl<L: Link> End<L> {
    fn open(link: L) -> Self {
        let mut end = Self { link, number: 0, samples: Vec::with_capacity(ROUNDS), allocations: 0 };
        end.rounds(WARM_UP);
        end.samples.clear();
        end.allocations = 0;
        end
    }

    fn rounds(&mut self, rounds: usize) {
        let allocated = allocations::count();
        for _ in 0..rounds {
            self.number += 1;
            let started = Instant::now();
            self.send_and_receive(self.number);
            self.samples.push(started.elapsed().as_secs_f64() * 1e6 / 2.0);
        }
        self.allocations += allocations::count() - allocated;
    }

    fn send_and_receive(&mut self, number: u64) {
        self.link.send(number);
        assert_eq!(self.link.receive(), number);
    }

    fn close(mut self) -> Hops {
        self.send_and_receive(LAST);
        let allocations = self.allocations as f64 / (2 * self.samples.len()) as f64;
        Hops { samples: self.samples, allocations }
    }
}
