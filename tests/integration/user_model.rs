//! The learned error rate of the user.

use whichone_tests::{Group, YES_NO, wait_for};

const LEARNS: &str = "dialogue.planner=information-seeking";

fn errs(group: &Group) -> f64 {
    group.dialogue()["person"]["epsilon"].as_f64().expect("it learns")
}

#[test]
fn error_rate_is_learned_and_survives_a_restart() {
    let mut group = Group::up(&[LEARNS, YES_NO]);
    let before = wait_for("the policy", 10.0, || group.dialogue()["person"]["epsilon"].as_f64());
    group.say("get me the bowl");
    // Something must be true of the wanted object: to deny everything is to err.
    for said_so_far in 1..=30 {
        let dialogue = wait_for("a decision on it, and its presentation", 20.0, || {
            let mut seen = group.must(&["watch", "--once", "--json"]).json();
            let (dialogue, said) = (seen["dialogue"].take(), seen["said"].take());
            let is_applied = dialogue["applied"].as_u64() >= Some(said_so_far);
            // An answer before the question is presented is one to the question before.
            let is_presented = said.as_array()?.last()?["text"] == dialogue["text"];
            (is_applied && is_presented && dialogue["decision"] != "wait").then_some(dialogue)
        });
        if dialogue["decision"] != "ask" {
            break;
        }
        group.say("no");
    }
    group.await_pick(None);
    let after = errs(&group);
    assert!(after > 1.5 * before, "{before} {after}");
    group.verify_journals();
    group.must(&["down"]);
    assert_eq!(group.start(&[LEARNS, YES_NO]).code, Some(0));
    assert_eq!(errs(&group), after, "bit for bit");
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    group.verify_journals();
    group.down();
}
