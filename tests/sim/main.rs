//! All services as one simulated group, with faults drawn from a seed: messages lost and doubled,
//! processes killed between any two effects and in the middle of a write, clients and whole groups
//! killed, disks full. The right object must be delivered once, and the journals must agree.
//!
//! A failing seed is printed; `WHICHONE_SEED=N cargo test -p whichone-tests --test sim` repeats it,
//! and `WHICHONE_SEEDS=N` runs that many instead of the usual number. Many, on all cores:
//!
//! ```text
//! WHICHONE_SEEDS=100000 cargo test --release -p whichone-tests --test sim -- --ignored --nocapture
//! ```
//!
//! with `WHICHONE_FIRST=S` from another seed on.

mod bad_days;
mod checkers;
mod forged;
mod haste;
mod objects;
mod turns;

use config::Settings;
use whichone_tests::simulated_group::{Faults, GroupUser, SimulatedGroup};
use whichone_tests::{number, settings};

/// Dialogues with faults, each with its own seed; WHICHONE_SEEDS asks for more.
const SEEDS: u64 = 40;

fn seeds(count: u64) -> Vec<u64> {
    match number("WHICHONE_SEED") {
        Some(seed) => vec![seed],
        None => (0..number("WHICHONE_SEEDS").unwrap_or(count)).collect(),
    }
}

fn run(seed: u64, faults: Faults) {
    let user = GroupUser::typing((seed % 6) as usize);
    run_with(seed, SimulatedGroup::new(settings(&[]), user, faults));
}

fn run_with(seed: u64, mut group: SimulatedGroup) {
    group.run();
    if let Err(broken) = checkers::check(&group, &[]) {
        let wanted = group.user.wanted();
        panic!("seed {seed}, wanted {wanted:?}: {broken}\n{}", group.story());
    }
}

#[test]
fn group_without_faults_delivers_every_object() {
    (0..6).for_each(|seed| run(seed, Faults::none()));
}

#[test]
fn group_with_kills_delivers_the_right_object_once() {
    seeds(SEEDS).into_iter().for_each(|seed| run(seed, Faults::kills(seed)));
}

#[test]
fn group_with_a_lossy_bus_delivers_the_right_object_once() {
    seeds(SEEDS / 2).into_iter().for_each(|seed| run(seed, Faults::losses(seed)));
}

#[test]
fn group_with_kills_and_losses_delivers_the_right_object_once() {
    seeds(SEEDS).into_iter().for_each(|seed| run(seed, Faults::everything(seed)));
}

#[test]
fn group_repeats_its_story_with_its_seed() {
    let story = |seed| {
        let faults = Faults::everything(seed);
        let mut group = SimulatedGroup::new(settings(&[]), GroupUser::typing(3), faults);
        group.run();
        group.story()
    };
    assert_eq!(story(42), story(42));
}

/// The shipped bowls without `gone`, and with one more that stands in its place.
fn changed_bowls(gone: &str) -> Settings {
    let folder = tempfile::tempdir().expect("a folder");
    let shipped = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/scenes/bowls.toml");
    let text = std::fs::read_to_string(shipped).expect("the shipped bowls");
    let renamed = text.replace(&format!("name = \"{gone}\"\n"), "name = \"another\"\n");
    // The first object becomes the last, so that every number changes.
    let (head, objects) = text_at(&renamed, "[[objects]]");
    let (first, others) = text_at(&objects["[[objects]]".len()..], "[[objects]]");
    let path = folder.path().join("changed.toml");
    std::fs::write(&path, format!("{head}{others}\n[[objects]]{first}")).expect("a file");
    settings(&[("group.scene", path.to_str().expect("a path"))])
}

fn text_at<'a>(text: &'a str, mark: &str) -> (&'a str, &'a str) {
    text.split_at(text.find(mark).expect("objects"))
}

#[test]
fn reload_under_faults_keeps_the_right_object() {
    let bowls = ["white", "white2", "white3", "metal", "metal2", "clear"];
    let scenes = bowls.map(changed_bowls);
    for seed in seeds(SEEDS / 2) {
        let wanted = (seed % 6) as usize;
        let gone = (wanted + 1 + (seed / 6 % 5) as usize) % 6;
        let group =
            SimulatedGroup::new(settings(&[]), GroupUser::typing(wanted), Faults::everything(seed));
        run_with(seed, group.with_change(scenes[gone].clone()));
    }
}

#[test]
fn every_kind_of_dialogue_delivers_the_right_object_once_under_faults() {
    let pointing = [("dialogue.gesture.enabled", "true")];
    let absence = [("dialogue.prior.absent", "0.05"), ("dialogue.prior.objects", "history")];
    let seeking = [("dialogue.planner", "information-seeking"), ("dialogue.prior.absent", "0.02")];
    for (over, user, count) in [
        (&pointing[..], GroupUser::pointing as fn(usize) -> GroupUser, SEEDS / 2),
        (&absence, GroupUser::typing, SEEDS / 8),
        (&seeking, GroupUser::typing, SEEDS / 8),
    ] {
        for seed in seeds(count) {
            let user = user((seed % 6) as usize);
            run_with(seed, SimulatedGroup::new(settings(over), user, Faults::everything(seed)));
        }
    }
}
