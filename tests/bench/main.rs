//! Benchmarks of the running group: how fast it starts and recovers, how long an utterance takes to
//! become a decision and where the time goes, and what the group costs when nothing happens.
//!
//! Machines are noisy: each figure stands beside a peer that was measured in the same run.

mod idle;
mod latency;
mod peers;
mod report;
mod start;

use report::Report;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut report = Report::default();
    peers::measure(&mut report);
    start::measure(&mut report);
    latency::measure(&mut report);
    idle::measure(&mut report);
    match report.write() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report::print(&format!("target/bench: {error}"));
            ExitCode::from(74)
        }
    }
}
