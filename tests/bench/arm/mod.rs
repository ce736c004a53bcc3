//! The arm: inverse kinematics beside other solvers, forward kinematics, motions and clearances.
//!
//! All solvers get the same targets, one after the other on an otherwise idle process; what they
//! answer is judged by forward kinematics that none of them uses. The targets are the same in
//! every run.

mod checks;
mod damped;
mod five;
mod inverse;
mod motion;
mod python;
mod refusal;
mod subject;
mod targets;

use crate::report::Report;
use std::sync::LazyLock;
use subject::{BAXTER, Subject, UR5E};

pub(crate) fn measure(report: &mut Report, quick: bool) {
    let effort = if quick { Effort::QUICK } else { Effort::FULL };
    kinematics(report, &BAXTER, effort);
    kinematics(report, &UR5E, effort);
    five::measure(report, effort);
    refusal::reference(report);
    checks::clearance(report);
    motion::measure(report);
}

fn kinematics(report: &mut Report, subject: &'static Subject, effort: Effort) {
    let targets = targets::reachable(subject, effort.own);
    let anywhere = targets::anywhere(&targets, effort.peers);
    let python = python::measure(subject, &targets[..effort.peers], &anywhere, effort);
    inverse::measure(report, subject, &targets, &python, effort);
    inverse::measure_nearest(report, subject, &targets, &python, effort);
    refusal::measure(report, subject, &anywhere, &python);
    checks::forward(report, subject, &python);
}

/// Number of targets by kind of solver: slow ones get the first targets only.
#[derive(Clone, Copy, Debug)]
struct Effort {
    own: usize,
    peers: usize,
    /// For a solver that takes ten milliseconds and more.
    slow: usize,
}

impl Effort {
    const FULL: Self = Self { own: 20_000, peers: 2_000, slow: 200 };
    const QUICK: Self = Self { own: 2_000, peers: 200, slow: 20 };
}

/// Seconds that solvers with a limit get per call: of processor those that are called from here,
/// of elapsed time those that look at a clock of their own.
const BUDGET_S: f64 = 5e-3;

/// Postures of one sample of forward kinematics.
const POSTURES: usize = 1000;

/// Seconds of processor that this thread has used: what else runs on the machine counts little.
pub(crate) fn thread_s() -> f64 {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Returns the result of a call and its processor time in microseconds, less the time of reading
/// the clock.
fn timed<T>(call: impl FnOnce() -> T) -> (T, f64) {
    static CLOCK_S: LazyLock<f64> = LazyLock::new(|| {
        let look = || -thread_s() + thread_s();
        (0..1000).map(|_| look()).fold(f64::INFINITY, f64::min)
    });
    let clock_s = *CLOCK_S;
    let started = thread_s();
    let given = std::hint::black_box(call());
    (given, (thread_s() - started - clock_s).max(0.0) * 1e6)
}

fn mean(samples: &[f64]) -> f64 {
    samples.iter().sum::<f64>() / samples.len().max(1) as f64
}

/// A file of the reference.
fn fixture(name: &str) -> String {
    let path = format!("{}/fixtures/baxter/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The rows of a CSV file of the reference, without its heads.
fn rows(name: &str) -> Vec<Vec<String>> {
    let text = fixture(name);
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The numbers of some fields; those that are none are not a number.
fn numbers(fields: &[String]) -> Vec<f64> {
    fields.iter().map(|field| field.parse().unwrap_or(f64::NAN)).collect()
}

fn seven(numbers: &[f64]) -> manipulation::Joints {
    std::array::from_fn(|i| numbers.get(i).copied().unwrap_or(f64::NAN))
}
