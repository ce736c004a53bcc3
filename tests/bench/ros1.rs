//! From joint states that a robot publishes over ROS 1 to the commands that answer them, through the
//! bridge and the arm, at rest and during picks. The robot, in rospy, takes the times, so its own are included.

use crate::report::Report;
use std::path::Path;
use whichone_tests::ros1::Ros;
use whichone_tests::wait_for;

/// Time at rest, seconds.
const REST_S: u64 = 15;

pub(crate) fn measure(report: &mut Report, quick: bool) {
    if !Path::new("/usr/bin/rosmaster").exists() {
        return crate::report::print("without rosmaster and rospy: the ROS 1 bridge is left out");
    }
    let mut ros = Ros::start();
    let group = ros.group();
    let is_heard = || Some(group.arm()).filter(|arm| arm["hindrance"] == "none");
    wait_for("the robot is heard", 40.0, is_heard);
    ros.robot("latencies");
    let seconds = if quick { REST_S / 3 } else { REST_S };
    std::thread::sleep(std::time::Duration::from_secs(seconds));
    add(report, &mut ros, "at rest");
    for object in if quick { &["clear"][..] } else { &["clear", "white", "metal"] } {
        let outcome = group.fetch("get me the bowl", object);
        assert_eq!(outcome["object"], *object, "{outcome}");
    }
    add(report, &mut ros, "during picks");
    group.down();
}

fn add(report: &mut Report, ros: &mut Ros, when: &str) {
    let taken = ros.robot("latencies");
    let ms: Vec<f64> =
        taken["ms"].as_array().into_iter().flatten().filter_map(|ms| ms.as_f64()).collect();
    let what = format!("ROS 1 joint state to joint command, {when}");
    report.add(&what, "ms", &ms, "rospy robot, bridge, arm, bridge, rospy robot");
}
