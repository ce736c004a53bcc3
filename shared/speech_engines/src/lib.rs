//! Engines of speech: recognisers, voices, and the path of sound from microphones or clients.
//!
//! Invariant: none blocks its caller. Microphone, streams and [`Voice`](voice::Voice) work on
//! threads of their own, behind bounded queues. Errors about missing programs name the package.

pub mod audio;
mod child_process;
pub mod client_streams;
pub mod language_model;
pub mod live_events;
pub mod microphone;
mod pronunciation;
mod random;
pub mod recogniser;
mod server_state;
pub mod stream;
pub mod testing;
pub mod unrecorded_sound;
pub mod vad;
pub mod voice;
pub mod worker_thread;

pub use server_state::Device;

/// True if the second recogniser, whisper.cpp, is compiled in.
pub const WHISPER: bool = cfg!(feature = "whisper");
