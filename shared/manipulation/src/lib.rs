//! Kinematics of a robot with two arms of seven joints, Baxter above all: where the gripper is,
//! which joint positions reach a pose, and how to move there and fetch an object.
//!
//! This crate is pure: no IO, no clock, no threads, and the same question has the same answer
//! every time. What it returns keeps the joint limits to the last bit, the velocity, acceleration
//! and jerk limits at every instant, and touches nothing that it was told of; what it cannot do is
//! a typed error, never a motion.
//!
//! Units are metres, radians and seconds throughout; poses are in frame `base` of the robot
//! description unless said otherwise. `<limb>_gripper` is the frame that a limb's kinematics end at;
//! on Baxter the tip of the electric gripper with extended fingers, 0.1577 m past the hand.
//!
//! Start at [`Robot`], then [`plan_pick`].

pub mod baxter;
mod chain;
mod clearance;
mod grasp;
pub mod gripper;
mod inverse;
mod limb;
pub mod limits;
mod motion;
mod plan;
mod robot;
#[cfg(test)]
mod samples;

pub use crate::robot::{Arm, Robot, Unsuitable};
pub use chain::{Axis, Chain, Frame, Jacobian, LineError, ZeroPosture};
pub use clearance::{ArmShape, Capsule, Clearance, Cuboid, Gap};
pub use grasp::{Grasp, GraspError, ObjectPose};
pub use gripper::attached_pose;
pub use inverse::{IkSolution, TOLERANCE_M, TOLERANCE_RAD, Unreachable};
pub use limb::{JOINTS, Joints, Limb};
pub use limits::{MotionLimits, PositionLimits};
pub use motion::{
    INTERVALS_MIN, Moment, Path, Stage, State, Timeline, Trajectory, TrajectoryError,
};
pub use plan::{
    Arms, PickPhase, PickPlan, PlanError, PlanSettings, PointPhase, PointPlan, check_reachable,
    plan_delivery, plan_pick, plan_point, plan_return,
};
