//! Benchmarks of the decision core, of the arm and of the running group: what a decision and a
//! belief update cost and how good decisions are; how often and how fast poses are reached, beside
//! other solvers; how fast the group starts and recovers, how long an utterance
//! takes to become a decision and where the time goes, what it costs when nothing happens, how
//! steadily joint states come, how soon the arm accepts an order, how soon joint
//! states of a robot behind ROS 1 are answered by commands, how much of spoken sentences is understood, how turns are taken in
//! simulated time, what many open pages cost the console, what thousands of objects
//! cost the group, what the recorder and the flight recorder cost, how dialogues by voice end, and how soon
//! the arm stops while something is short.
//!
//! Machines are noisy: each figure stands beside a peer that was measured in the same run, and no
//! test rests on one.

mod arm;
mod console;
mod core;
mod documents;
mod flight;
mod hop;
mod idle;
mod jitter;
mod latency;
mod long;
mod options;
mod orders;
mod peers;
mod recorder;
mod report;
mod ros1;
mod size;
mod speech;
mod spoken;
mod start;
mod stops;
mod turns;

use clap::Parser;
use options::Options;
use report::Report;
use std::process::ExitCode;

fn main() -> ExitCode {
    let options = match Options::try_parse() {
        Ok(options) => options,
        Err(error) => {
            report::print(&error.to_string());
            return ExitCode::from(if error.use_stderr() { 64 } else { 0 });
        }
    };
    if let Some(reports) = &options.compare {
        return documents::compare(reports);
    }
    if let Some(reports) = &options.write {
        return documents::write(reports);
    }
    whichone_tests::end_with_groups();
    let mut report = Report::new(documents::arguments());
    // What was measured before a part failed is printed, and is no report that documents are compared with.
    let measured = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        (0..options.runs).for_each(|_| measure(&options, &mut report));
    }));
    if measured.is_err() {
        report::print(&report.text());
        return ExitCode::from(70);
    }
    match report.write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report::print(&format!("target/bench: {error}"));
            ExitCode::from(74)
        }
    }
}

fn measure(options: &Options, report: &mut Report) {
    let all = options.wants_all();
    if all || options.core || options.processes {
        peers::measure(report);
    }
    if all || options.core {
        let effort = if options.quick { core::Effort::QUICK } else { core::Effort::FULL };
        core::measure(report, effort);
    }
    if all || options.bounds {
        core::bounds::measure(report, options.seconds(), options.quick);
    }
    if all || options.kinematics {
        arm::measure(report, options.quick);
    }
    if all || options.processes || options.hops {
        hop::measure(report);
    }
    if all || options.processes {
        start::measure(report);
        latency::measure(report);
        idle::measure(report);
    }
    if all || options.recorder {
        recorder::measure(report, options.quick);
    }
    if all || options.flight {
        flight::measure(report, options.quick);
    }
    if all || options.long {
        long::measure(report, options);
    }
    if all || options.joints {
        jitter::measure(report);
    }
    if all || options.orders {
        orders::measure(report, options.quick);
    }
    if all || options.stops {
        stops::measure(report, options.quick);
    }
    if all || options.ros1 {
        ros1::measure(report, options.quick);
    }
    if all || options.speech {
        speech::measure(report, options.quick, options.kept_apart);
    }
    if all || options.endings {
        speech::measure_endings(report, options.quick);
    }
    if all || options.turns {
        turns::measure(report, options);
    }
    if all || options.console {
        console::measure(report, options);
    }
    if all || options.size {
        size::measure(report, options);
    }
    if all || options.spoken {
        spoken::measure(report, options);
    }
}
