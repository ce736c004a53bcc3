//! Random faults on real processes, while a simulated user has one object after another fetched.
//!
//! Every dialogue must end with the right object picked, and the journals must fold again to the
//! same belief. Prints the seed, the counts of faults and the times of recovery; exit code 70 on a
//! broken invariant.

mod between;
mod during;
mod kind;
mod machine;
mod person;
mod tally;

use clap::Parser;
use kind::Kind;
use machine::Machine;
use std::io::Write;
use std::process::ExitCode;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tally::Tally;
use vocabulary::Rng;

const BOWLS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];

/// Random faults on real processes while dialogues run
#[derive(Parser)]
#[command(name = "chaos")]
struct Plan {
    /// Stop after so many minutes
    #[arg(long, value_name = "N")]
    minutes: Option<u64>,
    /// Stop after so many kills [200, unless --minutes or --dialogues is given]
    #[arg(long, value_name = "N")]
    kills: Option<u64>,
    /// Stop after so many dialogues
    #[arg(long, value_name = "N")]
    dialogues: Option<u64>,
    /// Kinds of faults; all but clock-step unless given
    #[arg(long, value_name = "KIND,…", value_enum, value_delimiter = ',')]
    kinds: Vec<Kind>,
    /// Seed of all faults; a random one unless given
    #[arg(long, value_name = "S", default_value_t = random_seed(), hide_default_value = true)]
    seed: u64,
}

fn random_seed() -> u64 {
    let now = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    now.map_or(1, |t| u64::from(t.subsec_nanos()))
}

impl Plan {
    fn is_over(&self, tally: &Tally, started: Instant) -> bool {
        let unbounded = self.minutes.is_none() && self.dialogues.is_none();
        let kills_max = self.kills.or(unbounded.then_some(200));
        kills_max.is_some_and(|max| tally.kills() >= max)
            || self.dialogues.is_some_and(|max| tally.dialogues >= max)
            || self.minutes.is_some_and(|n| started.elapsed() >= Duration::from_secs(60 * n))
    }

    /// The kinds that were asked for; all that leave the rest of the machine alone by default.
    fn kinds(&self) -> Vec<Kind> {
        match self.kinds.is_empty() {
            true => Kind::ALL.into_iter().filter(|&kind| kind != Kind::ClockStep).collect(),
            false => self.kinds.clone(),
        }
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
    machine::enter_own_mounts();
    whichone_tests::end_with_groups();
    print(&format!("seed {}", plan.seed));
    let mut tally = Tally::default();
    let ran = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| run(&plan, &mut tally)));
    print(&tally.to_string());
    match ran {
        Ok(()) => {
            print("every dialogue ended with the right pick, and the journals verify");
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

fn run(plan: &Plan, tally: &mut Tally) {
    let started = Instant::now();
    let mut rng = Rng::new(plan.seed);
    let mut machine = Machine::start();
    let (possible, left_out): (Vec<Kind>, Vec<Kind>) =
        plan.kinds().into_iter().partition(|kind| machine.allows(*kind));
    if !left_out.is_empty() {
        print(&format!("not on this machine (needs root and mounts): {left_out:?}"));
    }
    let (during, between): (Vec<Kind>, Vec<Kind>) =
        possible.into_iter().partition(|kind| kind.is_during_dialogue());
    while !plan.is_over(tally, started) {
        dialogue(plan, &machine, &during, &mut rng, tally);
        if !between.is_empty() && rng.below(5) == 0 {
            let kind = kind::draw(&between, &mut rng);
            tally.faults.entry(kind).and_modify(|n| *n += 1).or_insert(1);
            between::inject(kind, &mut machine, &mut rng, tally);
        }
        if tally.dialogues.is_multiple_of(10) {
            print(&tally.to_string());
        }
    }
    machine.group.verify_journals();
    machine.end();
}

/// One dialogue with faults until its end.
fn dialogue(plan: &Plan, machine: &Machine, kinds: &[Kind], rng: &mut Rng, tally: &mut Tally) {
    let bowl = BOWLS[rng.below(BOWLS.len())];
    let over = AtomicBool::new(false);
    let client = person::Client::default();
    let outcome = std::thread::scope(|scope| {
        let person = scope.spawn(|| {
            // Set whatever happens, so that no further fault is injected.
            let _over = OnDrop(&over);
            person::fetch(&machine.group, bowl, &client)
        });
        while !over.load(Ordering::SeqCst) && !person.is_finished() {
            std::thread::sleep(Duration::from_millis(10 + rng.below(250) as u64));
            let enough = plan.kills.is_some_and(|max| tally.kills() >= max);
            if !kinds.is_empty() && !enough && !over.load(Ordering::SeqCst) {
                let kind = kind::draw(kinds, rng);
                tally.faults.entry(kind).and_modify(|n| *n += 1).or_insert(1);
                during::inject(kind, machine, &client, rng, tally);
            }
        }
        person.join().expect("the person gets an outcome")
    });
    assert_eq!(outcome["outcome"], "delivered", "{outcome}\n{}", machine.group.logs());
    assert_eq!(outcome["object"], bowl, "{outcome}\n{}", machine.group.logs());
    tally.dialogues += 1;
}

struct OnDrop<'a>(&'a AtomicBool);

impl Drop for OnDrop<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::SeqCst);
    }
}
