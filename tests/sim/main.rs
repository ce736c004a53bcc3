//! The real reducers of all services in one thread, with a simulated bus, voice, clock and person,
//! and faults drawn from a seed: messages lost and doubled, processes killed between any two
//! effects. Whatever happens, the right object is delivered once and the journals agree.
//!
//! A failing seed is printed; `WHICHONE_SEED=N cargo test -p whichone-tests --test sim` repeats it,
//! and `WHICHONE_SEEDS=N` runs as many instead of the usual number.

mod checkers;
mod faults;
mod person;
mod turns;
mod world;

use config::Settings;
use faults::Faults;
use person::Person;
use whichone_tests::settings;
use world::World;

/// Dialogues with faults, each with its own seed.
const SEEDS: u64 = 120;

fn number(variable: &str) -> Option<u64> {
    let text = std::env::var(variable).ok()?;
    Some(text.parse().unwrap_or_else(|_| panic!("{variable} is a number")))
}

fn seeds(count: u64) -> Vec<u64> {
    match number("WHICHONE_SEED") {
        Some(seed) => vec![seed],
        None => (0..number("WHICHONE_SEEDS").unwrap_or(count)).collect(),
    }
}

fn run(seed: u64, faults: Faults) {
    let person = Person::new((seed % 6) as usize);
    run_with(seed, World::new(settings(&[]), person, faults));
}

fn run_with(seed: u64, mut world: World) {
    world.run();
    if let Err(broken) = checkers::check(&world) {
        let wanted = world.person.wanted;
        panic!("seed {seed}, wanted {wanted:?}: {broken}\n{}", world.story());
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
        let mut world = World::new(settings(&[]), Person::new(3), Faults::everything(seed));
        world.run();
        world.story()
    };
    assert_eq!(story(42), story(42));
}

#[test]
fn whoever_points_gets_the_right_object_once_whatever_is_killed() {
    for seed in seeds(SEEDS / 2) {
        let settings = settings(&[("dialogue.gesture.enabled", "true")]);
        let person = Person::pointing((seed % 6) as usize, &settings.scene);
        run_with(seed, World::new(settings, person, Faults::everything(seed)));
    }
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
fn under_a_changing_scene_the_right_object_is_delivered_once_whatever_is_killed() {
    let bowls = ["white", "white2", "white3", "metal", "metal2", "clear"];
    let scenes = bowls.map(changed_bowls);
    for seed in seeds(SEEDS / 2) {
        let wanted = (seed % 6) as usize;
        let gone = (wanted + 1 + (seed / 6 % 5) as usize) % 6;
        let world = World::new(settings(&[]), Person::new(wanted), Faults::everything(seed));
        run_with(seed, world.with_change(scenes[gone].clone()));
    }
}

/// A robot that considers that the object is not here still fetches what is.
#[test]
fn where_it_may_be_absent_the_right_object_is_delivered_all_the_same() {
    let over = [("dialogue.prior.absent", "0.05"), ("dialogue.prior.objects", "history")];
    for seed in seeds(SEEDS / 8) {
        let person = Person::new((seed % 6) as usize);
        run_with(seed, World::new(settings(&over), person, Faults::everything(seed)));
    }
}

/// What is learned about the person changes nothing about who gets what.
#[test]
fn a_robot_that_learns_about_the_person_delivers_the_right_object_once() {
    let over = [("dialogue.planner", "information-seeking"), ("dialogue.prior.absent", "0.02")];
    for seed in seeds(SEEDS / 8) {
        let person = Person::new((seed % 6) as usize);
        run_with(seed, World::new(settings(&over), person, Faults::everything(seed)));
    }
}
