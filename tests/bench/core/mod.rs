//! The decision core alone: time of decisions and updates, and quality of the decisions.
//!
//! Everything is deterministic but the clock: the same scenes, beliefs and draws in every run.

pub(crate) mod bounds;
mod decide;
mod gap;
mod quality;
mod reading;
pub(crate) mod scenes;
mod study;
mod update;

use crate::report::Report;
use std::time::Instant;

/// Amounts of work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Most repetitions of one figure.
    pub(crate) repetitions: usize,
    /// Seconds after which a figure is not repeated any more.
    pub(crate) patience_s: f64,
    /// A planner is asked about a larger scene only if it can be expected to answer in that many
    /// seconds: as many times its time on the smaller scene as the larger has more values.
    pub(crate) budget_s: f64,
    /// Dialogues less probable than this are cut short in exact evaluations.
    pub(crate) cut: f64,
    /// True if series leave out small steps.
    pub(crate) quick: bool,
}

impl Effort {
    pub(crate) const FULL: Self =
        Self { repetitions: 200, patience_s: 2.0, budget_s: 60.0, cut: 1e-7, quick: false };
    pub(crate) const QUICK: Self =
        Self { repetitions: 20, patience_s: 0.2, budget_s: 2.0, cut: 1e-4, quick: true };
}

pub(crate) fn measure(report: &mut Report, effort: Effort) {
    decide::measure(report, effort);
    update::measure(report, effort);
    reading::measure(report);
    study::measure(report, effort);
    gap::measure(report, effort);
    quality::measure(report, effort);
}

/// Microseconds of `act`, sample by sample, until there are enough or patience ends. Each sample
/// is of fresh input, whose preparation is not timed.
fn micros<P>(effort: Effort, mut prepare: impl FnMut() -> P, mut act: impl FnMut(P)) -> Vec<f64> {
    let begun = Instant::now();
    let mut samples = Vec::new();
    while samples.is_empty()
        || (samples.len() < effort.repetitions && begun.elapsed().as_secs_f64() < effort.patience_s)
    {
        let prepared = prepare();
        let started = Instant::now();
        act(prepared);
        samples.push(started.elapsed().as_secs_f64() * 1e6);
    }
    samples
}
