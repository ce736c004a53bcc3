//! Motions in time: joint paths, their timing within the limits, and how they are stopped.
//!
//! A collision-free `joint_path` becomes a smooth [`Path`]; `timing` finds the fastest motion along
//! it within velocity and acceleration limits, `profile` and `smoothed_trajectory` bound the jerk,
//! and `time_scaling` slows a motion down on its own path. The result is a [`Trajectory`];
//! a [`Timeline`] is a sequence of them with the gripper's widths.

pub(crate) mod joint_path;
mod joint_trajectory;
mod path;
mod profile;
mod smoothed_trajectory;
mod time_scaling;
mod timeline;
mod timing;

pub(crate) use joint_trajectory::refuse_outside;
pub use joint_trajectory::{INTERVALS_MIN, Trajectory, TrajectoryError};
pub use path::Path;
pub use profile::State;
pub use timeline::{Moment, Phase, Stage, Timeline};
