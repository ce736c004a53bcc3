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
mod block;
mod cartesian;
mod chain;
mod clearance;
mod clock;
mod course;
mod grasp;
pub mod gripper;
mod held;
mod inverse;
mod limb;
pub mod limits;
mod path;
mod plan;
mod profile;
mod robot;
mod route;
#[cfg(test)]
mod samples;
mod shape;
mod timeline;
mod timing;
mod trajectory;
mod trig;

pub use crate::robot::{Arm, Robot, Unsuitable};
pub use cartesian::LineError;
pub use chain::{Axis, Chain, Frame, Jacobian, ZeroPosture};
pub use clearance::{ArmShape, Clearance, Gap};
pub use grasp::{Grasp, GraspError, ObjectPose};
pub use gripper::attached_pose;
pub use inverse::{IkSolution, TOLERANCE_M, TOLERANCE_RAD, Unreachable};
pub use limb::{JOINTS, Joints, Limb};
pub use limits::{MotionLimits, PositionLimits};
pub use path::Path;
pub use plan::{
    Arms, PickPhase, PickPlan, PlanError, PlanSettings, PointPhase, PointPlan, check_reachable,
    plan_delivery, plan_pick, plan_point, plan_return,
};
pub use profile::State;
pub use shape::{Capsule, Cuboid};
pub use timeline::{Moment, Stage, Timeline};
pub use trajectory::{INTERVALS_MIN, Trajectory, TrajectoryError};
