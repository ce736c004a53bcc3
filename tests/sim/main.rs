//! The real reducers of all services in one thread, with a simulated bus, voice, clock and person,
//! and faults drawn from a seed: messages lost and doubled, processes killed between any two
//! effects. Whatever happens, the right object is delivered once and the journals agree.
//!
//! A failing seed is printed; `WHICHONE_SEED=N cargo test -p whichone-tests --test sim` repeats it.

mod checkers;
mod faults;
mod host;
mod person;
mod world;

use faults::Faults;
use world::World;

/// Dialogues with faults, each with its own seed.
const SEEDS: u64 = 120;

fn seeds(count: u64) -> Vec<u64> {
    match std::env::var("WHICHONE_SEED") {
        Ok(seed) => vec![seed.parse().expect("WHICHONE_SEED is a number")],
        Err(_) => (0..count).collect(),
    }
}

fn run(seed: u64, faults: Faults) {
    let wanted = (seed % 6) as usize;
    let mut world = World::new(seed, wanted, faults);
    world.run();
    if let Err(broken) = checkers::check(&world) {
        panic!("seed {seed}, wanted object {wanted}: {broken}\n{}", world.story());
    }
}

#[test]
fn without_faults_every_object_is_delivered() {
    (0..6).for_each(|seed| run(seed, Faults::none()));
}

#[test]
fn with_kills_the_right_object_is_delivered_once() {
    seeds(SEEDS).into_iter().for_each(|seed| run(seed, Faults::kills(seed)));
}

#[test]
fn with_a_lossy_bus_the_right_object_is_delivered_once() {
    seeds(SEEDS / 2).into_iter().for_each(|seed| run(seed, Faults::losses(seed)));
}

#[test]
fn with_kills_and_losses_together_too() {
    seeds(SEEDS).into_iter().for_each(|seed| run(seed, Faults::everything(seed)));
}

#[test]
fn the_same_seed_tells_the_same_story() {
    let story = |seed| {
        let mut world = World::new(seed, 3, Faults::everything(seed));
        world.run();
        world.story()
    };
    assert_eq!(story(42), story(42));
}
