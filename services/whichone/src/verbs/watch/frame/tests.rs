use messages::WireCode;
use serde_json::json;

use super::*;

fn scene(objects: usize) -> Scene {
    let objects: Vec<_> =
        (0..objects).map(|i| json!({"name": format!("o{i}"), "attributes": {}})).collect();
    let json = json!({ "objects": objects, "values": {"color": ["red"]} });
    Scene::from_json("scene", &json).unwrap()
}

#[test]
fn bars_are_as_long_as_the_belief_is_strong() {
    assert_eq!(bar(0.0, 10), "");
    assert_eq!(bar(1.0, 10), "█".repeat(10));
    assert_eq!(bar(0.5, 5), "██▌");
    assert_eq!(bar(f64::NAN, 10), "");
    let lines = belief(&scene(2), &[0.25, 0.75], Style::default(), 28);
    assert_eq!(lines, ["  o0  25.0 % ███▌", "  o1  75.0 % ██████████▌"]);
}

#[test]
fn of_many_objects_the_most_probable_are_shown_in_order() {
    let mut probabilities = vec![0.0; 30];
    (probabilities[3], probabilities[20]) = (0.4, 0.6);
    let lines = belief(&scene(30), &probabilities, Style::default(), 80);
    assert_eq!(lines.len(), OBJECTS_MAX + 1);
    let at = |name: &str| lines.iter().position(|line| line.contains(name)).unwrap();
    assert!(at("o3 ") < at("o20 "));
    assert_eq!(lines.last().unwrap(), "  and 18 less probable ones");
}

#[test]
fn watch_frame_shows_the_dialogue_with_reasons() {
    let view = PolicyView {
        interaction: 4,
        belief: vec![0.5, 0.5],
        decision: messages::ActKind::Ask,
        value: 41.26,
        bounds: Some((41.2, 41.3)),
        alternatives: vec![(vocabulary::Action::Pick(::scene::ObjectId(0)), -25.0)],
        questions: 1,
        expected_questions: 0.4,
        ..PolicyView::default()
    };
    let lines = dialogue(&scene(2), &view, Style::default(), 80);
    assert_eq!(lines[0], "interaction 4: 1 question asked, 0.4 to come");
    assert_eq!(
        lines[3..],
        ["decision: ask (value 41.26, best 41.20 to 41.30)", "  alternatives: pick o0 -25.0"]
    );
}

#[test]
fn watch_frame_shows_a_stopped_arm_in_every_phase() {
    let moving = ArmStatus {
        phase: PickPhase::Moving.code(),
        moving: 1,
        object: 1,
        remaining_s: 3.25,
        ..ArmStatus::default()
    };
    let moving_line = arm_line(&scene(2), &moving, Style::default());
    assert_eq!(moving_line, "arm moves to o1, 3.2 s to go, moving");
    let stopped = arm_line(&scene(2), &ArmStatus { stopped: 1, ..moving }, Style::default());
    assert!(stopped.contains("STOPPED"), "{stopped}");
    let task = messages::Task::PutBack.into();
    let back = arm_line(&scene(2), &ArmStatus { task, ..moving }, Style::default());
    assert_eq!(back, "arm comes for o1, 3.2 s to go, moving");
    let unknown = ArmStatus { object: 9, ..ArmStatus::default() };
    assert!(!arm_line(&scene(2), &unknown, Style::default()).is_empty());
}

#[test]
fn watch_frame_lines_fit_the_screen_and_are_sanitised() {
    assert_eq!(cut("abcdef", 4), "abc…");
    assert_eq!(cut("ab\x1b[2J", 10), "ab [2J");
    assert_eq!(redraw(&["a\x07".into()], Style::default()), "\x1b[Ha\\u{7}\x1b[K\r\n\x1b[J");
}
