//! Motion planning for a robot with one or two arms of five to seven joints, such as Baxter: forward and inverse
//! kinematics, collision checking, trajectories, and plans that fetch an object, put it back or
//! point at it.
//!
//! This crate is pure: no IO, no clock, no threads; equal arguments give equal results. Plans keep
//! the joint limits to the last bit and the velocity, acceleration and jerk limits at every
//! instant, and touch nothing in the planning scene. What cannot be planned is a typed error.
//!
//! Units are metres, radians and seconds throughout; poses are in frame `base` of the robot
//! description unless stated otherwise. `<limb>_gripper` is the frame at the end of a limb's chain;
//! on Baxter the tip of the electric gripper with extended fingers, 0.1577 m past the hand.
//!
//! Start at [`Robot`], then [`plan_pick`].

mod collision;
pub mod gripper;
mod kinematics;
mod planning;
pub mod pose_array;
mod random;
mod robot;
#[cfg(test)]
mod samples;
mod trajectory;

pub use collision::{ArmShape, Capsule, Clearance, Cuboid, Gap};
pub use kinematics::chain::{Chain, Frame, Jacobian, LineError};
pub use kinematics::inverse::{IkSolution, TOLERANCE_M, TOLERANCE_RAD, Unreachable};
pub use kinematics::limb::{JOINTS, Joints, Limb};
pub use kinematics::limits::{MotionLimits, PositionLimits};
pub use planning::{
    Grasp, GraspError, OUTSIDE_MAX_RAD, ObjectPose, PlanError, PlanSettings, check_reachable,
    fetching_limb, plan_delivery, plan_pick, plan_point, plan_put_back, plan_put_down,
    plan_retreat, plan_return, plan_withdrawal,
};
pub use robot::{Arm, Robot, Unsuitable};
pub use trajectory::{
    INTERVALS_MIN, Moment, Path, Phase, Stage, State, Timeline, Trajectory, TrajectoryError,
};
