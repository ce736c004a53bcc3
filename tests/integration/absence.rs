//! Absent objects, and prior probabilities by history.

use whichone_tests::{Group, wait_for};

const ABSENT: &str = "dialogue.prior.absent=0.1";

/// Says something as utterance `n`; returns the dialogue once it is applied.
fn said(group: &Group, text: &str, n: u64) -> serde_json::Value {
    group.say(text);
    wait_for("the utterance to be applied", 10.0, || {
        Some(group.dialogue()).filter(|dialogue| dialogue["applied"] == n)
    })
}

#[test]
fn denying_everything_ends_with_not_here() {
    let group = Group::up(&[ABSENT]);
    let mut dialogue = said(&group, "get me the bowl", 1);
    for n in 2..40 {
        if dialogue["interaction"] == 0 {
            break;
        }
        dialogue = said(&group, "no", n);
    }
    assert!(dialogue["text"].as_str().unwrap().contains("does not seem to be here"), "{dialogue}");
    let outcome = group.await_pick(None);
    assert_eq!(outcome["outcome"], "not_here", "{outcome}");
    assert!(outcome["object"].is_null(), "{outcome}");
    assert_eq!(group.arm()["phase"], "idle", "nothing is fetched");
    group.verify_journals();
    group.down();
}

#[test]
fn simulated_user_may_want_an_absent_object() {
    let group = Group::up(&[ABSENT]);
    let outcome = group.fetch("get me the bowl", "teapot");
    assert_eq!(outcome["outcome"], "not_here", "{outcome}");
    for bowl in ["white", "metal2", "clear"] {
        let outcome = group.fetch("get me the bowl", bowl);
        assert_eq!((&outcome["object"], &outcome["outcome"]), (&bowl.into(), &"delivered".into()));
    }
    group.verify_journals();
    group.down();
}

#[test]
fn absence_and_error_rates_are_left_out_unless_configured() {
    let group = Group::up(&[]);
    let refused = group.call(&["await", "pick", "--answer-as", "teapot"]);
    assert_eq!(refused.code, Some(64), "{refused:?}");
    assert!(refused.stderr.contains("dialogue.prior.absent"), "{refused:?}");
    let dialogue = group.dialogue();
    assert_eq!((&dialogue["absent"], &dialogue["person"]), (&0.0.into(), &().into()));
    group.down();
}

#[test]
fn history_prior_survives_a_restart() {
    let mut group = Group::up(&["dialogue.prior.objects=history"]);
    for _ in 0..3 {
        assert_eq!(group.fetch("the clear bowl", "clear")["object"], "clear");
    }
    let belief = |group: &Group| group.dialogue()["belief"].clone();
    wait_for("the history to count", 10.0, || {
        let p = belief(&group)["clear"].as_f64()?;
        ((p - 4.0 / 9.0).abs() < 1e-9).then_some(())
    });
    group.must(&["down"]);
    assert_eq!(group.start(&["dialogue.prior.objects=history"]).code, Some(0));
    assert!((belief(&group)["clear"].as_f64().unwrap() - 4.0 / 9.0).abs() < 1e-9);
    group.verify_journals();
    group.down();
}
