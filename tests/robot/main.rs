//! The arm with its driver for a Baxter on the simulated robot: both reducers in one thread, in
//! simulated time, with every fault that the robot can be given.

#![allow(clippy::unwrap_used, reason = "a test without a value fails")]

mod camera;
mod faults;
mod picks;
mod stops;
mod world;
