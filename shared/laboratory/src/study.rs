//! `whichone study`: simulated users for every policy, in threads, with tables, files and plots.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::Instant;

use command_line::Outcome;
use command_line::output::{Output, note};
use evaluation::simulation::Tally;
use safe_files::OutputFolder;
use service::exit::{Exit, Failure};

use crate::args::StudyArgs;

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
    // Before hours of work.
    let folder = args.out.as_deref().map(Files::open).transpose()?;
    let results: Vec<(&Row, Tally)> = rows.iter().zip(conduct(args, &setup, &rows)).collect();
    if let Some(files) = &folder {
        files.write("study.csv", report::to_csv(&results).as_bytes())?;
        let json = report::to_json(args, &setup, &results);
        files.write("study.json", format!("{json:#}\n").as_bytes())?;
        for (name, svg) in plot::pictures(&results)? {
            files.write(&name, svg.as_bytes())?;
        }
        note(format_args!("written to {}", files.path.display()));
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

/// The files of a study, in the folder that the user has named.
struct Files {
    path: PathBuf,
    folder: OutputFolder,
}

impl Files {
    fn open(path: &Path) -> Result<Self, Failure> {
        let folder = OutputFolder::open(path).map_err(|error| Failure::file(path, &error))?;
        Ok(Self { path: path.to_owned(), folder })
    }

    fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let written = self.folder.write(name, bytes);
        written.map_err(|error| Failure::file(&self.path.join(name), &error))
    }
}
