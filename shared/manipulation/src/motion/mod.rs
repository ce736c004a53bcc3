//! Motions in time: paths, how fast they can be followed within the limits, and how they are stopped.
//!
//! A way through joint space (`route`) becomes a smooth [`Path`]; `timing` finds the fastest way along
//! it within velocity and acceleration limits, `profile` and `course` bound the jerk, and `clock` slows
//! a motion down on its own curve. [`Trajectory`] is what comes out, [`Timeline`] several of them with
//! what the gripper does.

mod clock;
mod course;
mod path;
mod profile;
pub(crate) mod route;
mod timeline;
mod timing;
mod trajectory;

pub use path::Path;
pub use profile::State;
pub use timeline::{Moment, Stage, Timeline};
pub(crate) use trajectory::refuse_outside;
pub use trajectory::{INTERVALS_MIN, Trajectory, TrajectoryError};
