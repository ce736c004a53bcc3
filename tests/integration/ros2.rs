//! The ROS 2 node and programs of other implementations, on the loopback network.

mod hostile;

use rustix::process::Signal;
use serde_json::Value;
use std::time::Duration;
use whichone_tests::ros2::{Implementation, Ros2Peer};
use whichone_tests::{Group, wait_for};

/// The tests with each implementation.
macro_rules! with_peers {
    ($($name:ident)+) => {
        mod ros2_cyclone {
            $(#[test]
            #[ignore = "needs cyclonedds, and whichone-ros2 built with ros2/dds"]
            fn $name() {
                super::$name(whichone_tests::ros2::CYCLONE);
            })+
        }
        mod ros2_rclpy {
            $(#[test]
            #[ignore = "needs rclpy, and whichone-ros2 built with ros2/dds"]
            fn $name() {
                super::$name(whichone_tests::ros2::RCLPY);
            })+
        }
    };
}

with_peers! {
    request_by_topic_ends_in_a_delivered_object
    every_topic_is_seen_with_its_contents
    motion_stop_and_cancel_are_services
    node_that_was_stopped_is_restarted_and_publishes
    flood_of_words_is_refused_and_harms_nothing
    killed_peer_harms_nothing_and_the_next_one_sees_everything
}

/// More than the interval of the node's figures.
const DIAGNOSTICS_EVERY: Duration = Duration::from_millis(1_500);
/// Settings for the objects that the program's detectors see.
const OBJECTS: &[&str] = &[
    "group.perception.enabled=true",
    "group.perception.frames=[{ name = \"lens\", xyz = [0.5, 0.0, 0.0], rpy = [0.0, 0.0, 0.0] }]",
    "ros2.objects.detections=/camera/detections",
    "ros2.objects.ar_markers=/ar_pose_marker",
    "ros2.objects.tf=/tf",
    "ros2.objects.classes=[{ id = \"cup\", object = \"white2\" }]",
    "ros2.objects.markers=[{ id = \"7\", object = \"metal\" }, \
     { id = \"tag36h11:8\", object = \"clear\", xyz = [0.0, 0.0, -0.03] }]",
];

/// rclpy from PyPI has none of these messages.
#[test]
#[ignore = "needs cyclonedds, and whichone-ros2 built with ros2/dds"]
fn ros2_cyclone_objects_of_detectors_and_markers_are_fetched_by_request() {
    let (mut peer, group) = whichone_tests::ros2::CYCLONE.start(OBJECTS);
    // Old images first: they are refused, and nothing appears.
    let old = r#"{ "age_s": 5.0, "ar_markers": [[7, 0.1, 0.4, -0.12]] }"#;
    peer.tell(&format!("see {old}"));
    let table = || group.must(&["objects", "--json", "--timeout=30"]).json();
    wait_for("refusal of old looks", 40.0, || {
        table()["refusal"].as_str()?.contains("old").then_some(())
    });
    assert_eq!(table()["objects"], serde_json::json!([]));
    let seen = r#"{ "detections": [["white", 0.9, "1", 0.2, 0.2, -0.12], ["cup", 0.9, "2", 0.3, 0.3, -0.12],
                                   ["dog", 0.9, "3", 0.2, 0.4, -0.12]],
                    "tf": [["tag36h11:8", 0.2, -0.2, -0.09], ["left_wrist", 0.1, 0.1, 0.1]] }"#;
    peer.tell(&format!("see {}", seen.replace('\n', " ")));
    let found = wait_for("the objects of all detectors", 40.0, || {
        Some(table()).filter(|table| table["objects"].as_array().is_some_and(|all| all.len() == 4))
    });
    let named = |class: &str| {
        let mut all = found["objects"].as_array().unwrap().iter();
        all.find(|it| it["classes"][class].is_number())
            .unwrap_or_else(|| panic!("{class}: {found}"))
    };
    for (class, place) in [
        ("white", [0.7, 0.2, -0.12]),
        ("white2", [0.8, 0.3, -0.12]),
        ("metal", [0.6, 0.4, -0.12]),
        ("clear", [0.7, -0.2, -0.12]),
    ] {
        let off = |n: usize| (named(class)["xyz"][n].as_f64().unwrap() - place[n]).abs();
        assert!((0..3).all(|n| off(n) < 1e-6), "{class}: {}", named(class));
    }
    let seen = peer.wait_for("counts in the diagnostics", |seen| {
        let figure = |key: &str| {
            let values = &seen["diagnostics"]["whichone: ROS 2 node"]["values"];
            values[key].as_str().and_then(|text| text.parse::<u64>().ok()).unwrap_or(0)
        };
        figure("sightings") > 10 && figure("unknown_ids") > 1
    });
    assert_eq!(seen["diagnostics"]["whichone: ROS 2 node"]["values"]["without_pose"], "0");
    let log = group.wait_for_log("ros2", "unknown identifier `dog`");
    assert_eq!(log.matches("unknown identifier `dog`").count(), 1, "{log}");

    let clear = named("clear")["name"].as_str().unwrap();
    peer.tell("say get me the clear bowl");
    let outcome = group.await_pick(Some(clear));
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &clear.into()), "{outcome}\n{}", group.logs());
    // An object that its detector does not show any more is gone after a while.
    peer.tell(r#"see { "ar_markers": [] }"#);
    wait_for("the metal bowl is gone", 30.0, || {
        let table = table();
        let mut all = table["objects"].as_array()?.iter();
        all.all(|it| it["classes"]["metal"].is_null()).then_some(())
    });
    group.verify_journals();
    group.down();
}

/// A robot with one arm, whose joints have names of their own.
#[test]
#[ignore = "needs cyclonedds, and whichone-ros2 built with ros2/dds"]
fn ros2_cyclone_joints_of_a_single_arm_are_seen() {
    let settings = &[
        "group.scene=blocks",
        "arm.robot=ur5e",
        "arm.hand_over_xyz=[0.45, 0.42, 0.25]",
        "arm.table_z_m=0.0",
        // Slow enough for the motion to be seen.
        "arm.time_scale=4.0",
    ];
    let (mut peer, group) = whichone_tests::ros2::CYCLONE.start(settings);
    let before = peer.tell("look")["joints"].clone();
    let names: Vec<_> = before.as_object().unwrap().keys().map(String::as_str).collect();
    for joint in ["shoulder_pan_joint", "elbow_joint", "wrist_3_joint", "finger_1_joint"] {
        assert!(names.contains(&joint), "{names:?}");
    }
    assert!(names.iter().all(|name| !name.starts_with("left_")), "{names:?}");
    peer.tell("say the small yellow block");
    peer.wait_for("the arm moves", |seen| {
        let at = |joints: &Value| joints["shoulder_pan_joint"].as_f64().unwrap();
        (at(&seen["joints"]) - at(&before)).abs() > 0.05
    });
    let outcome = group.await_pick(None);
    assert_eq!(outcome["object"], "yellow_small", "{outcome}\n{}", group.logs());
    group.down();
}

/// The program says this, and the robot delivers the object.
fn deliver(peer: &mut Ros2Peer, group: &Group, words: &str, object: &str) {
    peer.tell(&format!("say {words}"));
    assert_delivered(group, &group.await_pick(None), object);
}

fn assert_delivered(group: &Group, outcome: &Value, object: &str) {
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &object.into()), "{outcome}\n{}", group.logs());
}

fn texts<'a>(seen: &'a Value, topic: &str) -> Vec<&'a str> {
    seen["texts"][topic].as_array().into_iter().flatten().filter_map(Value::as_str).collect()
}

fn is_stopped(group: &Group, stopped: bool) {
    wait_for("the motion stop", 10.0, || (group.arm()["stopped"] == stopped).then_some(()));
}

fn request_by_topic_ends_in_a_delivered_object(implementation: Implementation) {
    let (mut peer, group) = implementation.start(&[]);
    peer.tell("say the bowl");
    let asked = peer.wait_for("a question that waits for its answer", |seen| {
        seen["state"]["dialogue"]["expects_answer"] == true
    });
    let options = asked["state"]["dialogue"]["options"].as_array().unwrap();
    assert!(options.len() > 2 && options.last().unwrap() == "I don't know", "{options:?}");
    let outcome = group.await_pick(Some("white2"));
    assert_eq!(outcome["outcome"], "delivered", "{outcome}");
    assert_eq!(outcome["object"], "white2", "{outcome}");
    let seen = peer.wait_for("the end in /whichone/state", |seen| {
        seen["state"]["dialogue"]["last"]["outcome"] == "delivered"
    });
    let (said, heard) = (texts(&seen, "/whichone/say"), texts(&seen, "/whichone/heard"));
    assert_eq!(heard.iter().filter(|text| **text == "the bowl").count(), 1, "{heard:?}");
    assert!(heard.len() >= 2, "the answers, which came another way, too: {heard:?}");
    assert!(said.iter().any(|text| text.ends_with('?')), "{said:?}");
    assert!(said.iter().any(|text| text.contains("white bowl")), "{said:?}");
    group.verify_journals();
    group.down();
}

/// Diagnostics are published once a second: the first may still say that services start.
fn diagnosed_as_working(diagnostics: &Value) -> bool {
    let services = ["speech", "grounding", "policy", "arm", "ros2"];
    services.iter().all(|it| diagnostics[format!("whichone: {it}")]["level"] == 0)
        && diagnostics["whichone: ROS 2 node"]["values"]["accepted"] == "1"
}

fn every_topic_is_seen_with_its_contents(implementation: Implementation) {
    let (mut peer, group) = implementation.start(&[]);
    deliver(&mut peer, &group, "the clear bowl", "clear");
    let seen = peer.wait_for("every topic", |seen| {
        let untyped = seen["untyped"].as_array().map_or(&[][..], Vec::as_slice);
        let mut counts = seen["count"].as_object().into_iter().flatten();
        counts.all(|(topic, count)| count != 0 || untyped.contains(&topic.as_str().into()))
            && seen["state"]["dialogue"]["last"]["object"] == "clear"
            && diagnosed_as_working(&seen["diagnostics"])
    });
    let shipped = include_str!("../../config/robots/baxter.urdf");
    assert!(seen["description"] == shipped, "the description as it is in its file");
    for joint in ["left_s0", "right_w2", "l_gripper_l_finger_joint"] {
        assert!(seen["joints"][joint].is_number(), "{joint}: {}", seen["joints"]);
    }
    let keys = |view: &Value| {
        let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        [keys(view), keys(&view["dialogue"]), keys(&view["arm"]), keys(&view["group"])]
    };
    let mut view = group.call(&["watch", "--once", "--json"]).json();
    // The command line's output names its schema, too.
    view.as_object_mut().expect("an object").shift_remove("schema");
    assert_eq!(keys(&seen["state"]), keys(&view));
    if let Some(markers) = seen["markers"].as_array() {
        let named = |name: &str| {
            let begins = format!("{name} ");
            markers.iter().any(|marker| marker["text"].as_str().unwrap().starts_with(&begins))
        };
        assert!(named("white2") && named("metal"), "{markers:?}");
    }
    if let Some(frames) = seen["frames"].as_array() {
        let expected: Value = serde_json::json!(["base", "object/white2"]);
        assert!(frames.contains(&expected), "{frames:?}");
    }
    group.down();
}

/// Releases the motion stop, once a release counts.
fn resume(peer: &mut Ros2Peer) {
    wait_for("the release", 20.0, || (peer.tell("call resume")["success"] == true).then_some(()));
}

fn motion_stop_and_cancel_are_services(implementation: Implementation) {
    let (mut peer, group) = implementation.start(&[]);
    let answer = peer.tell("call stop");
    assert_eq!(answer["success"], true, "{answer}\n{}", group.logs());
    assert_eq!(answer["message"], "stopped, at rest");
    is_stopped(&group, true);
    let answer = peer.tell("call resume");
    assert_eq!(answer["success"], false, "too soon: {answer}");
    resume(&mut peer);
    is_stopped(&group, false);
    peer.tell("stop");
    is_stopped(&group, true);
    resume(&mut peer);
    is_stopped(&group, false);

    let answer = peer.tell("call cancel");
    assert_eq!(
        (&answer["success"], &answer["message"]),
        (&false.into(), &"no request is open".into())
    );
    peer.tell("say the bowl");
    group.wait_for_decision("ask");
    peer.wait_for("the question in the node", |seen| {
        seen["state"]["dialogue"]["decision"] == "ask"
    });
    let answer = peer.tell("call cancel");
    assert_eq!(answer["success"], true, "{answer}");
    peer.wait_for("withdrawal", |seen| seen["state"]["dialogue"]["last"]["outcome"] == "cancelled");

    // Without the arm's service a stop is not confirmed, and is carried out when it is back.
    group.must(&["hold", "arm"]);
    let answer = peer.tell("call stop");
    assert_eq!(answer["success"], false, "{answer}");
    assert!(answer["message"].as_str().unwrap().contains("emergency stop"), "{answer}");
    group.must(&["release", "arm"]);
    is_stopped(&group, true);
    group.down();
}

fn node_that_was_stopped_is_restarted_and_publishes(implementation: Implementation) {
    let (mut peer, group) = implementation.start(&[]);
    let before = group.incarnation("ros2");
    group.signal("ros2", Signal::STOP);
    std::thread::sleep(Duration::from_secs(1));
    // The new node says what is latched once, perhaps before it is seen to be there.
    peer.tell("forget");
    group.signal("ros2", Signal::CONT);
    group.wait_for_restart("ros2", before);
    assert!(group.logs().contains("DDS threads"), "{}", group.logs());
    peer.wait_until_found(&group);
    peer.wait_for("latched topics of the new node", |seen| seen["description"].is_string());
    deliver(&mut peer, &group, "the clear bowl", "clear");
    group.down();
}

fn flood_of_words_is_refused_and_harms_nothing(implementation: Implementation) {
    let (mut peer, group) = implementation.start(&[]);
    let rss_kib = || group.service("ros2")["rss_kib"].as_u64().unwrap();
    let before_kib = rss_kib();
    let incarnation = group.incarnation("ros2");
    peer.tell("flood 3000");
    let answer = peer.tell("call stop");
    assert_eq!(answer["success"], true, "in the flood: {answer}");
    is_stopped(&group, true);
    resume(&mut peer);
    let figure = |seen: &Value, key: &str| -> u64 {
        let values = &seen["diagnostics"]["whichone: ROS 2 node"]["values"];
        values[key].as_str().and_then(|text| text.parse().ok()).unwrap_or(0)
    };
    let seen = peer.wait_for("refusals", |seen| figure(seen, "refused") > 0);
    assert!(figure(&seen, "accepted") < 3_000, "{seen}");
    assert_eq!(group.incarnation("ros2"), incarnation, "{}", group.logs());
    let grown_kib = rss_kib().saturating_sub(before_kib);
    assert!(grown_kib < 32 << 10, "{grown_kib} KiB");
    // Words that were not lost on the way are accepted or refused; a cancellation may come before them.
    let mut taken = 0;
    wait_for("the flood is over", 60.0, || {
        std::thread::sleep(DIAGNOSTICS_EVERY);
        let seen = peer.wait_for("figures", |seen| figure(seen, "refused") > 0);
        let now = figure(&seen, "refused") + figure(&seen, "accepted");
        (std::mem::replace(&mut taken, now) == now).then_some(())
    });
    wait_for("no request of the flood is open", 60.0, || {
        let answer = peer.tell("call cancel");
        (answer["success"] == false && answer["message"] == "no request is open").then_some(())
    });
    peer.tell("say the clear bowl");
    let mut outcome = group.await_pick(None);
    if outcome["outcome"] == "cancelled" {
        // The end of what the flood had opened.
        outcome = group.await_pick(None);
    }
    assert_delivered(&group, &outcome, "clear");
    group.verify_journals();
    group.down();
}

fn killed_peer_harms_nothing_and_the_next_one_sees_everything(implementation: Implementation) {
    let (mut peer, group) = implementation.start(&[]);
    let incarnation = group.incarnation("ros2");
    peer.restart();
    peer.wait_until_found(&group);
    let seen = peer.wait_for("latched topics", |seen| {
        seen["description"].is_string() && seen["state"]["dialogue"].is_object()
    });
    assert!(seen["delay_ms"]["max"].as_f64().unwrap() < 5_000.0, "{}", seen["delay_ms"]);
    deliver(&mut peer, &group, "the clear bowl", "clear");
    assert_eq!(group.incarnation("ros2"), incarnation, "{}", group.logs());
    group.down();
}
