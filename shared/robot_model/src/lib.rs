//! Robots from description files: links, joints, limits, shapes and named postures.
//!
//! [`Robot::read`] reads a URDF, and an SRDF beside it for named postures and for the links that may
//! touch. It reports every problem of both at once, each with its line and help. [`Robot::baxter`] is
//! the built-in robot, from the files in `config/robots`.
//!
//! This crate is pure: no IO, no clock, no threads. Units are metres, radians, kilograms and
//! seconds; a pose places a frame in its parent's frame, or, where it says so, in the root's.
//!
//! ```
//! let robot = robot_model::Robot::baxter();
//! let arm = robot.chain("left_gripper")?;
//! let q = [0.0, -0.55, 0.0, 0.75, 0.0, 1.26, 0.0];
//! assert_eq!(arm.movable().count(), q.len());
//! assert!((arm.forward(&q).translation.x - 0.646258).abs() < 1e-6);
//! # Ok::<(), robot_model::UnknownLink>(())
//! ```

mod builtin;
mod jaw;
mod kinematics;
mod model;
mod read;

pub use builtin::{BAXTER_SRDF, BAXTER_URDF};
pub use jaw::Jaw;
pub use kinematics::{SerialChain, UnknownLink};
pub use model::{
    Body, Inertial, Joint, JointKind, Limits, Link, Mimic, Posture, Rgba, Robot, Shape,
};
