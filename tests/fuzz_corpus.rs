//! The fuzz targets on stable: the kept corpus, the seeds, and mutations of both.
//!
//! A failing input is printed with the seed of its mutation and written to the folder `target/tmp`; put it into
//! `tests/fixtures/fuzz/TARGET` once its cause is mended.
//! `WHICHONE_SEED=N` sets the seed and `WHICHONE_MUTATIONS=N` the number of mutations.

#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "tests")]

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use whichone_tests::fuzz::{self, Mutator, Target};
use whichone_tests::number;

fn check(target: &Target, origin: &str, input: &[u8]) {
    let run = AssertUnwindSafe(|| (target.run)(input));
    if catch_unwind(run).is_err() {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let file = folder.join(format!("fuzz-{}.input", target.name));
        std::fs::write(&file, input).unwrap();
        panic!("target {}, {origin}: fails on {}", target.name, file.display());
    }
}

fn replay(name: &str) {
    let target = fuzz::target(name).unwrap();
    let kept = target.kept();
    assert!(!kept.is_empty(), "no corpus in {}", target.corpus().display());
    kept.iter().for_each(|(file, input)| check(target, file, input));
    let mut inputs = (target.seeds)();
    let seeds = inputs.iter().enumerate();
    seeds.for_each(|(n, input)| check(target, &format!("valid input {n}"), input));
    inputs.extend(kept.into_iter().map(|(_, input)| input));
    let seed = number("WHICHONE_SEED").unwrap_or(13);
    let count = number("WHICHONE_MUTATIONS").unwrap_or(target.mutations as u64);
    println!("target {name}: {} inputs, {count} mutations, seed {seed}", inputs.len());
    let mut mutator = Mutator::new(seed);
    for n in 0..count {
        let input = mutator.next(&inputs);
        check(target, &format!("mutation {n} of seed {seed}"), &input);
    }
}

macro_rules! targets {
    ($($test:ident $name:literal)+) => {
        $(#[test]
        fn $test() {
            replay($name);
        })+

        #[test]
        fn every_target_is_replayed() {
            let known: Vec<&str> = fuzz::TARGETS.iter().map(|target| target.name).collect();
            assert_eq!(known, [$($name),+]);
        }
    };
}

targets! {
    journals_with_any_damage "journal"
    journals_of_any_records "records"
    flights_with_any_damage "flight"
    fixed_messages "wire"
    encoded_payloads "payload"
    forged_messages_between_services "peers"
    configuration_files "config"
    scene_files "scene"
    robot_descriptions "robot"
    messages_and_calls_of_ros_1 "ros1"
    sound_files "wav"
    messages_of_browsers "console"
    control_requests "control"
    lines_of_detectors "detections"
    spoken_and_typed_text "language"
    events_of_speech_servers "wyoming"
}
