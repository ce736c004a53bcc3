//! Objects from perception: the right one is fetched from where it is, whatever appears, moves or
//! vanishes meanwhile.

use whichone_tests::number;
use whichone_tests::simulated_group::{Faults, Tally, at_best, detect, perceive};

const DIALOGUES: u64 = 20;

/// `right_min` is the least share of dialogues with the wanted object.
fn check(mode: &str, right_min: f64) -> Tally {
    let seed = number("WHICHONE_SEED").unwrap_or(1);
    let dialogues = number("WHICHONE_SEEDS").unwrap_or(DIALOGUES);
    let found = perceive(mode, dialogues, seed, |_| Faults::none());
    let stories = || found.stories.join("\n\n");
    assert_eq!((found.beside, found.twice), (0, 0), "seed {seed}: {}", stories());
    let right = found.right as f64 / found.dialogues as f64;
    assert!(right >= right_min, "seed {seed}: {right}\n{}", stories());
    Tally { stories: Vec::new(), ..found }
}

#[test]
fn perceived_objects_are_fetched_from_where_they_are() {
    println!("{:?}", check("present", 0.98));
}

/// Without pointing, a camera that takes an object for what it is not misleads every answer.
#[test]
fn perceived_objects_are_fetched_for_a_user_in_another_room() {
    println!("{:?}", check("remote", 0.95));
}

/// Even if the robot knew every value of the wanted bowl, it would take another one where the camera has
/// mistaken both. That bounds what answers can achieve without pointing.
#[test]
fn perceived_objects_that_the_camera_mistakes_bound_what_answers_achieve() {
    let share = at_best(20_000, number("WHICHONE_SEED").unwrap_or(1));
    println!("right at best, every value known: {:.2} %", 100.0 * share);
    assert!((0.98..0.99).contains(&share), "{share}");
}

/// Questions of a dialogue under a noisy detector, on average.
const QUESTIONS_MAX: f64 = 4.0;

#[expect(clippy::print_stderr, reason = "the figures of this measure")]
fn check_noisy(dialogues: u64) {
    let seed = number("WHICHONE_SEED").unwrap_or(1);
    let found = detect(number("WHICHONE_SEEDS").unwrap_or(dialogues), seed);
    let Tally { dialogues, right, questions, questions_certain, beside, worst_m, .. } = found;
    let [asked, certain] = [questions, questions_certain].map(|it| it as f64 / dialogues as f64);
    eprintln!(
        "seed {seed}: {right} of {dialogues} right, {asked:.2} questions, of a certain scene {certain:.2}; \
         grasps at most {:.1} mm off",
        1e3 * worst_m
    );
    assert_eq!((right, beside), (dialogues, 0), "seed {seed}: {}", found.stories.join("\n\n"));
    assert!(asked <= QUESTIONS_MAX, "seed {seed}: {asked} questions");
}

#[test]
fn noisy_detector_costs_no_wrong_object_and_few_questions() {
    check_noisy(12);
}

#[test]
fn noisy_detector_costs_no_wrong_object_in_sixty_dialogues() {
    check_noisy(60);
}
