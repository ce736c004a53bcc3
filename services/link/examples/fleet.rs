//! Measures a fleet of simulated robots on this machine (scripts/fleet): `fleet N` starts routers
//! and robots, each a process of its own, and prints their cost.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitCode, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use clap::{Args, Parser, Subcommand};
use link::keyring::{self, Wanted};
use link::simulated::{self, Counts, Fleet};
use roster::{Change, Name};
use service::exit::{Exit, Failure};

/// Longest time for everything to be there.
const PATIENCE: Duration = Duration::from_secs(300);
/// Ticks of processor time in a second, as Linux reports them.
const TICKS: f64 = 100.0;
/// Robots of one process.
const ROBOTS_PER_PROCESS: usize = 500;

/// Simulates a fleet of robots and prints its cost.
#[derive(Debug, Parser)]
#[command(
    name = "scripts/fleet",
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true
)]
struct Cli {
    #[command(subcommand)]
    part: Option<Part>,
    #[command(flatten)]
    run: RunArgs,
}

#[derive(Debug, Subcommand)]
enum Part {
    /// Be robots of a fleet (a process of its own, so that its memory is theirs).
    #[command(hide = true)]
    Robots { keys: PathBuf, first: usize, count: usize, spread_s: f64, config: PathBuf },
}

#[derive(Debug, Args)]
struct RunArgs {
    /// Robots.
    #[arg(required = true)]
    robots: Option<usize>,
    /// Routers, among which the robots are divided.
    #[arg(long, default_value_t = 1)]
    routers: usize,
    /// Time over which robots join, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 20.0)]
    spread: f64,
    /// Time for which the fleet is measured at rest, seconds.
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0)]
    rest: f64,
    /// Keep everything running until Ctrl-C, for a look with `whichone fleet` or a gateway.
    #[arg(long)]
    stay: bool,
    /// Folder of the configuration that mirrors of the robots get.
    #[arg(long, value_name = "DIR", default_value = "config")]
    config: PathBuf,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let _log = service::logging::init();
    let done = match cli.part {
        Some(Part::Robots { keys, first, count, spread_s, config }) => {
            be_robots(keys, first..first + count, spread_s, &config)
        }
        None => measure(&cli.run),
    };
    match done {
        Ok(()) => Exit::Ok.code(),
        Err(failure) => {
            let _ = writeln!(std::io::stderr(), "fleet: {failure}");
            failure.exit.code()
        }
    }
}

fn failed(what: &str) -> impl Fn(std::io::Error) -> Failure + use<'_> {
    move |error| Failure::new(Exit::NotReached, format!("{what}: {error}"))
}

fn say(text: &str) -> Result<(), Failure> {
    writeln!(std::io::stdout(), "{text}").map_err(Failure::output)
}

/// Simulates robots until standard input ends.
fn be_robots(
    keys: PathBuf,
    numbers: std::ops::Range<usize>,
    spread_s: f64,
    config: &Path,
) -> Result<(), Failure> {
    let settings = config::Settings::load(config, None, &[])?.snapshot();
    let names = numbers.map(simulated::name).collect::<Result<_, _>>()?;
    let fleet = Fleet { keys, names, spread: Duration::from_secs_f64(spread_s), settings };
    let counts = Arc::new(Counts::default());
    let ending = Arc::clone(&counts);
    std::thread::spawn(move || {
        let _ = std::io::copy(&mut std::io::stdin(), &mut std::io::sink());
        ending.is_ending.store(true, Ordering::Relaxed);
    });
    simulated::run(&fleet, &counts)
}

/// A process that ends with the measurement.
struct Process(Child);

impl Drop for Process {
    fn drop(&mut self) {
        // Its input ends, and then it does.
        drop(self.0.stdin.take());
        let until = Instant::now() + Duration::from_secs(3);
        while Instant::now() < until && matches!(self.0.try_wait(), Ok(None)) {
            std::thread::sleep(Duration::from_millis(20));
        }
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Process {
    /// Resident memory, KiB, and processor time, seconds.
    fn cost(&self) -> (f64, f64) {
        let read = |file: &str| {
            std::fs::read_to_string(format!("/proc/{}/{file}", self.0.id())).unwrap_or_default()
        };
        let status = read("status");
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let rss = line.and_then(|line| line.trim().trim_end_matches(" kB").trim().parse().ok());
        let stat = read("stat");
        let after = stat.rsplit_once(')').map_or("", |(_, after)| after);
        let fields: Vec<f64> =
            after.split_whitespace().skip(11).take(2).filter_map(|it| it.parse().ok()).collect();

        (rss.unwrap_or(0.0), fields.iter().sum::<f64>() / TICKS)
    }
}

fn cost(parts: &[Process]) -> (f64, f64) {
    parts.iter().map(Process::cost).fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1))
}

/// A router with its share of the robots.
struct Site {
    keys: PathBuf,
    numbers: std::ops::Range<usize>,
    router: Option<Process>,
    seen: Seen,
    _watcher: Process,
}

/// What `whichone fleet --watch` reports of one router.
#[derive(Clone, Default)]
struct Seen(Arc<Mutex<(BTreeSet<Name>, BTreeSet<Name>)>>);

impl Seen {
    /// Robots that are connected, and those that have said what they do.
    fn counts(&self) -> (usize, usize) {
        let seen = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        (seen.0.len(), seen.1.len())
    }

    fn take(&self, change: Change) {
        let mut seen = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match change {
            Change::Gone { gone } => {
                seen.0.remove(&gone);
                seen.1.remove(&gone);
            }
            Change::Here { robot, presence } => {
                if presence.is_some() {
                    seen.1.insert(robot.clone());
                }
                seen.0.insert(robot);
            }
        }
    }
}

fn program() -> Result<PathBuf, Failure> {
    let own = std::env::current_exe().map_err(failed("own path"))?;
    let folder = own.parent().and_then(Path::parent).unwrap_or(Path::new("."));
    Ok(folder.join("whichone-link"))
}

fn spawn(command: &mut Command) -> Result<Process, Failure> {
    let name = format!("{command:?}");
    command.stdin(Stdio::piped()).spawn().map(Process).map_err(failed(&name))
}

fn start_router(keys: &Path) -> Result<Process, Failure> {
    spawn(Command::new(program()?).arg("router").arg(keys.join("router")))
}

impl Site {
    /// Makes keys, and starts a router and a watcher.
    fn start(
        folder: &Path,
        number: usize,
        numbers: std::ops::Range<usize>,
    ) -> Result<Self, Failure> {
        let keys = folder.join(format!("site-{number}"));
        let probe = std::net::UdpSocket::bind("[::]:0").map_err(failed("a port"))?;
        let port = probe.local_addr().map_err(failed("a port"))?.port();
        drop(probe);
        let robots = numbers.clone().map(simulated::name).collect::<Result<Vec<_>, _>>()?;
        let ann = Name::new("ann").map_err(|error| Failure::new(Exit::Usage, error.to_string()))?;
        let wanted = Wanted {
            router: Some(format!("localhost:{port}")),
            robots,
            operators: vec![ann],
            ..Wanted::default()
        };
        keyring::init(&keys, &wanted)?;
        let router = start_router(&keys)?;
        let mut watch = Command::new(program()?);
        watch
            .args(["fleet", "--watch", "--keys"])
            .arg(keys.join("people/ann"))
            .stdout(Stdio::piped());
        let mut watcher = spawn(&mut watch)?;
        let seen = Seen::default();
        if let Some(output) = watcher.0.stdout.take() {
            let seen = seen.clone();
            std::thread::spawn(move || {
                for line in BufReader::new(output).lines().map_while(Result::ok) {
                    serde_json::from_str(&line).into_iter().for_each(|change| seen.take(change));
                }
            });
        }
        Ok(Self { keys, numbers, router: Some(router), seen, _watcher: watcher })
    }

    fn robots(&self, spread: f64, config: &Path) -> Result<Vec<Process>, Failure> {
        let own = std::env::current_exe().map_err(failed("own path"))?;
        let starts = self.numbers.clone().step_by(ROBOTS_PER_PROCESS);
        let start = |first: usize| {
            let count = ROBOTS_PER_PROCESS.min(self.numbers.end - first);
            let mut command = Command::new(&own);
            command.arg("robots").arg(self.keys.join("robots"));
            command.args([first.to_string(), count.to_string(), spread.to_string()]).arg(config);
            spawn(&mut command)
        };
        starts.map(start).collect()
    }
}

fn seen(sites: &[Site]) -> (usize, usize) {
    sites
        .iter()
        .map(|site| site.seen.counts())
        .fold((0, 0), |all, one| (all.0 + one.0, all.1 + one.1))
}

/// Waits until `enough` of the counts of connected and of speaking robots; returns the seconds since `began`.
fn wait(
    sites: &[Site],
    began: Instant,
    what: &str,
    enough: impl Fn((usize, usize)) -> bool,
) -> Result<f64, Failure> {
    let until = Instant::now() + PATIENCE;
    loop {
        let now = seen(sites);
        if enough(now) {
            return Ok(began.elapsed().as_secs_f64());
        }
        if Instant::now() > until {
            let what =
                format!("{what}: not within {PATIENCE:?}; {} connected, {} speak", now.0, now.1);
            return Err(Failure::new(Exit::NotReached, what));
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

fn measure(args: &RunArgs) -> Result<(), Failure> {
    let all = args.robots.unwrap_or(0);
    if all == 0 || args.routers == 0 || all < args.routers {
        return Err(Failure::new(Exit::Usage, "expected at least one robot for each router"));
    }
    let folder = tempfile::tempdir().map_err(failed("a temporary folder"))?;
    let began = Instant::now();
    let share = all.div_ceil(args.routers);
    let mut sites = (0..args.routers)
        .map(|number| {
            Site::start(folder.path(), number, number * share..all.min((number + 1) * share))
        })
        .collect::<Result<Vec<_>, _>>()?;
    say(&format!("keys of {all} robots: {:.1} s", began.elapsed().as_secs_f64()))?;
    std::thread::sleep(Duration::from_secs(2));
    let empty = routers(&sites);

    let began = Instant::now();
    let robots = sites
        .iter()
        .map(|site| site.robots(args.spread, &args.config))
        .collect::<Result<Vec<_>, _>>()?;
    let robots: Vec<Process> = robots.into_iter().flatten().collect();
    wait(&sites, began, "robots that are connected", |(connected, _)| connected == all)?;
    let joined = began.elapsed().as_secs_f64();
    let joining = routers(&sites).1 - empty.1;
    wait(&sites, began, "robots that speak", |(_, speaking)| speaking == all)?;
    say(&format!(
        "joined over {:.0} s: all {all} connected after {joined:.1} s, router {:.2} ms of processor for each",
        args.spread,
        1e3 * joining / all as f64
    ))?;

    rest(args, all, &sites, &robots, empty)?;
    list(all, &sites)?;
    let mut kill = |index: usize| drop(sites[index].router.take());
    (0..args.routers).for_each(&mut kill);
    let began = Instant::now();
    wait(&sites, began, "robots that are gone", |(connected, _)| connected == 0)?;
    let noticed = began.elapsed().as_secs_f64();
    let began = Instant::now();
    for site in &mut sites {
        site.router = Some(start_router(&site.keys)?);
    }
    let half = wait(&sites, began, "half of the robots", |(connected, _)| 2 * connected >= all)?;
    let back = wait(&sites, began, "robots after a restart", |(connected, _)| connected == all)?;
    let speak = wait(&sites, began, "robots after a restart", |(_, speaking)| speaking == all)?;
    let cpu = routers(&sites).1;
    say(&format!(
        "router killed: noticed after {noticed:.1} s; started again: half back after {half:.1} s, all after {back:.1} s, \
         all speak after {speak:.1} s, router {:.2} ms of processor for each",
        1e3 * cpu / all as f64
    ))?;
    list(all, &sites)?;
    if args.stay {
        stay(&sites)?;
    }
    drop(robots);
    Ok(())
}

fn routers(sites: &[Site]) -> (f64, f64) {
    let costs = sites.iter().filter_map(|site| site.router.as_ref()).map(Process::cost);
    costs.fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1))
}

/// Measures the fleet while nobody mirrors a robot and one watcher has the list.
fn rest(
    args: &RunArgs,
    all: usize,
    sites: &[Site],
    robots: &[Process],
    empty: (f64, f64),
) -> Result<(), Failure> {
    let (before, began) = ((routers(sites), cost(robots)), Instant::now());
    std::thread::sleep(Duration::from_secs_f64(args.rest));
    let (after, seconds) = ((routers(sites), cost(robots)), began.elapsed().as_secs_f64());
    let (router, robot) = (after.0.1 - before.0.1, after.1.1 - before.1.1);
    let connected = seen(sites).0;
    let mut text = String::new();
    // A string takes everything.
    let _ = write!(
        text,
        "at rest for {seconds:.0} s, presence every 5 s, {connected} of {all} connected:\n\
         \x20 router: {:.1} MB ({:.0} KB a robot), {:.1} % of a core ({:.3} ms a robot and second)\n\
         \x20 robots: {:.0} KB of memory each, {:.1} % of a core in all ({:.3} ms a robot and second)",
        after.0.0 / 1e3,
        (after.0.0 - empty.0) / all as f64,
        1e2 * router / seconds,
        1e3 * router / seconds / all as f64,
        after.1.0 / all as f64,
        1e2 * robot / seconds,
        1e3 * robot / seconds / all as f64,
    );
    say(&text)
}

/// Lists the robots with `whichone fleet`, as a person would, at each router at once.
fn list(all: usize, sites: &[Site]) -> Result<(), Failure> {
    let began = Instant::now();
    let program = program()?;
    let lists = sites.iter().map(|site| {
        let mut command = Command::new(&program);
        command.args(["fleet", "--json", "--keys"]).arg(site.keys.join("people/ann"));
        command
            .stdout(Stdio::piped())
            .stdin(Stdio::null())
            .spawn()
            .map_err(failed("whichone fleet"))
    });
    let lists = lists.collect::<Result<Vec<_>, _>>()?;
    let (mut listed, mut speaking) = (0, 0);
    for list in lists {
        let output = list.wait_with_output().map_err(failed("whichone fleet"))?;
        let printed: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        let robots = printed["robots"].as_array().cloned().unwrap_or_default();
        listed += robots.len();
        speaking += robots.iter().filter(|robot| !robot["presence"].is_null()).count();
    }
    say(&format!(
        "whichone fleet: {listed} of {all} listed, {speaking} with their state, in {:.2} s",
        began.elapsed().as_secs_f64()
    ))
}

fn stay(sites: &[Site]) -> Result<(), Failure> {
    for site in sites {
        say(&format!("export WHICHONE_KEYS={}", site.keys.join("people/ann").display()))?;
    }
    say("running until Ctrl-C")?;
    let is_ending = Arc::new(AtomicBool::new(false));
    for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
        signal_hook::flag::register(signal, Arc::clone(&is_ending)).map_err(failed("signals"))?;
    }
    while !is_ending.load(Ordering::Relaxed) {
        std::thread::sleep(Duration::from_millis(100));
    }
    Ok(())
}
