//! Benchmarks of the decision core, of the arm and of the running group; [`parts`] lists them.
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
mod parts;
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
    peers::measure(report);
    options.parts.selected().for_each(|part| (part.measure)(report, options));
}
