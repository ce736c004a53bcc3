//! Engines of speech: recognisers, voices, and the way of sound from a microphone or a client to them.
//!
//! They know a scene's words and nothing of the dialogue, the configuration or the journal. The
//! speech service chooses them by its configuration, and judges their results. A recogniser
//! implements [`recogniser::Recogniser`]; a voice is a [`voice::Program`].
//!
//! Invariant: none blocks its caller. Microphone, streams and [`Voice`](voice::Voice) work on threads of their own,
//! behind bounded queues. An error about a missing library or program names its package.

pub mod audio;
mod child_process;
pub mod client_streams;
pub mod language_model;
pub mod live_events;
pub mod microphone;
mod pronunciation;
mod random;
pub mod recogniser;
pub mod stream;
pub mod testing;
pub mod unrecorded_sound;
pub mod vad;
pub mod voice;
pub mod worker_thread;
