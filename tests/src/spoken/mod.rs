//! Simulated users who speak to the real group with real sound: synthesised voices over noise,
//! written in real time to where the robot's microphone program reads.
//!
//! | file | holds |
//! |---|---|
//! | `words.rs` | users' understanding of the robot's questions |
//! | `sound.rs` | voices and noise |
//! | `room.rs` | the microphone: a pipe with sound in real time |
//! | `taps.rs` | the robot's topics |
//! | `dialogue.rs` | one dialogue, from a group's start to its end |
//! | `tally.rs` | many dialogues, counted |

mod dialogue;
mod room;
mod sound;
mod tally;
mod taps;
mod words;

pub use dialogue::{Conditions, Ending, Held, converse, second_model};
pub use room::Room;
pub use sound::{Noise, Pink, SPEAKERS, SPEECH_RMS, Speaker, babble, levelled};
pub use tally::{Tally, tally};
