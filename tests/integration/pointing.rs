//! Pointing gestures, alone or with words.

use serde_json::Value;
use whichone_tests::{Group, wait_for};

const ON: &str = "dialogue.gesture.enabled=true";
/// The centre of the bowl `clear`, metres, frame `base`.
const CLEAR: [&str; 3] = ["0.70", "0.2", "-0.12"];

fn applied(group: &Group, utterances: u64) -> Value {
    wait_for("the utterance to be applied", 10.0, || {
        Some(group.dialogue()).filter(|dialogue| dialogue["applied"] == utterances)
    })
}

fn point(group: &Group, at: [&str; 3], more: &[&str]) -> Value {
    let words = [&["point", "--json"], &at[..], more].concat();
    group.must(&words).json()
}

#[test]
fn gestures_are_refused_unless_enabled() {
    let group = Group::up(&[]);
    let before = group.dialogue();
    let refused = group.call(&["point", "0.70", "0.2", "-0.12", "--say", "the white one"]);
    assert_eq!(refused.code, Some(1), "{refused:?}");
    assert!(refused.stderr.contains("dialogue.gesture.enabled"), "{refused:?}");
    assert_eq!(group.dialogue(), before);
    group.say("get me the bowl");
    assert_eq!(applied(&group, 1)["applied"], 1, "no number was given to it");
    group.down();
}

#[test]
fn gesture_alone_opens_an_interaction_and_answers_nothing() {
    let group = Group::up(&[ON]);
    let receipt = point(&group, CLEAR, &[]);
    assert_eq!((&receipt["status"], &receipt["utterance"]), (&"accepted".into(), &1.into()));
    let asked = applied(&group, 1);
    assert_eq!(asked["interaction"], 1, "{asked}");
    let p = |dialogue: &Value, bowl: &str| dialogue["belief"][bowl].as_f64().unwrap();
    for bowl in ["white", "white2", "white3", "metal", "metal2"] {
        assert!(p(&asked, "clear") > p(&asked, bowl), "{asked}");
    }
    assert!(p(&asked, "white") > 1e-4, "nothing is ruled out: {asked}");
    // Once more while a question stands: again evidence for the bowl, and no yes or no.
    point(&group, CLEAR, &["--say", "that one over there"]);
    assert!(p(&applied(&group, 2), "clear") > p(&asked, "clear"));
    let outcome = group.await_pick(Some("clear"));
    assert_eq!((&outcome["object"], &outcome["outcome"]), (&"clear".into(), &"delivered".into()));
    group.verify_journals();
    group.down();
}

#[test]
fn gesture_with_words_needs_fewer_questions() {
    let group = Group::up(&[ON]);
    point(&group, CLEAR, &["--say", "get me the big plastic bowl"]);
    let outcome = group.await_pick(Some("clear"));
    assert_eq!(outcome["object"], "clear", "{outcome}");
    assert!(outcome["questions"].as_u64().unwrap() <= 1, "{outcome}");
    group.down();
}

#[test]
fn implausible_targets_are_refused() {
    let group = Group::up(&[ON]);
    for at in [["nan", "0", "0"], ["0", "5000", "0"]] {
        let refused = group.call(&[&["point"], &at[..]].concat());
        assert_eq!(refused.code, Some(1), "{refused:?}");
        assert!(refused.stderr.contains("m in frame base"), "{refused:?}");
    }
    assert_eq!(group.call(&["point", "1", "2"]).code, Some(64));
    group.down();
}
