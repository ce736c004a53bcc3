//! What the robot learns about the person who answers.

use whichone_tests::{Group, wait_for};

const LEARNS: &str = "dialogue.planner=information-seeking";

fn errs(group: &Group) -> f64 {
    group.dialogue()["person"]["epsilon"].as_f64().expect("it learns")
}

#[test]
fn who_denies_everything_is_known_for_it_after_the_interaction_and_a_restart() {
    let mut group = Group::up(&[LEARNS]);
    let before = wait_for("the policy", 10.0, || group.dialogue()["person"]["epsilon"].as_f64());
    group.say("get me the bowl");
    // Something must be true of what is wanted: whoever denies everything errs.
    for _ in 0..30 {
        if group.dialogue()["decision"] != "ask" {
            break;
        }
        group.say("no");
    }
    group.await_pick(None);
    let after = errs(&group);
    assert!(after > 1.5 * before, "{before} {after}");
    group.verify_journals();
    group.must(&["down"]);
    assert_eq!(group.start(&[LEARNS]).code, Some(0));
    assert_eq!(errs(&group), after, "bit for bit");
    assert_eq!(group.fetch("get me the bowl", "clear")["object"], "clear");
    group.verify_journals();
    group.down();
}

#[test]
fn where_nothing_is_learned_nothing_is_shown() {
    let group = Group::up(&[]);
    assert!(group.dialogue()["person"].is_null());
    group.down();
}
