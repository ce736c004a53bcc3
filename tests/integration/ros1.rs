//! The bridge between a master of Debian's packages, a robot in rospy, and a group whose arm has the
//! Baxter driver.

use rustix::process::Signal;
use serde_json::Value;
use std::collections::BTreeMap;
use whichone_tests::ros1::Ros;
use whichone_tests::{Group, wait_for};

/// Settings for the objects that the camera sees. The marker is 3 cm above the bowl's centre.
const OBJECTS: &[&str] = &[
    "group.perception.enabled=true",
    "group.perception.frames=[{ name = \"lens\", xyz = [0.5, 0.0, 0.0], rpy = [0.0, 0.0, 0.0] }]",
    "arm.ros1.objects.detections=/detections",
    "arm.ros1.objects.apriltags=/tag_detections",
    "arm.ros1.objects.ar_markers=/ar_pose_marker",
    "arm.ros1.objects.classes=[{ id = \"3\", object = \"white\" }]",
    "arm.ros1.objects.markers=[{ id = \"7\", object = \"metal\" }, \
     { id = \"8\", object = \"clear\", xyz = [0.0, 0.0, -0.03] }]",
];

const BOWLS: [&str; 6] = ["white", "white2", "white3", "metal", "metal2", "clear"];

/// A robot, and a group behind it that has heard it.
fn start() -> (Ros, Group) {
    let ros = Ros::start();
    let group = ros.group();
    wait_for_arm(&group, "the robot is heard", |arm| arm["hindrance"] == "none");
    (ros, group)
}

fn wait_for_arm(group: &Group, what: &str, holds: impl Fn(&Value) -> bool) {
    wait_for(what, 40.0, || Some(group.arm()).filter(&holds));
}

fn wait_for_motion(group: &Group) {
    wait_for_arm(group, "moving", |arm| arm["phase"] == "moving" && arm["moving"] == true);
}

fn assert_delivered(group: &Group, outcome: &Value, object: &str) {
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &object.into()), "{outcome}\n{}", group.logs());
    group.verify_journals();
}

/// Commands stay within 0.2 rad of the measured joints, but for what a pause of the robot excuses; commands of a plan
/// that is over would not.
fn assert_no_stale_motion(ros: &mut Ros, group: &Group) {
    let seen = ros.robot("look");
    let error_rad = seen["largest_error_rad"].as_f64().unwrap();
    assert!(seen["commands"].as_u64().unwrap() > 100, "{seen}");
    assert!(error_rad < 0.2, "{seen}\n{}", group.logs());
}

/// One dialogue with this happening while the arm moves.
fn fetch_through(ros: &mut Ros, group: &Group, disturb: impl FnOnce(&mut Ros)) {
    let outcome = group.fetch_while("the clear bowl", "clear", || {
        wait_for_motion(group);
        disturb(ros);
    });
    assert_delivered(group, &outcome, "clear");
    assert_no_stale_motion(ros, group);
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_dialogues_end_with_picks_by_the_robot() {
    let (mut ros, group) = start();
    for bowl in BOWLS {
        assert_delivered(&group, &group.fetch("get me the bowl", bowl), bowl);
    }
    assert_no_stale_motion(&mut ros, &group);
    let seen = ros.robot("look");
    let more_than = |key: &str, count: u64| seen[key].as_u64().unwrap() > count;
    assert!(more_than("commands", 2500) && more_than("points", 250), "{seen}");
    assert!(more_than("ratios", 5), "{seen}");
    assert!(ros.knows_topics_of("/whichone"));
    group.down();
    assert!(!ros.knows_topics_of("/whichone"), "the bridge has taken its leave");
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_robot_killed_and_restarted_resumes_the_pick() {
    let (mut ros, group) = start();
    fetch_through(&mut ros, &group, |ros| {
        ros.kill_robot();
        wait_for_arm(&group, "silence is noticed", |arm| arm["hindrance"] == "stale");
        ros.start_robot();
    });
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_master_killed_and_restarted_resumes_the_pick() {
    let (mut ros, group) = start();
    // The robot registers nowhere again, and its connections go on.
    fetch_through(&mut ros, &group, |ros| {
        ros.restart_master();
        wait_for("registration at the new master", 10.0, || {
            ros.knows_topics_of("/whichone").then_some(())
        });
    });
    // A robot that starts with the new master is found there.
    fetch_through(&mut ros, &group, Ros::restart_robot);
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_bridge_killed_is_restarted_and_resumes_the_pick() {
    let (mut ros, group) = start();
    let before = group.incarnation("baxter");
    fetch_through(&mut ros, &group, |_| {
        group.signal("baxter", Signal::KILL);
        group.wait_for_restart("baxter", before);
    });
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_bridge_stopped_for_three_seconds_sends_nothing_stale() {
    // Without a watchdog: the supervisor would restart a bridge that is stopped for so long.
    let mut ros = Ros::start();
    let mut settings = ros.settings().to_vec();
    settings.push("group.services.baxter.watchdog_s=0".to_owned());
    let group = Group::up(&settings.iter().map(String::as_str).collect::<Vec<_>>());
    wait_for_arm(&group, "the robot is heard", |arm| arm["hindrance"] == "none");
    fetch_through(&mut ros, &group, |_| {
        group.signal("baxter", Signal::STOP);
        std::thread::sleep(std::time::Duration::from_secs(3));
        assert_eq!(group.arm()["hindrance"], "stale", "{}", group.logs());
        group.signal("baxter", Signal::CONT);
    });
    assert!(ros.robot("look")["silence_s"].as_f64().unwrap() > 2.5, "{}", ros.robot("look"));
    // The arm ends while the bridge is stopped: the commands that it left behind are not sent.
    group.signal("baxter", Signal::STOP);
    std::thread::sleep(std::time::Duration::from_millis(500));
    group.signal("arm", Signal::STOP);
    std::thread::sleep(std::time::Duration::from_millis(500));
    ros.robot("reset");
    group.signal("baxter", Signal::CONT);
    std::thread::sleep(std::time::Duration::from_secs(1));
    assert_eq!(ros.robot("look")["commands"], 0, "{}", group.logs());
    group.signal("arm", Signal::CONT);
    wait_for("commands", 20.0, || (ros.robot("look")["commands"].as_u64()? > 0).then_some(()));
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_emergency_stop_and_second_publisher_are_reported() {
    let (mut ros, group) = start();
    ros.robot("stop");
    wait_for_arm(&group, "the stop is noticed", |arm| arm["hindrance"] == "stopped");
    ros.robot("go");
    wait_for_arm(&group, "the robot is back", |arm| arm["hindrance"] == "none");
    // Another node that publishes the robot's topics.
    let mut recorder = record(&ros, "two.bag");
    std::thread::sleep(std::time::Duration::from_secs(2));
    end(&mut recorder);
    let mut player = play(&ros, "two.bag");
    wait_for("the warning", 20.0, || {
        group.logs().contains("more than one publisher").then_some(())
    });
    end(&mut player);
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_recording_of_a_pick_is_played_to_the_arm() {
    let (mut ros, group) = start();
    let mut recorder = record(&ros, "pick.bag");
    assert_delivered(&group, &group.fetch("the clear bowl", "clear"), "clear");
    end(&mut recorder);
    // What the bridge publishes can be read by its definitions.
    let count = "import rosbag; bag = rosbag.Bag('pick.bag'); \
                 count = lambda *topics: sum(1 for m in bag.read_messages(topics)); \
                 both = lambda form: [form % limb for limb in ('left', 'right')]; \
                 commands = bag.read_messages(both('/robot/limb/%s/joint_command')); \
                 print(sum(1 for m in commands \
                 if m.message.mode == 1 and len(m.message.command) == 7 == len(m.message.names)), \
                 count(*both('/robot/limb/%s/inverse_dynamics_command')), \
                 count(*both('/robot/limb/%s/set_speed_ratio')), \
                 count(*both('/robot/end_effector/%s_gripper/command')), count('/robot/joint_states'))";
    let mut command = ros.command("/usr/bin/python3");
    let counted = whichone_tests::run(command.args(["-c", count]), "", 60.0);
    let counts: Vec<u64> = counted.stdout.split_whitespace().map(|n| n.parse().unwrap()).collect();
    let enough = counts.iter().zip([300, 100, 3, 1, 900]).all(|(found, least)| *found >= least);
    assert!(counts.len() == 5 && enough, "{counted:?}");
    // The arm hears the recording in place of the robot.
    ros.kill_robot();
    wait_for_arm(&group, "silence is noticed", |arm| arm["hindrance"] == "stale");
    let mut player = play(&ros, "pick.bag");
    wait_for_arm(&group, "the recording is heard", |arm| arm["hindrance"] == "none");
    end(&mut player);
    wait_for_arm(&group, "its end is noticed", |arm| arm["hindrance"] == "stale");
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_bridge_whose_name_is_taken_ends_and_says_why() {
    let (ros, group) = start();
    let own = ros.call("lookupNode", "/whichone").unwrap();
    let reason = ["/master".into(), "new node registered with same name".into()];
    let patience = std::time::Duration::from_secs(2);
    let asked = ros1::xmlrpc::call(own.as_text().unwrap(), "shutdown", &reason, patience);
    assert!(asked.is_ok(), "{asked:?}");
    wait_for("the end of the bridge", 20.0, || {
        (group.service("baxter")["actual"] == "held").then_some(())
    });
    assert!(group.logs().contains("new node registered with same name"), "{}", group.logs());
    assert!(!ros.knows_topics_of("/whichone"));
    group.down();
}

/// What is on the table by likeliest class, with its name and place.
fn table(group: &Group) -> BTreeMap<String, (String, [f64; 3])> {
    let table = group.must(&["objects", "--json", "--timeout=30"]).json();
    let of = |object: &Value| {
        let classes = object["classes"].as_object()?.keys().next()?.clone();
        let axis = |n: usize| object["xyz"][n].as_f64();
        let name = object["name"].as_str()?.to_owned();
        Some((classes, (name, [axis(0)?, axis(1)?, axis(2)?])))
    };
    table["objects"].as_array().unwrap().iter().filter_map(of).collect()
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_objects_of_detectors_and_markers_are_fetched_by_request() {
    let ros = Ros::start();
    let mut settings: Vec<String> = ros.settings().to_vec();
    settings.extend(OBJECTS.iter().map(|own| (*own).to_owned()));
    // The test stops the bridge for longer than a watchdog permits.
    settings.push("group.services.baxter.watchdog_s=0".to_owned());
    let group = Group::up(&settings.iter().map(String::as_str).collect::<Vec<_>>());
    let mut camera = ros.camera();
    camera.tell(
        r#"{ "detections": [[3, 0.95, 0.2, 0.2, -0.12], [99, 0.9, 0.2, 0.4, -0.12]],
             "apriltags": [[[70, 8], 0.2, -0.2, -0.09]], "ar_markers": [[7, 0.1, 0.4, -0.12]] }"#
            .replace('\n', " ")
            .as_str(),
    );
    let found = wait_for("the objects of all detectors", 60.0, || {
        Some(table(&group)).filter(|table| table.len() == 3)
    });
    for (class, place) in
        [("white", [0.7, 0.2, -0.12]), ("metal", [0.6, 0.4, -0.12]), ("clear", [0.7, -0.2, -0.12])]
    {
        let (_, found) = &found[class];
        let off = found.iter().zip(place).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-6, "{class} at {found:?}");
    }
    let log = group.wait_for_log("baxter", "unknown identifier `99`");
    assert_eq!(log.matches("unknown identifier `99`").count(), 1, "{log}");

    // What waited while the bridge stood still is old, whatever the clock of the camera says. The bridge passes on the
    // newest look only, so the camera has to fall silent for an old one to be that.
    let pause = || std::thread::sleep(std::time::Duration::from_millis(1_500));
    group.signal("baxter", Signal::STOP);
    pause();
    camera.signal(Signal::STOP);
    pause();
    group.signal("baxter", Signal::CONT);
    wait_for("old looks are refused", 20.0, || {
        let table = group.must(&["objects", "--json", "--timeout=30"]).json();
        table["refusal"].as_str()?.contains("s old").then_some(())
    });
    camera.signal(Signal::CONT);
    wait_for_arm(&group, "the robot is heard again", |arm| arm["hindrance"] == "none");

    let (clear, _) = &found["clear"];
    let outcome = group.fetch("get me the clear bowl", clear);
    assert_delivered(&group, &outcome, clear);
    // An object that its detector does not show any more is gone after a while.
    camera.tell(r#"{ "ar_markers": [], "apriltags": [] }"#);
    wait_for("the metal bowl is gone", 30.0, || {
        (!table(&group).contains_key("metal")).then_some(())
    });
    assert!(table(&group).contains_key("white"));
    group.down();
}

#[test]
#[ignore = "needs rosmaster and rospy"]
fn ros1_objects_in_an_unknown_frame_are_refused_with_the_reason() {
    let ros = Ros::start();
    let mut settings: Vec<String> = ros.settings().to_vec();
    let known = OBJECTS.iter().filter(|own| !own.contains("frames"));
    settings.extend(known.map(|own| (*own).to_owned()));
    let group = Group::up(&settings.iter().map(String::as_str).collect::<Vec<_>>());
    let mut camera = ros.camera();
    camera.tell(r#"{ "ar_markers": [[7, 0.1, 0.4, -0.12]] }"#);
    wait_for("the refusal", 40.0, || {
        let table = group.must(&["objects", "--json", "--timeout=30"]).json();
        let refusal = table["refusal"].as_str()?;
        (refusal.contains("unknown frame `lens`") && refusal.contains("/ar_pose_marker"))
            .then_some(())
    });
    assert!(table(&group).is_empty());
    group.down();
}

fn record(ros: &Ros, file: &str) -> std::process::Child {
    let mut command = ros.command("/usr/lib/rosbag/record");
    let recorder = command.args(["--all", "-O", file]).spawn().expect("rosbag is installed");
    wait_for("the recorder", 20.0, || {
        ros.folder().join(format!("{file}.active")).exists().then_some(())
    });
    recorder
}

fn play(ros: &Ros, file: &str) -> std::process::Child {
    let mut command = ros.command("/usr/lib/rosbag/play");
    let own = ["/robot/joint_states", "/robot/state"].map(str::to_owned);
    let grippers =
        ["left", "right"].map(|limb| format!("/robot/end_effector/{limb}_gripper/state"));
    command.args(["--loop", "--quiet", file, "--topics"]).args(own).args(grippers);
    command.stdin(std::process::Stdio::null()).spawn().expect("rosbag is installed")
}

/// Ends a program as Ctrl-C does.
fn end(child: &mut std::process::Child) {
    let pid = rustix::process::Pid::from_child(child);
    rustix::process::kill_process(pid, Signal::INT).unwrap();
    child.wait().unwrap();
}
