use super::*;
use crate::study::design::People;
use evaluation::simulation::turns::Rules;
use evaluation::simulation::users::TimedKind;
use evaluation::simulation::{SimulatedInteraction, UserKind};
use user_study::Verdict;

fn tally(right: u32, wrong: u32) -> Tally {
    let mut tally = Tally::default();
    for n in 0..right + wrong {
        tally.add(&SimulatedInteraction {
            verdict: if n < right { Verdict::Right } else { Verdict::Wrong },
            questions: n % 7,
            denied: 0,
            talk_s: 10.0 + f64::from(n % 3),
            seconds: 20.0 + f64::from(n % 5),
            value: 1.0,
            answers: 1,
            misplaced: 0,
            stated: None,
        });
    }
    tally
}

fn rows() -> Vec<Row> {
    let row = |policy: &str, people| Row { policy: policy.to_owned(), people };
    let rules = Rules::default();
    vec![
        row("a<b", People::InTurns(UserKind::Model)),
        row("a<b", People::InTurns(UserKind::Human)),
        row("other", People::InTurns(UserKind::Model)),
        row("a<b", People::RealTime { rules, name: "usual", kind: TimedKind::USUAL }),
    ]
}

#[test]
fn every_picture_repeats() {
    let rows = rows();
    let results: Vec<(&Row, Tally)> = rows.iter().map(|row| (row, tally(95, 5))).collect();
    let pictures = super::pictures(&results).unwrap();
    let names: Vec<&str> = pictures.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["success.svg", "questions.svg", "turn-taking.svg"]);
    assert!(pictures == super::pictures(&results).unwrap());
    for (name, text) in &pictures {
        assert!(text.contains("a&lt;b") || name.starts_with("turn"), "{name}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{name}");
        // A rim and a mark for each result and each name of the legend.
        let marks = [("success.svg", 2 * (3 + 2)), ("turn-taking.svg", 2 * 2)];
        if let Some((_, expected)) = marks.iter().find(|(chart, _)| chart == name) {
            assert_eq!(text.matches("<polygon").count(), *expected, "{name}");
        }
    }
}

#[test]
fn extremes_can_be_drawn() {
    let rows = rows();
    for extreme in [tally(0, 1), tally(1, 0), tally(0, 9), Tally::default()] {
        let results = [(&rows[0], extreme)];
        for (name, text) in super::pictures(&results).unwrap() {
            assert!(!text.is_empty());
            assert!(!text.contains("NaN") && !text.contains("inf"), "{name}: {text}");
        }
    }
}
