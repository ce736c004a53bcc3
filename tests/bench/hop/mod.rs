//! One message from a sleeping process to another one, one way, both on one processor, so that every
//! hop is a wake-up: through topics, and through the system's own means with postcard.

mod allocations;
mod peers;
mod topics;

use crate::report::{Report, percentile};
use messages::Observation;
use peers::{Datagrams, Parked, Streams};
use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};
use std::time::Instant;
use topics::{Bytes, Fixed, Group, Large};

/// Rounds of each transport, there and back.
const ROUNDS: usize = 20_000;
/// Rounds before those that count.
const WARM_UP: usize = 1_000;
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
    let peer = named("64 B", "in a datagram with postcard");
    add(report, &peer, exchange(Datagrams::<[u64; 8]>::pair([0; 8])), None);
    let group = Group::new();
    let topic = named("64 B", "through a topic");
    add(report, &topic, exchange(group.pair(Fixed::open)), Some(&peer));
    let whole = format!("an observation ({:.1} kB)", size_of::<Observation>() as f64 / 1e3);
    let large = exchange(group.pair(Large::open));
    add(report, &named(&whole, "through a topic"), large, Some(&topic));
    for (size, bytes) in SIZES {
        let peer = named(size, "in a datagram with postcard");
        let message = || (0, vec![200_u8; bytes]);
        add(report, &peer, exchange(Datagrams::pair(message())), None);
        let stream = named(size, "in a stream with postcard");
        add(report, &stream, exchange(Streams::pair(message())), Some(&peer));
        let topic = named(size, "through an encoded topic");
        let open = |group: &Group, side| Bytes::open(group, side, bytes);
        add(report, &topic, exchange(group.pair(open)), Some(&peer));
    }
}

/// Sends messages back and forth on the first processor.
fn exchange<A: Link, B: Link>(
    (here, there): (impl FnOnce() -> A + Send, impl FnOnce() -> B + Send),
) -> Hops {
    std::thread::scope(|scope| {
        let (opened, is_open) = std::sync::mpsc::channel();
        scope.spawn(move || {
            on_first_cpu();
            let mut link = there();
            opened.send(()).expect("the other end");
            loop {
                let number = link.receive();
                link.send(number);
                if number == LAST {
                    return;
                }
            }
        });
        let measured = scope.spawn(move || {
            on_first_cpu();
            is_open.recv().expect("the other end");
            rounds(&mut here())
        });
        measured.join().expect("a thread of ours")
    })
}

/// Keeps this thread on the first processor.
fn on_first_cpu() {
    let allowed = sched_getaffinity(None).expect("this thread's processors");
    let first = (0..CpuSet::MAX_CPU).find(|&cpu| allowed.is_set(cpu)).expect("a processor");
    let mut one = CpuSet::new();
    one.set(first);
    sched_setaffinity(None, &one).expect("a processor of this thread");
}

fn rounds(link: &mut impl Link) -> Hops {
    let mut samples = Vec::with_capacity(ROUNDS);
    let mut allocated = 0;
    for n in 1..=WARM_UP + ROUNDS {
        if n == WARM_UP + 1 {
            samples.clear();
            allocated = allocations::count();
        }
        let started = Instant::now();
        link.send(n as u64);
        assert_eq!(link.receive(), n as u64);
        samples.push(started.elapsed().as_secs_f64() * 1e6 / 2.0);
    }
    let allocations = (allocations::count() - allocated) as f64 / (2 * ROUNDS) as f64;
    link.send(LAST);
    assert_eq!(link.receive(), LAST);
    Hops { samples, allocations }
}
