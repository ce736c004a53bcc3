//! Objects from perception: reports of sources, and the tracker that makes a table of them.
//!
//! This crate is pure: no IO, no clock, no threads. Positions are metres in frame `base`, angles
//! radians, times those of the machine's monotonic clock.

mod checks;
mod estimate;
mod labels;
mod names;
mod rotation;
mod sighting;
mod tracker;

#[cfg(test)]
mod tests;

pub use checks::in_base;
pub use estimate::Estimate;
pub use labels::is_known;
pub use rotation::Rotation;
pub use sighting::{Change, Detection, Frame, Look, Refusal, Sighting};
pub use tracker::{Hiding, Live, Settings, Tracker};
