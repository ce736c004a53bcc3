//! The reader and the kinematics of descriptions, against reference data and bad files.

#![allow(clippy::unwrap_used, reason = "tests")]

mod builtin;
mod faults;
mod mutations;
mod other_robots;
mod reference;
mod samples;
