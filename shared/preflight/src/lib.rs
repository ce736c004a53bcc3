//! Checks of a scene on a robot before anything moves, and the durations that planners pay for
//! questions and that studies count.
//!
//! This crate is pure, except for [`load`], which reads configurations and checks the reach.
//!
//! | contents | file |
//! |---|---|
//! | loading a configuration with all checks | `load.rs` |
//! | robot, limb and plan settings from a configuration | `setup.rs` |
//! | reachability of every object | `reach.rs` |
//! | places for objects that cannot be reached | `arrange.rs` |
//! | durations of the arm's trajectories | `motion.rs` |
//! | durations of speech: robot, person, recogniser | `speech.rs` |
//! | durations of every question and pick in a scene | `measure.rs` |

mod arrange;
mod load;
mod measure;
mod motion;
mod reach;
mod setup;
mod speech;
#[cfg(test)]
mod testing;
#[cfg(test)]
mod tests;

pub use arrange::Arrangement;
pub use load::{Watch, durations, examine, load, load_known};
pub use measure::measure;
pub use motion::{Extent, MotionError, Motions, Refusal};
pub use reach::pose;
pub use setup::ArmSetup;
pub use speech::{Pace, Voice};
