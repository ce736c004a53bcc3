//! Judgement of recognised speech: the recognisers to ask, and the words meant for the robot.

mod ensemble;
mod gate;
mod heard;

pub use ensemble::{Ensemble, is_voice};
pub use gate::{Gate, Rejected};
pub use heard::{Heard, SecondView};

#[cfg(test)]
mod tests;
