//! "Put it back": what was handed over goes back to its place, also when the arm is killed meanwhile.

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::{Group, wait_for};

/// Longest time in which an object is put back on a busy machine, seconds.
const PATIENCE_S: f64 = 60.0;

/// Waits until the arm has put the object back and the robot says so, and returns the dialogue.
fn wait_until_back(group: &Group, object: &str) -> Value {
    wait_for("the object back in its place", PATIENCE_S, || {
        let arm = group.arm();
        let is_back = arm["outcome"] == "put_back" && arm["object"] == object;
        Some(group.dialogue()).filter(|it| is_back && it["decision"] == "say")
    })
}

#[test]
fn what_was_handed_over_is_put_back() {
    let group = Group::up(&["arm.time_scale=5.0", "dialogue.turns.refusal_s=600.0"]);
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.say("put it back");
    let dialogue = wait_until_back(&group, "clear");
    assert_eq!(dialogue["text"], "I have put the clear bowl back.", "{}", group.logs());
    assert_eq!(dialogue["last"]["outcome"], "refused", "{dialogue}");
    group.verify_journals();

    // It stands there again, and the arm may be killed at any time.
    assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    group.say("take it back");
    let before = group.incarnation("arm");
    group.signal("arm", Signal::KILL);
    group.wait_for_restart("arm", before);
    let dialogue = wait_until_back(&group, "clear");
    assert_eq!(dialogue["text"], "I have put the clear bowl back.", "{}", group.logs());
    group.say("put it back");
    wait_for("the answer", PATIENCE_S, || {
        (group.dialogue()["text"] == "I have nothing to put back.").then_some(())
    });
    group.verify_journals();
    group.down();
}
