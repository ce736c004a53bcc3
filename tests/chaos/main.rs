//! Random faults on real processes, while a simulated user has one object after another fetched.
//!
//! Every dialogue must end with the right object picked once, and the journals must fold again to
//! the same belief. Prints the seed and what was done; exit code 70 on a broken invariant.

use clap::Parser;
use dialogue::Rng;
use messages::Service;
use rustix::process::Signal;
use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use whichone_tests::Group;

const BOWLS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];

/// Random faults on real processes while dialogues run
#[derive(Parser)]
#[command(name = "chaos")]
struct Plan {
    /// Stop after so many minutes
    #[arg(long, value_name = "N")]
    minutes: Option<u64>,
    /// Stop after so many kills [200, unless --minutes is given]
    #[arg(long, value_name = "N")]
    kills: Option<u64>,
    /// Seed of all faults; a random one unless given
    #[arg(long, value_name = "S", default_value_t = random_seed(), hide_default_value = true)]
    seed: u64,
}

fn random_seed() -> u64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(1, |t| u64::from(t.subsec_nanos()))
}

impl Plan {
    fn kills_max(&self) -> u64 {
        self.kills.unwrap_or(if self.minutes.is_some() { u64::MAX } else { 200 })
    }
}

/// Counts of the injected faults.
#[derive(Debug, Default)]
struct Counters {
    dialogues: u64,
    kills: [u64; Service::BUILT_IN.len()],
    pauses: u64,
    restarts: u64,
}

impl Counters {
    fn kills(&self) -> u64 {
        self.kills.iter().sum()
    }
}

fn main() -> ExitCode {
    let plan = match Plan::try_parse() {
        Ok(plan) => plan,
        Err(error) => {
            print(&error.to_string());
            return ExitCode::from(if error.use_stderr() { 64 } else { 0 });
        }
    };
    print(&format!("seed {}", plan.seed));
    let ran = std::panic::catch_unwind(|| run(&plan));
    match ran {
        Ok(counters) => {
            print(&format!("{counters:?}: every dialogue ended with the right single pick"));
            ExitCode::SUCCESS
        }
        Err(_) => {
            print(&format!("broken; repeat with: scripts/chaos --seed {}", plan.seed));
            ExitCode::from(70)
        }
    }
}

fn print(line: &str) {
    // A closed pipe is the reader's choice.
    let _ = writeln!(std::io::stdout(), "{line}");
}

fn run(plan: &Plan) -> Counters {
    let mut rng = Rng::new(plan.seed);
    let group = Group::up(&["arm.time_scale=20.0"]);
    let mut counters = Counters::default();
    let until = plan.minutes.map(|n| Instant::now() + Duration::from_secs(60 * n));
    while counters.kills() < plan.kills_max() && until.is_none_or(|until| Instant::now() < until) {
        let bowl = BOWLS[rng.below(BOWLS.len())];
        dialogue(&group, bowl, plan, &mut rng, &mut counters);
        counters.dialogues += 1;
        if counters.dialogues.is_multiple_of(10) {
            print(&format!("{counters:?}"));
        }
    }
    group.verify_journals();
    group.down();
    counters
}

/// One dialogue with faults until its end.
fn dialogue(group: &Group, bowl: &str, plan: &Plan, rng: &mut Rng, counters: &mut Counters) {
    let over = AtomicBool::new(false);
    let outcome = std::thread::scope(|scope| {
        let person = scope.spawn(|| {
            let outcome = group.fetch("get me the bowl", bowl);
            over.store(true, Ordering::SeqCst);
            outcome
        });
        while !over.load(Ordering::SeqCst) && !person.is_finished() {
            std::thread::sleep(Duration::from_millis(10 + rng.below(250) as u64));
            if counters.kills() < plan.kills_max() {
                fault(group, rng, counters);
            }
        }
        person.join().expect("the person gets an outcome")
    });
    assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", group.logs());
    assert_eq!(outcome["object"], bowl, "{outcome}\n{}", group.logs());
}

/// Mostly kills; now and then a pause below the watchdog, or an orderly restart.
fn fault(group: &Group, rng: &mut Rng, counters: &mut Counters) {
    let which = rng.below(Service::BUILT_IN.len());
    let service = Service::BUILT_IN[which].name();
    match rng.below(10) {
        0 => {
            group.signal(service, Signal::STOP);
            std::thread::sleep(Duration::from_millis(100));
            group.signal(service, Signal::CONT);
            counters.pauses += 1;
        }
        1 => {
            let _ = group.call(&["restart", service]);
            counters.restarts += 1;
        }
        _ => {
            group.signal(service, Signal::KILL);
            counters.kills[which] += 1;
        }
    }
}
