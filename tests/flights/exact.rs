//! Random dialogues, with and without faults, replay exactly.

use config::Settings;
use whichone_tests::simulated_group::{Faults, GroupUser, SimulatedGroup};
use whichone_tests::{number, settings};

use crate::replay_all;

/// Dialogues of each kind.
const SEEDS: u64 = 12;

fn seeds() -> Vec<u64> {
    match number("WHICHONE_SEED") {
        Some(seed) => vec![seed],
        None => (0..number("WHICHONE_SEEDS").unwrap_or(SEEDS)).collect(),
    }
}

/// Holds a dialogue and replays its flights: each start is one, or many of some passes.
fn check(seed: u64, group: SimulatedGroup, passes: u64) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut group = group.recorded(folder.path(), passes);
    group.run();
    let starts = [group.speech.incarnation, group.policy.incarnation].map(|it| it as usize);
    drop(group);
    let reports = replay_all(folder.path()).unwrap_or_else(|e| panic!("seed {seed}: {e}"));
    let of = |service: &str| reports.iter().filter(|report| report.service == service).count();
    match passes {
        u64::MAX => assert_eq!([of("speech"), of("policy")], starts, "seed {seed}"),
        // The arm can be described at rest only, and a dialogue is short.
        _ => {
            let counts = [of("speech"), of("policy"), of("arm")];
            let files: Vec<_> = reports.iter().map(|it| (it.file.file_name(), it.passes)).collect();
            assert!(counts.iter().all(|count| *count > 3), "seed {seed}: {counts:?} {files:?}");
        }
    }
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
        check(seed, group(&[], seed, |_| Faults::none()), u64::MAX);
    }
}

#[test]
fn dialogue_under_kills_and_losses_replays_exactly() {
    for seed in seeds() {
        check(seed, group(&[], seed, Faults::everything), u64::MAX);
    }
}

#[test]
fn flight_that_begins_in_the_middle_of_a_start_replays_exactly() {
    for seed in seeds() {
        check(seed, group(&[], seed, |_| Faults::none()), 1 + seed % 7);
        check(seed, group(&[], seed, Faults::losses), 1 + seed % 7);
    }
}
