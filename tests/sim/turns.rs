//! Answers that come late, early, into the next question, and twice: each counts for the question
//! that it answers, so that timing causes no wrong pick.

use whichone_tests::number;
use whichone_tests::simulated_group::{Count, study};

const DIALOGUES: u64 = 60;

#[test]
fn policy_credits_badly_timed_answers_to_their_questions() {
    let seed = number("WHICHONE_SEED").unwrap_or(1);
    let counts = study(number("WHICHONE_SEEDS").unwrap_or(DIALOGUES), seed);
    let of =
        |rule: &str| -> Vec<&Count> { counts.iter().filter(|count| count.rule == rule).collect() };
    let sum = |rule: &str, of_count: fn(&Count) -> f64| -> f64 {
        of(rule).into_iter().map(of_count).sum()
    };
    for count in of("mixture") {
        assert_eq!(count.wrong_by_timing, 0, "seed {seed}: {}", count.stories.join("\n\n"));
    }
    let wrong = |rule| sum(rule, |count| count.wrong as f64);
    let credited = |rule| sum(rule, |count| count.credited) / sum(rule, |c| c.answers as f64);
    assert!(wrong("mixture") < wrong("naive"), "seed {seed}: {counts:#?}");
    assert!(credited("mixture") > credited("naive"), "seed {seed}: {counts:#?}");
}
