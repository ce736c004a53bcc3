//! Benchmarks of the decision core, of the arm and of the running group; [`parts`] lists them.
//!
//! Machines are noisy: each figure stands beside a peer that was measured in the same run, and no
//! test rests on one.

mod arm;
mod console;
mod core;
mod flight;
mod hop;
mod idle;
mod jitter;
mod latency;
mod long;
mod options;
mod orders;
mod page;
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
    if options.write && options.wants_all() {
        report::print("--write: a run of all parts shortens some; help: name those to be written");
        return ExitCode::from(64);
    }
    whichone_tests::end_with_groups();
    let mut report = Report::default();
    // What was measured before a part failed is printed, and is no report.
    let measured = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
        measure(&options, &mut report);
    }));
    if measured.is_err() {
        report::print(&report.text());
        return ExitCode::from(70);
    }
    let written = report.write().and_then(|()| match options.write {
        true => page::write(&report),
        false => Ok(()),
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            report::print(&format!("the report: {error}"));
            ExitCode::from(74)
        }
    }
}

fn measure(options: &Options, report: &mut Report) {
    peers::measure(report);
    for part in options.parts.selected() {
        report.part = part.name;
        (part.measure)(report, options);
    }
}
