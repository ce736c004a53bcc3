//! A user at a terminal has several objects fetched while everything fails: every process dies at
//! every point, writes are torn, disks are full, the client and the whole group are killed. Once the
//! faults stop, a user who is willing to answer gets the right objects, each once, and is not given up
//! while able to answer.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use config::Settings;
use messages::{PickOutcome, PickPhase};
use scene::ObjectId;
use service::Span;
use whichone_tests::simulated_group::{Fault, Faults, SimulatedGroup};
use whichone_tests::{number, settings};

use crate::checkers;

/// Dialogues of the short run.
const SEEDS: u64 = 40;
/// Seeds that once failed: with a wrong object twice, with a healthy journal refused, and with a client
/// that was dead while the robot waited.
const FOUND: [u64; 4] = [1_157, 15_525, 22_154, 3_156];

/// Objects that the user wants one after another.
fn wanted(seed: u64) -> [usize; 2] {
    let first = (seed % 6) as usize;
    [first, (first + 1 + (seed / 6 % 5) as usize) % 6]
}

/// Whether the user has the first object put back.
fn regrets(seed: u64) -> bool {
    seed.is_multiple_of(4)
}

/// Runs the dialogues of one seed and returns the faults that there were.
fn run(settings: &Settings, seed: u64) -> Result<BTreeMap<Fault, u64>, String> {
    let wanted = wanted(seed);
    let faults = Faults::bad_day(seed);
    let mut group = SimulatedGroup::with_client(settings.clone(), &wanted, regrets(seed), faults);
    let ran = catch_unwind(AssertUnwindSafe(|| group.run()));
    let broken = match ran {
        Ok(()) => checkers::check(&group, &wanted.map(ObjectId::from)).err(),
        Err(_) => Some("a panic, printed above".to_owned()),
    };
    match broken {
        None => Ok(group.faults.counts),
        Some(broken) => Err(format!("seed {seed}: {broken}\n{}", group.story())),
    }
}

#[test]
fn willing_user_gets_every_object_on_a_bad_day() {
    let settings = settings(&[]);
    let failed: Vec<String> = crate::seeds(SEEDS)
        .into_iter()
        .chain(FOUND)
        .filter_map(|seed| run(&settings, seed).err())
        .collect();
    assert!(failed.is_empty(), "{} seeds failed; the first:\n{}", failed.len(), failed[0]);
}

/// Called off at any moment of the fetch, the object is left, goes back, or was let go of before; whoever
/// asks for it again gets it.
#[test]
fn what_is_called_off_on_a_bad_day_stays_unless_the_gripper_had_opened() {
    // A fetch of about two seconds.
    let settings = settings(&[("arm.time_scale", "5.0")]);
    let (mut left, mut returned, mut delivered) = (0, 0, 0);
    // Each of 20 moments, some of them twice.
    for seed in crate::seeds(28) {
        let wanted = wanted(seed);
        let after = Span::from_ms(100 * (seed % 20));
        let faults = Faults::bad_day(seed);
        let mut group = SimulatedGroup::with_client(settings.clone(), &wanted, false, faults)
            .calling_off(after);
        group.run();
        if let Err(broken) = checkers::check(&group, &wanted.map(ObjectId::from)) {
            panic!("seed {seed}: {broken}\n{}", group.story());
        }
        let picks = group.arm.iter().flat_map(|arm| arm.journal()).filter_map(|it| it.state.pick);
        let first: Vec<_> = picks.take_while(|pick| pick.id.interaction.0 == 1).collect();
        let goes_back = first.iter().any(|pick| pick.phase == PickPhase::Returning);
        match first.last().map(|pick| pick.outcome) {
            Some(PickOutcome::Delivered) => delivered += 1,
            _ if goes_back => returned += 1,
            _ => left += 1,
        }
    }
    let counts = format!("{left} left, {returned} returned, {delivered} delivered");
    assert!(number("WHICHONE_SEED").is_some() || left.min(returned).min(delivered) > 0, "{counts}");
}

#[test]
#[ignore = "minutes to hours: for a long run by hand"]
fn willing_user_gets_every_object_on_many_bad_days() {
    let first = number("WHICHONE_FIRST").unwrap_or(0);
    let count = number("WHICHONE_SEEDS").unwrap_or(100_000);
    let settings = settings(&[]);
    let (next, done) = (AtomicU64::new(first), AtomicU64::new(0));
    let results = Mutex::new((BTreeMap::<Fault, u64>::new(), Vec::<String>::new()));
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= first + count {
                return;
            }
            let ran = run(&settings, seed);
            let mut results = results.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            match ran {
                Ok(counts) => counts.into_iter().for_each(|(fault, n)| {
                    *results.0.entry(fault).or_default() += n;
                }),
                Err(failed) => results.1.push(failed),
            }
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            if done.is_multiple_of(1_000) {
                report(done, &results);
            }
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..threads).for_each(|_| drop(scope.spawn(work))));
    let results = results.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    report(count, &results);
    assert!(results.1.is_empty(), "{} seeds failed; the first:\n{}", results.1.len(), results.1[0]);
}

fn report(done: u64, (faults, failed): &(BTreeMap<Fault, u64>, Vec<String>)) {
    use std::io::Write;
    // A closed pipe is the reader's choice.
    let _ = writeln!(std::io::stdout(), "{done} seeds, {} failed, faults {faults:?}", failed.len());
    for story in failed.iter().take(3) {
        let _ = writeln!(std::io::stdout(), "  {}", story.lines().next().unwrap_or_default());
    }
}
