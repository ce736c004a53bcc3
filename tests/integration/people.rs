//! People who do not answer as the model hopes: the dialogue ends all the same.

use whichone_tests::{Group, wait_for};

fn outcome_of(group: &Group) -> serde_json::Value {
    group.await_pick(None)
}

/// Answers every question with what `answer` says to the n-th, until the interaction is over.
fn answer_with(group: &Group, answer: impl Fn(usize) -> &'static str) -> serde_json::Value {
    for n in 0..40 {
        let dialogue = group.dialogue();
        if n > 0 && (dialogue["interaction"] == 0 || dialogue["decision"] == "pick") {
            break;
        }
        group.say(answer(n));
    }
    outcome_of(group)
}

#[test]
fn who_contradicts_himself_gets_some_object() {
    let group = Group::up(&[]);
    group.say("get me the bowl");
    let outcome = answer_with(&group, |n| if n % 2 == 0 { "yes" } else { "no" });
    assert_eq!(outcome["outcome"], "delivered", "{outcome}");
    group.verify_journals();
    group.down();
}

#[test]
fn who_denies_everything_gets_some_object() {
    let group = Group::up(&[]);
    group.say("get me the bowl");
    let outcome = answer_with(&group, |_| "no");
    assert_eq!(outcome["outcome"], "delivered", "{outcome}");
    group.down();
}

#[test]
fn who_falls_silent_is_asked_again_and_then_left_alone() {
    let group =
        Group::up(&["dialogue.turns.response_window_s=0.2", "dialogue.turns.repeats_max=2"]);
    group.say("get me the bowl");
    let outcome = outcome_of(&group);
    assert_eq!(outcome["outcome"], "abandoned", "{outcome}");
    assert_eq!(outcome["questions"], 1, "one question, said three times: {outcome}");
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn words_that_the_scene_does_not_have_lead_nowhere_but_to_an_end() {
    let group = Group::up(&["dialogue.turns.questions_max=6"]);
    group.say("get me the bowl");
    let outcome = answer_with(&group, |_| "the purple one");
    assert_eq!(outcome["outcome"], "delivered", "out of questions it guesses: {outcome}");
    group.verify_journals();
    group.down();
}

#[test]
fn a_withdrawn_request_ends_the_interaction() {
    let group = Group::up(&[]);
    group.say("get me the bowl");
    group.say("never mind");
    let outcome = outcome_of(&group);
    assert_eq!(outcome["outcome"], "cancelled", "{outcome}");
    group.down();
}

#[test]
fn who_sees_the_wrong_one_being_fetched_says_so_and_gets_the_right_one() {
    let group = Group::up(&["arm.time_scale=0.5"]);
    group.say("get me the white bowl on the counter");
    let object = wait_for("the arm on its way", 30.0, || {
        let dialogue = group.dialogue();
        if dialogue["decision"] == "ask" {
            group.say("yes");
        }
        let arm = group.arm();
        (arm["phase"] == "moving").then(|| arm["object"].clone())
    });
    group.say("no, not that one, the clear one");
    let outcome = group.await_pick(Some("clear"));
    assert_eq!((&outcome["object"], &outcome["outcome"]), (&"clear".into(), &"delivered".into()));
    assert_eq!(group.dialogue()["last"]["interaction"], 1, "it was one interaction");
    assert_ne!(object, "clear");
    group.verify_journals();
    group.down();
}

#[test]
fn talk_that_is_not_for_the_robot_begins_nothing() {
    let group = Group::up(&[]);
    group.say("what's the weather like today");
    let dialogue = wait_for("the utterance to be applied", 10.0, || {
        Some(group.dialogue()).filter(|dialogue| dialogue["applied"] == 1)
    });
    assert_eq!(dialogue["interaction"], 0, "{dialogue}");
    group.down();
}

#[test]
fn what_cannot_be_an_utterance_is_refused_with_its_reason() {
    let group = Group::up(&[]);
    let long = "bowl ".repeat(20_000);
    for (text, reason) in [("   ", "empty utterance"), (long.as_str(), "bytes")] {
        let ended = group.call(&["say", text]);
        assert_ne!(ended.code, Some(0));
        assert!(format!("{ended:?}").contains(reason), "{ended:?}");
    }
    assert_eq!(group.fetch("get me the bowl", "metal")["object"], "metal", "and goes on");
    group.down();
}

#[test]
fn stop_halts_the_arm_until_it_is_released() {
    let group = Group::up(&["arm.time_scale=4.0"]);
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        group.say("stop");
        wait_for("the stop", 10.0, || (group.arm()["stopped"] == true).then_some(()));
        wait_for("rest", 10.0, || (group.arm()["moving"] == false).then_some(()));
        let before = group.arm()["phase"].clone();
        std::thread::sleep(std::time::Duration::from_millis(500));
        assert_eq!(group.arm()["phase"], before, "nothing goes on");
        group.must(&["resume-motion"]);
    });
    assert_eq!(outcome["object"], "clear", "{outcome}");
    group.verify_journals();
    group.down();
}
