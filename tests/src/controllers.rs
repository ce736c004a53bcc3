//! Controllers of ros2_control over rclpy, with a simulated arm (`tests/ros2/controllers.py`).

use crate::ros2::{RCLPY, own_domain};
use crate::{Group, program, wait_for};
use serde_json::Value;
use std::io::{BufRead, BufReader, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// Joints of the UR5e, and where they rest.
const JOINTS: &str =
    "shoulder_pan_joint,shoulder_lift_joint,elbow_joint,wrist_1_joint,wrist_2_joint,wrist_3_joint";
const REST: &str = "-0.35,-2.0,2.0,-1.5708,-1.5708,0";
const SCRIPT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/ros2/controllers.py");

/// The controllers of an arm, in a process of their own.
#[derive(Debug)]
pub struct Controllers {
    process: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    domain: u16,
    options: Vec<String>,
}

impl Drop for Controllers {
    fn drop(&mut self) {
        self.kill();
    }
}

impl Controllers {
    /// Starts controllers with further options, in a domain of their own.
    pub fn start(options: &[&str]) -> Self {
        Self::start_in(own_domain(), options.iter().map(|it| (*it).to_owned()).collect())
    }

    fn start_in(domain: u16, options: Vec<String>) -> Self {
        let mut command = Command::new(RCLPY.interpreter());
        command.args([SCRIPT, &domain.to_string(), "--joints", JOINTS]);
        command.args([&format!("--start={REST}"), "--gripper-joint", "finger_1_joint"]);
        command.args(&options).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut process = command.spawn().expect("the interpreter starts");
        let to = process.stdin.take().expect("a pipe");
        let from = BufReader::new(process.stdout.take().expect("a pipe"));
        let mut controllers = Self { process, to, from, domain, options };
        controllers.look();
        controllers
    }

    /// Starts a group whose arm they are, and waits until it can move.
    pub fn group(&mut self, settings: &[&str]) -> Group {
        let own = [
            "group.scene=blocks".to_owned(),
            "arm.robot=ur5e".to_owned(),
            "arm.hand_over_xyz=[0.45, 0.42, 0.25]".to_owned(),
            "arm.table_z_m=0.0".to_owned(),
            "arm.driver=trajectory".to_owned(),
            "arm.time_scale=1.0".to_owned(),
            "arm.trajectory.action=/arm_controller/follow_joint_trajectory".to_owned(),
            "arm.trajectory.gripper.joint=finger_1_joint".to_owned(),
            "arm.trajectory.gripper.open=0.025".to_owned(),
            format!(
                "group.services.trajectory.command=[\"{}\"]",
                program("whichone-trajectory").display()
            ),
            format!("ros2.domain_id={}", self.domain),
        ];
        let own = own.iter().map(String::as_str);
        let group = Group::up(&own.chain(settings.iter().copied()).collect::<Vec<_>>());
        wait_for("the arm can move", 60.0, || (group.arm()["hindrance"] == "none").then_some(()));
        group
    }

    /// Gives a command and returns its answer.
    pub fn tell(&mut self, command: &str) -> Value {
        writeln!(self.to, "{command}").expect("the controllers read");
        let mut line = String::new();
        self.from.read_line(&mut line).expect("the controllers answer");
        serde_json::from_str(&line).unwrap_or_else(|error| panic!("{command}: {error}: {line}"))
    }

    /// Returns what the arm does.
    pub fn look(&mut self) -> Value {
        self.tell("look")
    }

    /// Waits until the arm moves at this speed at least, rad/s.
    pub fn wait_for_speed(&mut self, rad_s: f64) {
        wait_for("a fast motion", 60.0, || (self.look()["speed"].as_f64()? >= rad_s).then_some(()));
    }

    /// Returns the seconds from `since`, a time of the machine's monotonic clock, to the end of the last motion, once the
    /// arm has stood for a second.
    pub fn rest_after(&mut self, since: f64) -> f64 {
        let number = |seen: &Value, key: &str| seen[key].as_f64().expect("a number");
        wait_for("rest", 30.0, || {
            let seen = self.look();
            let moved_at = number(&seen, "moved_at");
            (number(&seen, "now") - moved_at > 1.0).then_some((moved_at - since).max(0.0))
        })
    }

    /// Returns the time of the machine's monotonic clock, seconds.
    pub fn now(&mut self) -> f64 {
        self.tell("now")["now"].as_f64().expect("a number")
    }

    /// Kills the controllers' process.
    pub fn kill(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }

    /// Starts it again, the arm where it rests.
    pub fn restart(&mut self) {
        self.kill();
        *self = Self::start_in(self.domain, self.options.clone());
    }
}
