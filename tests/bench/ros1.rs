//! From joint states that a robot publishes over ROS 1 to the commands that answer them, through the
//! bridge and the arm, at rest and during picks. The robot, in rospy, takes the times, so its own are included.

use crate::report::Report;
use std::path::Path;
use std::time::Duration;
use whichone_tests::ros1::Ros;
use whichone_tests::wait_for;

/// Time at rest, seconds.
const REST_S: u64 = 15;

/// A program in rospy that answers joint states itself.
const ECHO: &str = "ROS 1 joint state to joint command, rospy alone";

pub(crate) fn measure(report: &mut Report, quick: bool) {
    if !Path::new("/usr/bin/rosmaster").exists() {
        return crate::report::print("without rosmaster and rospy: the ROS 1 bridge is left out");
    }
    let rest = Duration::from_secs(if quick { REST_S / 3 } else { REST_S });
    let mut ros = Ros::start();
    let mut echo = ros.command("/usr/bin/python3");
    let echo = echo.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/ros1/echo.py")).spawn();
    let mut echo = echo.expect("python3 is installed");
    let is_answered = |ros: &mut Ros| ros.robot("look")["commands"].as_u64().filter(|n| *n > 100);
    wait_for("the first answers", 40.0, || is_answered(&mut ros));
    report.add(ECHO, "ms", &latencies(&mut ros, rest), "rospy robot, rospy, rospy robot");
    echo.kill().and_then(|()| echo.wait()).expect("a child of ours");

    let group = ros.group();
    let is_heard = || Some(group.arm()).filter(|arm| arm["hindrance"] == "none");
    wait_for("the robot is heard", 40.0, is_heard);
    let at_rest = latencies(&mut ros, rest);
    for object in if quick { &["clear"][..] } else { &["clear", "white", "metal"] } {
        let outcome = group.fetch("get me the bowl", object);
        assert_eq!(outcome["object"], *object, "{outcome}");
    }
    let picking = taken(&mut ros);
    for (samples, when) in [(at_rest, "at rest"), (picking, "during picks")] {
        let what = format!("ROS 1 joint state to joint command, {when}");
        report.add_beside(
            &what,
            "ms",
            &samples,
            ECHO,
            "rospy robot, bridge, arm, bridge, rospy robot",
        );
    }
    group.down();
}

/// Latencies of this time, ms.
fn latencies(ros: &mut Ros, time: Duration) -> Vec<f64> {
    taken(ros);
    std::thread::sleep(time);
    taken(ros)
}

/// Latencies since the last call, ms.
fn taken(ros: &mut Ros) -> Vec<f64> {
    let taken = ros.robot("latencies");
    taken["ms"].as_array().into_iter().flatten().filter_map(|ms| ms.as_f64()).collect()
}
