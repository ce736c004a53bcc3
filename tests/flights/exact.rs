//! Random dialogues, with and without faults, replay exactly.

use config::Settings;
use whichone_tests::settings;
use whichone_tests::simulated_group::{Faults, GroupUser, SimulatedGroup};

use crate::replay_all;

/// Dialogues of each kind.
const SEEDS: u64 = 12;

fn seeds() -> Vec<u64> {
    let number = |name| std::env::var(name).ok().map(|text| text.parse().expect("a number"));
    match number("WHICHONE_SEED") {
        Some(seed) => vec![seed],
        None => (0..number("WHICHONE_SEEDS").unwrap_or(SEEDS)).collect(),
    }
}

/// Holds a dialogue and replays its flights.
fn check(seed: u64, group: SimulatedGroup) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut group = group.recorded(folder.path());
    group.run();
    let starts = u64::from(group.speech.incarnation) + u64::from(group.policy.incarnation);
    drop(group);
    let reports = replay_all(folder.path()).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
    let of = |service: &str| reports.iter().filter(|report| report.service == service).count();
    assert_eq!(of("speech") + of("policy"), starts as usize, "seed {seed}");
    let passes: u64 = reports.iter().map(|report| report.passes).sum();
    assert!(passes > 100, "seed {seed}: {passes} passes");
}

fn group(over: &[(&str, &str)], seed: u64, faults: fn(u64) -> Faults) -> SimulatedGroup {
    let settings: Settings = settings(over);
    SimulatedGroup::new(settings, GroupUser::typing((seed % 6) as usize), faults(seed))
}

#[test]
fn dialogue_without_faults_replays_exactly() {
    for seed in seeds() {
        check(seed, group(&[], seed, |_| Faults::none()));
    }
}

#[test]
fn dialogue_under_kills_and_losses_replays_exactly() {
    for seed in seeds() {
        check(seed, group(&[], seed, Faults::everything));
    }
}
