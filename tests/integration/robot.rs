//! The arm with its Baxter driver and the simulated Baxter as processes of a group; and an arm with a driver that the
//! group's other programs do not know.

use rustix::process::Signal;
use serde_json::Value;
use whichone_tests::{Group, program, wait_for};

/// A group with the simulated robot behind the robot's own topics.
fn group() -> Group {
    let robot = ["group.services.baxter.nice=0", "arm.driver=baxter", "arm.time_scale=1.0"];
    Group::up(&robot)
}

fn wait_for_arm(group: &Group, what: &str, holds: impl Fn(&Value) -> bool) {
    wait_for(what, 40.0, || Some(group.arm()).filter(&holds));
}

fn assert_delivered(group: &Group, outcome: &Value) {
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &"clear".into()), "{outcome}\n{}", group.logs());
    group.verify_journals();
}

#[test]
fn dialogue_ends_with_a_pick_by_the_robot() {
    let group = group();
    assert_eq!(group.service("baxter")["actual"], "ready");
    assert_delivered(&group, &group.fetch("the clear bowl", "clear"));
    wait_for_arm(&group, "nothing hinders it", |arm| arm["hindrance"] == "none");
    group.down();
}

#[test]
fn object_denied_in_the_gripper_goes_back_through_a_stop_and_a_killed_arm() {
    let group = group();
    group.say("the clear bowl");
    wait_for_arm(&group, "the carry", |arm| {
        arm["object"] == "clear" && arm["phase"] == "holding" && arm["moving"] == true
    });
    group.say("no, not that one");
    wait_for_arm(&group, "the way back", |arm| arm["phase"] == "returning");
    group.must(&["stop-motion"]);
    wait_for_arm(&group, "at rest", |arm| arm["stopped"] == true && arm["moving"] == false);
    let before = group.incarnation("arm");
    group.signal("arm", Signal::KILL);
    group.wait_for_restart("arm", before);
    assert_eq!(group.arm()["phase"], "returning", "{}", group.logs());
    group.release_stop();
    wait_for_arm(&group, "the object in its place", |arm| arm["outcome"] == "cancelled");
    let dialogue = wait_for("the dialogue goes on", 20.0, || {
        Some(group.dialogue()).filter(|it| it["decision"] != "cancel")
    });
    let belief = |object: &str| dialogue["belief"][object].as_f64().unwrap();
    assert!(belief("clear") < belief("metal"), "{dialogue}");
    let outcome = group.await_pick(Some("metal"));
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &"metal".into()), "{outcome}\n{}", group.logs());
    assert_eq!(group.dialogue()["last"]["interaction"], 1, "it was one interaction");
    // It stands where it was.
    assert_delivered(&group, &group.fetch("the clear bowl", "clear"));
    group.down();
}

#[test]
fn killed_robot_process_resumes_the_pick() {
    let group = group();
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        wait_for_arm(&group, "moving", |arm| arm["phase"] == "moving");
        let before = group.incarnation("baxter");
        group.signal("baxter", Signal::STOP);
        wait_for_arm(&group, "silence is noticed", |arm| arm["hindrance"] == "stale");
        group.signal("baxter", Signal::KILL);
        group.wait_for_restart("baxter", before);
    });
    assert_delivered(&group, &outcome);
    group.down();
}

#[test]
fn emergency_stop_latches_until_resume() {
    let group = group();
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        wait_for_arm(&group, "moving", |arm| arm["phase"] == "moving" && arm["moving"] == true);
        group.drill(&["press-estop"]);
        wait_for_arm(&group, "latched", |arm| arm["stopped"] == true && arm["moving"] == false);
        assert_eq!(group.arm()["hindrance"], "stopped");
        for word in ["release-estop", "reset", "enable"] {
            group.drill(&[word]);
        }
        wait_for_arm(&group, "the robot is back", |arm| arm["hindrance"] == "none");
        assert_eq!(group.arm()["stopped"], true, "latched until an operator resumes");
        group.release_stop();
    });
    assert_delivered(&group, &outcome);
    group.down();
}

#[test]
fn missed_grasp_is_announced() {
    let group = group();
    // More often than is tried, also where a halt in between makes another try.
    group.drill(&["miss", "9"]);
    let outcome = group.fetch("the clear bowl", "clear");
    assert_eq!(outcome["outcome"], "failed", "{outcome}\n{}", group.logs());
    let text = group.dialogue()["text"].as_str().unwrap_or_default().to_owned();
    assert!(text.contains("could not get hold"), "{text}");
    group.drill(&["miss", "0"]);
    assert_delivered(&group, &group.fetch("the clear bowl", "clear"));
    group.down();
}

/// Its name and its table are accepted because the arm has a program of its own; they reach it with the snapshot.
#[test]
fn robot_driver_of_another_program_delivers() {
    let command =
        format!("group.services.arm.command=[{:?}]", program("late_arm").display().to_string());
    let own = [command.as_str(), "arm.driver=late", "arm.time_scale=1.0", "arm.late.delay_s=0.08"];
    let group = Group::up(&own);
    assert_delivered(&group, &group.fetch("the clear bowl", "clear"));
    group.down();
}
