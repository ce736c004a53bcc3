//! The driver `trajectory` against controllers of ros2_control over rclpy: dialogues, stops, kills and every fault.

use rustix::process::{Pid, Signal, kill_process};
use serde_json::Value;
use whichone_tests::controllers::Controllers;
use whichone_tests::{Group, number, wait_for};

/// Longest time from a death to rest: a window and its ramp.
const REST_S: f64 = 0.65;
/// A speed that the arm has in the middle of a motion alone, rad/s.
const FAST_RAD_S: f64 = 0.3;

/// The objects that dialogues ask for in turn.
const WANTED: [&str; 4] = ["red_small", "blue_small", "red_large", "blue_large"];

fn wait_for_arm(group: &Group, what: &str, holds: impl Fn(&Value) -> bool) {
    wait_for(what, 60.0, || Some(group.arm()).filter(&holds));
}

fn fetch(group: &Group, object: &str) {
    let outcome = group.fetch("get me the block", object);
    let facts = (&outcome["outcome"], &outcome["object"]);
    assert_eq!(facts, (&"delivered".into(), &object.into()), "{outcome}\n{}", group.logs());
}

/// Begins a fetch and waits for the middle of a motion.
fn set_out(group: &Group, controllers: &mut Controllers) {
    group.say("get me the small red block");
    controllers.wait_for_speed(FAST_RAD_S);
}

/// The arm is at rest, and nothing that waits makes it move.
fn assert_stands(controllers: &mut Controllers) {
    let before = controllers.look();
    std::thread::sleep(std::time::Duration::from_millis(1_500));
    let after = controllers.look();
    assert_eq!(before["q"], after["q"], "{before}\n{after}");
}

/// `scripts/ros2 test` has what they need.
mod ros2_rclpy_controllers {
    use super::*;

    /// `WHICHONE_DIALOGUES` says how many, 10 by default.
    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn dialogues_end_with_the_right_object() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        let count = number("WHICHONE_DIALOGUES").unwrap_or(10) as usize;
        for n in 0..count {
            fetch(&group, WANTED[n % WANTED.len()]);
        }
        let seen = controllers.look();
        eprintln!("{count} dialogues: {seen}");
        let of = |key: &str| seen[key].as_u64().unwrap();
        assert_eq!((of("refused"), of("aborted")), (0, 0), "{seen}");
        assert!(of("replaced") > of("succeeded") && of("succeeded") >= 3 * count as u64, "{seen}");
        group.verify_journals();
        group.down();
    }

    /// Goals that are replaced end as cancelled there, joint states have no velocities, and a grasp ends as aborted.
    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn humble_states_without_velocities_and_a_parallel_gripper_will_do() {
        let parallel = "ParallelGripperCommand";
        let options = ["--distribution", "humble", "--no-velocities", "--gripper", parallel];
        let mut controllers = Controllers::start(&options);
        let kind = format!("arm.trajectory.gripper.kind={parallel}");
        let group = controllers.group(&[&kind]);
        fetch(&group, "red_small");
        let seen = controllers.look();
        assert_eq!((&seen["aborted"], &seen["refused"]), (&0.into(), &0.into()), "{seen}");
        group.down();
    }

    /// `WHICHONE_STOPS` says how many, 20 by default.
    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn every_stop_is_followed_by_rest_and_the_pick_goes_on() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        let mut seconds: Vec<f64> = Vec::new();
        let count = number("WHICHONE_STOPS").unwrap_or(20) as usize;
        for _ in 0..count {
            if group.arm()["phase"] != "moving" {
                group.say("get me the small red block");
            }
            controllers.wait_for_speed(FAST_RAD_S);
            let since = controllers.now();
            group.must(&["stop-motion"]);
            let arm = group.arm();
            assert_eq!((&arm["stopped"], &arm["moving"]), (&true.into(), &false.into()), "{arm}");
            seconds.push(controllers.rest_after(since));
            assert_stands(&mut controllers);
            group.release_stop();
        }
        seconds.sort_by(f64::total_cmp);
        let (median, worst) = (seconds[count / 2], seconds[count - 1]);
        eprintln!("{count} stops: rest after {median:.3} s median, {worst:.3} s worst");
        assert!(worst <= 1.0, "{seconds:?}");
        group.down();
    }

    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn arm_comes_to_rest_when_its_process_the_bridge_or_both_are_killed() {
        let mut controllers = Controllers::start(&[]);
        let stays = |service: &str| format!("group.services.{service}.restart=never");
        let group = controllers.group(&[&stays("arm"), &stays("trajectory")]);
        for killed in [&["arm"][..], &["trajectory"], &["arm", "trajectory"]] {
            set_out(&group, &mut controllers);
            let pids: Vec<Pid> = killed.iter().map(|service| group.pid(service)).collect();
            controllers.wait_for_speed(FAST_RAD_S);
            let since = controllers.now();
            pids.into_iter().for_each(|pid| kill_process(pid, Signal::KILL).unwrap());
            let seconds = controllers.rest_after(since);
            eprintln!("{killed:?} killed: rest after {seconds:.3} s");
            assert!(seconds <= REST_S, "{killed:?}: {seconds} s");
            // They return, and the pick goes on.
            killed.iter().for_each(|service| drop(group.must(&["start", service])));
            let outcome = group.await_pick(None);
            assert_eq!(outcome["outcome"], "delivered", "{killed:?}: {outcome}\n{}", group.logs());
            wait_for_arm(&group, "rest", |arm| arm["moving"] == false);
        }
        group.verify_journals();
        group.down();
    }

    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn blocked_arm_ends_the_pick_and_stands() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        set_out(&group, &mut controllers);
        controllers.tell("block 1");
        wait_for_arm(&group, "the obstacle is noticed", |arm| arm["outcome"] == "blocked");
        controllers.tell("block 0");
        assert_stands(&mut controllers);
        group.release_stop();
        group.down();
    }

    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn frozen_joint_states_stop_the_arm_until_they_return() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        set_out(&group, &mut controllers);
        let since = controllers.now();
        controllers.tell("freeze 1");
        wait_for_arm(&group, "silence is noticed", |arm| arm["hindrance"] == "stale");
        let seconds = controllers.rest_after(since);
        assert!(seconds <= 1.0, "{seconds} s");
        assert_stands(&mut controllers);
        controllers.tell("freeze 0");
        assert_eq!(group.await_pick(None)["outcome"], "delivered", "{}", group.logs());
        group.down();
    }

    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn refusing_controller_is_named_and_nothing_moves() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        controllers.tell("refuse 1");
        group.say("get me the small red block");
        wait_for_arm(&group, "the refusal", |arm| arm["outcome"] == "blocked");
        group.wait_for_log("arm", "is it active");
        assert_stands(&mut controllers);
        group.down();
    }

    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn silent_and_dying_controllers_are_noticed_and_their_return_too() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        set_out(&group, &mut controllers);
        let since = controllers.now();
        controllers.tell("deaf 1");
        wait_for_arm(&group, "silence is noticed", |arm| arm["hindrance"] != "none");
        assert!(controllers.rest_after(since) <= 1.0);
        assert_stands(&mut controllers);
        controllers.tell("deaf 0");
        assert_eq!(group.await_pick(None)["outcome"], "delivered", "{}", group.logs());

        set_out(&group, &mut controllers);
        controllers.restart();
        wait_for_arm(&group, "death is noticed", |arm| arm["hindrance"] != "none");
        assert_eq!(group.await_pick(None)["outcome"], "delivered", "{}", group.logs());
        group.down();
    }

    #[test]
    #[ignore = "needs rclpy with control_msgs, and whichone-trajectory built with ros2/dds"]
    fn neither_of_two_clients_moves_on() {
        let mut controllers = Controllers::start(&[]);
        let group = controllers.group(&[]);
        // One that is there first.
        controllers.tell("foreign 4");
        wait_for_arm(&group, "the stranger is noticed", |arm| arm["hindrance"] == "error");
        group.wait_for_log("trajectory", "another client");
        assert!(controllers.look()["speed"].as_f64().unwrap() > 0.0, "it is not ours to stop");
        wait_for_arm(&group, "the stranger's end", |arm| arm["hindrance"] == "none");
        // It has moved the arm, which would go to rest: so the stop is latched.
        group.release_stop();
        wait_for_arm(&group, "the way to rest", |arm| arm["stopped"] == false);
        // One that comes between.
        set_out(&group, &mut controllers);
        let since = controllers.now();
        controllers.tell("foreign 4");
        assert!(controllers.rest_after(since) <= 1.5, "both are stopped");
        assert_stands(&mut controllers);
        let arm = group.arm();
        assert!(arm["stopped"] == true || arm["outcome"] == "blocked", "{arm}\n{}", group.logs());
        group.down();
    }
}
