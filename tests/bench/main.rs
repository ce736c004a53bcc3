//! Benchmarks of the decision core, of the arm and of the running group: what a decision and a
//! belief update cost and how good decisions are; how often and how fast poses are reached, beside
//! other solvers; how fast the group starts and recovers, how long an utterance
//! takes to become a decision and where the time goes, what it costs when nothing happens, how
//! steadily joint states come, how much of spoken sentences is understood, how turns are taken in
//! simulated time, what many open pages cost the console, and how dialogues by voice end.
//!
//! Machines are noisy: each figure stands beside a peer that was measured in the same run, and no
//! test rests on one.

mod arm;
mod console;
mod core;
mod idle;
mod jitter;
mod latency;
mod options;
mod peers;
mod report;
mod speech;
mod spoken;
mod start;
mod turns;

use options::{HELP, Options};
use report::Report;
use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word == "--help" || word == "-h") {
        report::print(HELP);
        return ExitCode::SUCCESS;
    }
    let options = match Options::read(words) {
        Ok(options) => options,
        Err(error) => {
            report::print(&format!("{error}\n\n{HELP}"));
            return ExitCode::from(64);
        }
    };
    let mut report = Report::default();
    measure(&options, &mut report);
    match report.write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report::print(&format!("target/bench: {error}"));
            ExitCode::from(74)
        }
    }
}

fn measure(options: &Options, report: &mut Report) {
    if options.wants("--core") {
        peers::measure(report);
        let effort = if options.quick { core::Effort::QUICK } else { core::Effort::FULL };
        core::measure(report, effort);
    }
    if options.wants("--kinematics") {
        arm::measure(report, options.quick);
    }
    if options.wants_all() {
        start::measure(report);
        latency::measure(report);
        idle::measure(report);
    }
    if options.wants("--joints") {
        jitter::measure(report);
    }
    if options.wants("--speech") {
        speech::measure(report, options.quick);
    }
    if options.wants("--turns") {
        turns::measure(report, options);
    }
    if options.wants("--console") {
        console::measure(report, options);
    }
    if options.wants("--spoken") {
        spoken::measure(report, options);
    }
}
