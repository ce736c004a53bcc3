//! Checks of a scene on a robot before anything moves, and the durations that planners pay for
//! questions and that studies count.
//!
//! This crate is pure, except for [`load`], which reads configurations and checks the reach.

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

pub use arrange::{Arrangement, GAP_M, rounded};
pub use load::{Watch, durations, examine, load, load_known};
pub use measure::measure;
pub use motion::{Extent, MotionError, Motions, Refusal};
pub use reach::pose;
pub use setup::ArmSetup;
pub use speech::{Pace, Voice};
