//! Goals and results of `control_msgs`, field by field in the order of their definitions.

use serde::{Deserialize, Serialize};

use crate::types::{Header, JointState, Quaternion, Time, Vector3};

/// `trajectory_msgs/JointTrajectoryPoint`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointTrajectoryPoint {
    /// Radians.
    pub positions: Vec<f64>,
    /// rad/s; empty if there are none.
    pub velocities: Vec<f64>,
    /// rad/s²; empty if there are none.
    pub accelerations: Vec<f64>,
    /// Newton metres; empty if there are none.
    pub effort: Vec<f64>,
    /// Time from the trajectory's stamp.
    pub time_from_start: Time,
}

/// `trajectory_msgs/JointTrajectory`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointTrajectory {
    /// When it begins; 0: when it arrives.
    pub header: Header,
    /// Names of the joints.
    pub joint_names: Vec<String>,
    /// Its points.
    pub points: Vec<JointTrajectoryPoint>,
}

/// `geometry_msgs/Transform`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Transform {
    /// Metres.
    pub translation: Vector3,
    /// Unit quaternion.
    pub rotation: Quaternion,
}

/// `geometry_msgs/Twist`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Twist {
    /// m/s.
    pub linear: Vector3,
    /// rad/s.
    pub angular: Vector3,
}

/// `trajectory_msgs/MultiDOFJointTrajectoryPoint`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MultiDofPoint {
    /// Unused.
    pub transforms: Vec<Transform>,
    /// Unused.
    pub velocities: Vec<Twist>,
    /// Unused.
    pub accelerations: Vec<Twist>,
    /// Unused.
    pub time_from_start: Time,
}

/// `trajectory_msgs/MultiDOFJointTrajectory`, always empty here.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MultiDofTrajectory {
    /// Unused.
    pub header: Header,
    /// Unused.
    pub joint_names: Vec<String>,
    /// Unused.
    pub points: Vec<MultiDofPoint>,
}

/// `control_msgs/JointTolerance`. 0 means the controller's own, −1 none.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct JointTolerance {
    /// Name of the joint.
    pub name: String,
    /// Radians.
    pub position: f64,
    /// rad/s.
    pub velocity: f64,
    /// rad/s².
    pub acceleration: f64,
}

/// `control_msgs/JointComponentTolerance`, unused.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ComponentTolerance {
    /// Name of the joint.
    pub joint_name: String,
    /// Its component.
    pub component: u16,
    /// Metres or radians.
    pub position: f64,
    /// Per second.
    pub velocity: f64,
    /// Per second squared.
    pub acceleration: f64,
}

/// Goal of `control_msgs/action/FollowJointTrajectory`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TrajectoryGoal {
    /// The trajectory.
    pub trajectory: JointTrajectory,
    /// Empty.
    pub multi_dof_trajectory: MultiDofTrajectory,
    /// Largest errors on the way.
    pub path_tolerance: Vec<JointTolerance>,
    /// Empty.
    pub component_path_tolerance: Vec<ComponentTolerance>,
    /// Largest errors at the end.
    pub goal_tolerance: Vec<JointTolerance>,
    /// Empty.
    pub component_goal_tolerance: Vec<ComponentTolerance>,
    /// Time after the planned end within which the goal must be reached.
    pub goal_time_tolerance: Time,
}

/// Result of `control_msgs/action/FollowJointTrajectory`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct TrajectoryResult {
    /// 0 also for a goal that was cancelled: the status counts.
    pub error_code: i32,
    /// Cause, for people.
    pub error_string: String,
}

/// Goal of `control_msgs/action/GripperCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GripperGoal {
    /// Position.
    pub position: f64,
    /// Largest effort.
    pub max_effort: f64,
}

/// Result of `control_msgs/action/GripperCommand`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GripperResult {
    /// Position.
    pub position: f64,
    /// Effort.
    pub effort: f64,
    /// The fingers stopped at something.
    pub stalled: bool,
    /// The fingers are at the position.
    pub reached_goal: bool,
}

/// Goal of `control_msgs/action/ParallelGripperCommand`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ParallelGoal {
    /// Name, position and effort of one joint.
    pub command: JointState,
}

/// Result of `control_msgs/action/ParallelGripperCommand`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ParallelResult {
    /// State of the joint.
    pub state: JointState,
    /// The fingers stopped at something.
    pub stalled: bool,
    /// The fingers are at the position.
    pub reached_goal: bool,
}

/// The beginning of any feedback; the rest differs between versions of `control_msgs` and is not needed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Feedback {}

impl TrajectoryGoal {
    /// Returns a goal for these joints, with the same tolerances for each.
    pub fn new(joints: &[String], trajectory: JointTrajectory, within: Tolerances) -> Self {
        let each = |position| {
            let of = |name: &String| JointTolerance {
                name: name.clone(),
                position,
                ..JointTolerance::default()
            };
            joints.iter().map(of).collect()
        };
        Self {
            trajectory,
            path_tolerance: each(within.path_rad),
            goal_tolerance: each(within.goal_rad),
            goal_time_tolerance: seconds(within.goal_time_s),
            ..Self::default()
        }
    }
}

/// Tolerances of a goal, for each joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Error on the way, radians.
    pub path_rad: f64,
    /// Error at the end, radians.
    pub goal_rad: f64,
    /// Time allowed after the planned end, seconds.
    pub goal_time_s: f64,
}

/// Returns `builtin_interfaces/Duration` for a time of at least 0 s.
pub fn seconds(seconds: f64) -> Time {
    Time::new(std::time::Duration::from_secs_f64(seconds.clamp(0.0, 1e6)))
}
