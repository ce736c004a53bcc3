//! Regularity of the joint states: the intervals between those that the arm sends, for an arm that
//! stands and for one that moves, beside a thread that does nothing but sleep for as long, measured at the
//! same time on the same machine.

use crate::report::{Report, percentile};
use messages::{JointStates, topics};
use service::bus::Reader;
use service::client::Client;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use whichone_tests::Group;

/// Duration of each measurement.
const WATCHED: Duration = Duration::from_secs(10);
/// The intervals that are promised of an arm at rest and of one that moves, milliseconds.
const NOMINAL_MS: (f64, f64) = (100.0, 10.0);
/// Polling interval of the topic, which holds the last sixteen joint states.
const LOOK_EVERY: Duration = Duration::from_millis(30);

pub(crate) fn measure(report: &mut Report) {
    let group = Group::up(&["arm.time_scale=0.5"]);
    let client = Client::join(group.paths()).expect("a running group");
    let joints: Reader<JointStates> = client.bus().reader(&topics::JOINTS).expect("joint states");
    std::thread::sleep(Duration::from_secs(2));
    Samples::take(&joints, NOMINAL_MS.0).add(report, "standing");
    let mut samples = None;
    group.fetch_while("the clear bowl", "clear", || {
        samples = Some(Samples::take(&joints, NOMINAL_MS.1))
    });
    samples.expect("it was ordered to pick").add(report, "moving");
    drop((joints, client));
    group.down();
}

/// Joint states of one measurement.
struct Samples {
    nominal_ms: f64,
    sent_ns: Vec<u64>,
    moved: bool,
    beside_ms: Vec<f64>,
}

impl Samples {
    fn take(joints: &Reader<JointStates>, nominal_ms: f64) -> Self {
        let (mut sent_ns, mut moved) = (Vec::new(), false);
        let stop = AtomicBool::new(false);
        let beside_ms = std::thread::scope(|scope| {
            let peer = scope.spawn(|| sleep_regularly(&stop, nominal_ms));
            joints.latest().expect("a topic that can be read");
            let until = Instant::now() + WATCHED;
            while Instant::now() < until {
                let read = joints.drain_stamped(|states, stamp| {
                    sent_ns.push(stamp.sent_ns);
                    moved |= states.velocity.iter().any(|v| v.abs() > 0.01);
                });
                read.expect("a topic that can be read");
                std::thread::sleep(LOOK_EVERY);
            }
            stop.store(true, Ordering::Relaxed);
            peer.join().expect("a thread of ours")
        });
        Self { nominal_ms, sent_ns, moved, beside_ms }
    }

    fn add(&self, report: &mut Report, what: &str) {
        let nominal_ms = self.nominal_ms;
        let name = format!("a thread that sleeps as long, arm {what}");
        add(report, &name, nominal_ms, &self.beside_ms, None);
        let ms = self.sent_ns.windows(2).map(|w| (w[1] - w[0]) as f64 / 1e6);
        let note = if self.moved { "" } else { "no joint moved" };
        let ms: Vec<f64> = ms.collect();
        add(report, &format!("joint states, arm {what}"), nominal_ms, &ms, Some((&name, note)));
    }
}

/// Deviation of every interval from the nominal one, with the intervals themselves in words.
fn add(
    report: &mut Report,
    what: &str,
    nominal_ms: f64,
    intervals_ms: &[f64],
    beside: Option<(&str, &str)>,
) {
    let off: Vec<f64> = intervals_ms.iter().map(|ms| (ms - nominal_ms).abs() * 1e3).collect();
    let [p50, p99, max] = [0.5, 0.99, 1.0].map(|share| percentile(intervals_ms, share));
    let span =
        format!("nominal {nominal_ms} ms; intervals p50 {p50:.3}, p99 {p99:.3}, max {max:.3} ms");
    match beside {
        None => report.add(what, "µs off", &off, &span),
        Some((peer, note)) => {
            let note = if note.is_empty() { span } else { format!("{span}; {note}") };
            report.add_beside(what, "µs off", &off, peer, &note);
        }
    }
}

/// Notes when it wakes, every `nominal_ms`; the intervals in milliseconds.
fn sleep_regularly(stop: &AtomicBool, nominal_ms: f64) -> Vec<f64> {
    let period = Duration::from_secs_f64(nominal_ms / 1e3);
    let (mut next, mut last) = (Instant::now() + period, Instant::now());
    let mut intervals_ms = Vec::new();
    while !stop.load(Ordering::Relaxed) {
        std::thread::sleep(next.saturating_duration_since(Instant::now()));
        let now = Instant::now();
        intervals_ms.push((now - last).as_secs_f64() * 1e3);
        (last, next) = (now, next + period);
    }
    intervals_ms
}
