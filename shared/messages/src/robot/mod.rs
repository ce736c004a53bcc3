//! The robot's own topics: commands to and states of a Baxter, in the terms of its interface.
//!
//! Messages have the names, fields and meanings of `baxter_core_msgs`, `sensor_msgs` and
//! `trajectory_msgs`, so that a bridge to ROS copies fields and decides nothing. Differences: a
//! message has a fixed layout, so lists have a length and a bound; header stamps are nanoseconds of
//! this machine's monotonic clock; booleans are bytes.
//!
//! Message facts from baxter_common 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015 Rethink Robotics.

mod end_effector;
mod joints;
mod state;
mod traffic;

pub use end_effector::*;
pub use joints::*;
pub use state::*;
pub use traffic::{Order, Report};
