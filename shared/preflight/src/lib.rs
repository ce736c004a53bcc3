//! How long everything takes that robot and person do: the seconds that planners pay for questions
//! and that studies count.
//!
//! This crate is pure: no IO, no clock, no threads.
//!
//! | what | where |
//! |---|---|
//! | how long the arm takes, by its own trajectories | `motion.rs` |
//! | how long speech takes: the robot's, the person's, and until it is recognised | `speech.rs` |
//! | both together: the seconds of every question and pick in a scene | `measure.rs` |

mod draw;
mod measure;
mod motion;
mod speech;
#[cfg(test)]
mod testing;

pub use draw::{between, log_normal};
pub use measure::measure;
pub use motion::{Extent, MotionError, Motions, Refusal};
pub use speech::{Pace, Voice};
