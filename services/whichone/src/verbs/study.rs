//! `whichone study`: simulated users for every policy, in threads, with tables, files and plots.

use std::num::NonZeroUsize;
use std::path::Path;
use std::time::Instant;

use evaluation::simulation::Tally;
use service::exit::{Exit, Failure};

use crate::Outcome;
use crate::cli::StudyArgs;
use crate::output::{Output, note};

mod design;
mod people;
mod plot;
mod progress;
mod report;
mod run;
mod seconds;
mod setup;
mod table;

pub(super) use people::report;

use design::Row;
use setup::Setup;

/// Runs a study with simulated users.
pub(super) fn study(args: &StudyArgs, out: &mut Output<'_>) -> Outcome {
    let setup = Setup::new(args)?;
    let rows = design::rows(args, setup.planner())?;
    if let Some(folder) = &args.out {
        std::fs::create_dir_all(folder).map_err(|error| Failure::file(folder, &error))?;
    }
    let results: Vec<(&Row, Tally)> = rows.iter().zip(conduct(args, &setup, &rows)).collect();
    if let Some(folder) = &args.out {
        write(folder, "study.csv", report::to_csv(&results).as_bytes())?;
        let json = report::to_json(args, &setup, &results);
        write(folder, "study.json", format!("{json:#}\n").as_bytes())?;
        for (name, bytes) in plot::pictures(&results)? {
            write(folder, &name, &bytes)?;
        }
        note(format_args!("written to {}", folder.display()));
    }
    if out.is_json() {
        out.json(&report::to_json(args, &setup, &results))?;
    } else {
        let lines = table::lines(&setup, &results).into_iter().chain(seconds::lines(&setup));
        lines.into_iter().try_for_each(|line| out.line(line))?;
    }
    Ok(Exit::Ok)
}

/// Simulates every row, and reports the time that took.
fn conduct(args: &StudyArgs, setup: &Setup, rows: &[Row]) -> Vec<Tally> {
    let began = Instant::now();
    let threads = args.threads.or(std::thread::available_parallelism().ok());
    let threads = threads.map_or(1, NonZeroUsize::get);
    let tallies = run::run(setup, rows, args.interactions.get(), args.seed, threads);
    let seconds = began.elapsed().as_secs_f64();
    let done = args.interactions.get() as f64 * rows.len() as f64;
    note(format_args!(
        "{} in {seconds:.1} s on {}, {:.0} a second",
        scene::count(done, "interaction"),
        scene::count(threads, "thread"),
        done / seconds.max(1e-9)
    ));
    tallies
}

/// Writes a file of the study.
fn write(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), Failure> {
    let path = folder.join(name);
    std::fs::write(&path, bytes).map_err(|error| Failure::file(&path, &error))
}
