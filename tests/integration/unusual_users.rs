//! Users outside the observation model: the dialogue ends nevertheless.

use whichone_tests::{Group, wait_for};

/// Answers every question with what `answer` says to the n-th, until the interaction is over.
fn answer_with(group: &Group, answer: impl Fn(usize) -> &'static str) -> serde_json::Value {
    let mut said = None;
    for n in 0..40 {
        let dialogue = wait_for("the words to be applied", 20.0, || {
            Some(group.dialogue()).filter(|it| it["applied"].as_u64() >= said)
        });
        if n > 0 && (dialogue["interaction"] == 0 || dialogue["decision"] == "pick") {
            break;
        }
        said = group.must(&["say", answer(n), "--json"]).json()["utterance"].as_u64();
    }
    group.await_pick(None)
}

#[test]
fn contradictory_and_negative_answers_end_with_a_pick() {
    let group = Group::up(&[]);
    for answers in [["yes", "no"], ["no", "no"]] {
        group.say("get me the bowl");
        let outcome = answer_with(&group, |n| answers[n % 2]);
        assert_eq!(outcome["outcome"], "delivered", "{answers:?}: {outcome}");
    }
    group.verify_journals();
    group.down();
}

#[test]
fn silence_is_prompted_again_and_then_abandoned() {
    let group =
        Group::up(&["dialogue.turns.response_window_s=0.2", "dialogue.turns.repeats_max=2"]);
    group.say("get me the bowl");
    let outcome = group.await_pick(None);
    assert_eq!(outcome["outcome"], "abandoned", "{outcome}");
    assert_eq!(outcome["questions"], 1, "one question, said three times: {outcome}");
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    group.down();
}

#[test]
fn request_for_what_is_not_there_ends_at_once() {
    let group = Group::up(&[]);
    group.say("get me the plate");
    let ended = group.call(&["await", "pick", "--json", "--timeout", "50"]);
    assert_eq!(ended.code, Some(1), "{ended:?}");
    let outcome = ended.json();
    assert_eq!(outcome["outcome"], "no_pick", "{outcome}");
    assert!(outcome["answer"].as_str().is_some_and(|it| it.contains("plate")), "{outcome}");
    // That is reported once; then the next interaction counts.
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    let again = group.call(&["await", "pick", "--json", "--timeout", "1"]).json();
    assert_eq!(again["outcome"], "timeout", "{again}");
    group.down();
}

#[test]
fn unknown_words_end_with_a_pick() {
    let group = Group::up(&["dialogue.turns.questions_max=6"]);
    group.say("get me the bowl");
    let outcome = answer_with(&group, |_| "the purple one");
    assert_eq!(outcome["outcome"], "delivered", "out of questions it guesses: {outcome}");
    group.verify_journals();
    group.down();
}

#[test]
fn withdrawn_request_ends_the_interaction() {
    let group = Group::up(&[]);
    group.say("get me the bowl");
    group.say("never mind");
    let outcome = group.await_pick(None);
    assert_eq!(outcome["outcome"], "cancelled", "{outcome}");
    group.down();
}

#[test]
fn correction_during_the_pick_delivers_the_right_object() {
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
fn unrelated_talk_opens_no_interaction() {
    let group = Group::up(&[]);
    group.say("what's the weather like today");
    let dialogue = wait_for("the utterance to be applied", 10.0, || {
        Some(group.dialogue()).filter(|dialogue| dialogue["applied"] == 1)
    });
    assert_eq!(dialogue["interaction"], 0, "{dialogue}");
    group.down();
}

#[test]
fn invalid_utterances_are_refused_with_a_reason() {
    let group = Group::up(&[]);
    let long = "bowl ".repeat(20_000);
    for (text, reason) in [("   ", "empty utterance"), (long.as_str(), "bytes")] {
        let ended = group.call(&["say", text]);
        assert_ne!(ended.code, Some(0));
        assert!(format!("{ended:?}").contains(reason), "{ended:?}");
    }
    assert_eq!(group.fetch("get me the bowl", "metal")["object"], "metal", "it still serves");
    group.down();
}

#[test]
fn spoken_stop_latches_until_resume() {
    let group = Group::up(&["arm.time_scale=4.0"]);
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        group.say("stop");
        wait_for("the stop", 10.0, || (group.arm()["stopped"] == true).then_some(()));
        wait_for("rest", 10.0, || (group.arm()["moving"] == false).then_some(()));
        let before = group.arm()["phase"].clone();
        std::thread::sleep(std::time::Duration::from_millis(500));
        assert_eq!(group.arm()["phase"], before, "the arm stays halted");
        group.release_stop();
    });
    assert_eq!(outcome["object"], "clear", "{outcome}");
    group.verify_journals();
    group.down();
}
