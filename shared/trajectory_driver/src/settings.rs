//! `[trajectory]` of `arm.toml`: controllers, names and tolerances.

use config::{Check, Section};
use diagnostics::Fields;
use ros::detectors::topic;

/// Names of the controllers, and tolerances of the arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Controllers {
    /// The arm's action, of type `control_msgs/action/FollowJointTrajectory`.
    pub action: String,
    /// Topic of `sensor_msgs/JointState`.
    pub joint_states: String,
    /// The controller's names of the joints, shoulder first; empty: those of the robot's description.
    pub joints: Vec<String>,
    /// The gripper.
    pub gripper: GripperController,
    /// Maximum tracking error of a joint during a motion, radians.
    pub path_tolerance_rad: f64,
    /// Maximum error of a joint at the end of a motion, radians.
    pub goal_tolerance_rad: f64,
    /// Time allowed for settling after the end of a motion, seconds.
    pub goal_time_s: f64,
    /// Speed below which a joint counts as stationary, rad/s.
    pub still_rad_s: f64,
    /// Age at which joint states are stale, seconds.
    pub stale_s: f64,
}

/// The gripper's controller.
#[derive(Clone, Debug, PartialEq)]
pub struct GripperController {
    /// Its action.
    pub action: String,
    /// Type of the action.
    pub kind: GripperKind,
    /// The joint that it moves, as joint states name it.
    pub joint: String,
    /// Position of closed fingers, in the controller's unit.
    pub closed: f64,
    /// Position of open fingers.
    pub open: f64,
    /// Effort with which objects are gripped.
    pub effort: f64,
}

/// Type of a gripper's action.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GripperKind {
    /// `control_msgs/action/GripperCommand`.
    Command,
    /// `control_msgs/action/ParallelGripperCommand`.
    Parallel,
}

impl GripperController {
    /// Returns the position at a share of the fingers' travel, per cent: 0 closed, 100 open.
    pub fn position(&self, percent: f64) -> f64 {
        self.closed + (self.open - self.closed) * percent / 100.0
    }

    /// Returns the share of the fingers' travel at a position, per cent.
    pub fn percent(&self, position: f64) -> f64 {
        (100.0 * (position - self.closed) / (self.open - self.closed)).clamp(0.0, 100.0)
    }
}

impl Section for Controllers {
    const KEY: &'static [&'static str] = &["arm", "trajectory"];

    fn read(f: &mut Fields<'_>) -> Self {
        Self {
            action: topic(f, "action").unwrap_or_default(),
            joint_states: topic(f, "joint_states").unwrap_or_default(),
            joints: joints(f),
            gripper: f.table("gripper", gripper),
            path_tolerance_rad: f.number("path_tolerance_rad", 0.01..=1.0),
            goal_tolerance_rad: f.number("goal_tolerance_rad", 0.001..=0.1),
            goal_time_s: f.number("goal_time_s", 0.1..=60.0),
            still_rad_s: f.number("still_rad_s", 0.005..=0.5),
            stale_s: f.number("stale_s", 0.03..=1.0),
        }
    }

    fn check(&self, others: &mut Check<'_>) {
        let is_used = others.arm.driver == crate::NAME;
        let services = &others.group.services;
        if is_used && !services.iter().any(|service| service.name == crate::BRIDGE) {
            let what =
                "driver = \"trajectory\", but no service carries its orders to the controllers";
            let help = "add [group.services.trajectory], or use --profile trajectory";
            others.problem(&["arm", "driver"], what, help);
        }
    }
}

fn joints(f: &mut Fields<'_>) -> Vec<String> {
    let joints = f.texts("joints");
    for (n, joint) in joints.iter().enumerate() {
        if joints[..n].contains(joint) && !f.is_wrong("joints") {
            let what = format!("`{joint}` is there twice");
            f.problem("joints", what, "name each joint of the arm once, shoulder first");
        }
    }
    if !joints.is_empty() && !(5..=7).contains(&joints.len()) && !f.is_wrong("joints") {
        let what =
            format!("expected the names of five, six or seven joints, found {}", joints.len());
        f.problem("joints", what, "name each joint of the arm, shoulder first, or write []");
    }
    joints
}

fn gripper(f: &mut Fields<'_>) -> GripperController {
    let gripper = GripperController {
        action: topic(f, "action").unwrap_or_default(),
        kind: f.choice(
            "kind",
            &[
                ("GripperCommand", GripperKind::Command),
                ("ParallelGripperCommand", GripperKind::Parallel),
            ],
        ),
        joint: f.text("joint"),
        closed: f.number("closed", -10.0..=10.0),
        open: f.number("open", -10.0..=10.0),
        effort: f.number("effort", 0.0..=1000.0),
    };
    if (gripper.open - gripper.closed).abs() < 1e-3 && !f.is_wrong("open") {
        let what = format!("is {}, as `closed`", gripper.open);
        f.problem("open", what, "write the position of the open fingers");
    }
    gripper
}
