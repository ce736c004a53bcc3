//! A group at work for hours without faults: what it holds must not grow.
//!
//! Prints memory, descriptors, threads, shared memory and journals at regular times, and compares the
//! second quarter of the run with the last. Exit code 70 where something has grown.

use clap::Parser;
use service::shm_cleanup::leftovers;
use std::fmt;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use vocabulary::Rng;
use whichone_tests::Group;

const BOWLS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];
/// Growth of a median that is noise: a tenth, and this many units.
const NOISE: [f64; Sample::COLUMNS.len()] = [2048.0, 4.0, 0.0, 256.0, 2048.0];

/// A group at work for hours; fails where memory, descriptors or files grow
#[derive(Parser)]
#[command(name = "soak")]
struct Plan {
    /// Duration, minutes
    #[arg(long, value_name = "N", default_value_t = 120)]
    minutes: u64,
    /// Time between two samples, seconds
    #[arg(long, value_name = "N", default_value_t = 60)]
    every: u64,
    /// Seed of the wanted objects
    #[arg(long, value_name = "S", default_value_t = 1)]
    seed: u64,
}

/// What the group holds at one time.
struct Sample {
    minutes: f64,
    dialogues: u64,
    values: [f64; Self::COLUMNS.len()],
}

impl Sample {
    const COLUMNS: [&'static str; 5] =
        ["memory KiB", "descriptors", "threads", "shared KiB", "journals KiB"];

    fn take(group: &Group, started: Instant, dialogues: u64) -> Self {
        let status = group.status();
        let services = status["services"].as_array().expect("services").iter();
        let pids = services.map(|service| &service["pid"]).chain([&status["supervisor_pid"]]);
        let processes: Vec<Process> = pids.filter_map(|pid| Process::of(pid.as_i64()?)).collect();
        let sum = |of: fn(&Process) -> f64| processes.iter().map(of).sum::<f64>();
        let shared = leftovers(group.paths()).iter().map(|path| blocks_kib(path)).sum();
        let values = [
            sum(|process| process.memory_kib),
            sum(|process| process.descriptors),
            sum(|process| process.threads),
            shared,
            folder_kib(&group.paths().journal()),
        ];
        Self { minutes: started.elapsed().as_secs_f64() / 60.0, dialogues, values }
    }
}

impl fmt::Display for Sample {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:>8.1} {:>9}", self.minutes, self.dialogues)?;
        self.values.iter().try_for_each(|value| write!(f, " {value:>13.0}"))
    }
}

/// What one process holds.
struct Process {
    memory_kib: f64,
    descriptors: f64,
    threads: f64,
}

impl Process {
    /// Reads `/proc`; none where the process has ended.
    fn of(pid: i64) -> Option<Self> {
        let folder = format!("/proc/{pid}");
        let status = fs::read_to_string(format!("{folder}/status")).ok()?;
        let number = |key: &str| -> Option<f64> {
            let line = status.lines().find_map(|line| line.strip_prefix(key))?;
            line.split_whitespace().next()?.parse().ok()
        };
        let descriptors = fs::read_dir(format!("{folder}/fd")).ok()?.count() as f64;
        Some(Self { memory_kib: number("RssAnon:")?, descriptors, threads: number("Threads:")? })
    }
}

fn main() -> ExitCode {
    let plan = Plan::parse();
    whichone_tests::end_with_groups();
    let group = Group::up(&["arm.time_scale=20.0"]);
    let samples = work(&group, &plan);
    group.verify_journals();
    group.down();
    let grown = growth(&samples);
    grown.iter().for_each(|line| print(line));
    if grown.is_empty() {
        print("nothing has grown");
    }
    ExitCode::from(if grown.is_empty() { 0 } else { 70 })
}

/// Has one object after another fetched, and samples meanwhile.
fn work(group: &Group, plan: &Plan) -> Vec<Sample> {
    print(&format!("seed {}", plan.seed));
    let columns = Sample::COLUMNS.map(|column| format!(" {column:>13}")).concat();
    print(&format!("{:>8} {:>9}{columns}", "minutes", "dialogues"));
    let (started, mut rng, mut dialogues) = (Instant::now(), Rng::new(plan.seed), 0);
    let mut samples: Vec<Sample> = Vec::new();
    while started.elapsed() < Duration::from_secs(60 * plan.minutes) {
        let bowl = BOWLS[rng.below(BOWLS.len())];
        let outcome = group.fetch("get me the bowl", bowl);
        assert_eq!((&outcome["outcome"], &outcome["object"]), (&"delivered".into(), &bowl.into()));
        dialogues += 1;
        let due = plan.every as f64 / 60.0 * (samples.len() + 1) as f64;
        if started.elapsed().as_secs_f64() / 60.0 >= due {
            samples.push(Sample::take(group, started, dialogues));
            print(&samples[samples.len() - 1].to_string());
        }
    }
    samples
}

/// One line for each value whose median in the last quarter exceeds that in the second.
fn growth(samples: &[Sample]) -> Vec<String> {
    let quarter = samples.len() / 4;
    if quarter == 0 {
        return vec!["too short to compare: expected at least 4 samples".to_owned()];
    }
    let median = |column: usize, of: &[Sample]| {
        let mut values: Vec<f64> = of.iter().map(|sample| sample.values[column]).collect();
        values.sort_by(f64::total_cmp);
        values[values.len() / 2]
    };
    let grown = |column: usize| {
        let early = median(column, &samples[quarter..2 * quarter]);
        let late = median(column, &samples[samples.len() - quarter..]);
        let limit = early + NOISE[column].max(early / 10.0);
        let name = Sample::COLUMNS[column];
        (late > limit).then(|| format!("{name} has grown: median {early:.0}, then {late:.0}"))
    };
    (0..Sample::COLUMNS.len()).filter_map(grown).collect()
}

/// Space that a file takes, KiB.
fn blocks_kib(path: &Path) -> f64 {
    use std::os::unix::fs::MetadataExt;
    fs::metadata(path).map_or(0.0, |meta| meta.blocks() as f64 / 2.0)
}

fn folder_kib(folder: &Path) -> f64 {
    let Ok(entries) = fs::read_dir(folder) else { return 0.0 };
    entries.filter_map(Result::ok).map(|entry| blocks_kib(&entry.path())).sum()
}

fn print(line: &str) {
    // A closed pipe is the reader's choice.
    let _ = writeln!(std::io::stdout(), "{line}");
}
