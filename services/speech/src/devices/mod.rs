//! The devices of the service: recogniser, voice detector, microphone, WAV files and voice.
//!
//! Invariant: no device decides anything about the dialogue, and none can block the service:
//! `AsrWorker` and [`Voice`](voice::Voice) work on threads of their own,
//! behind bounded queues. An error about a missing library or program names its package.

pub(crate) mod asr_worker;
pub mod audio;
pub(crate) mod child_process;
pub(crate) mod client_streams;
pub mod language_model;
pub(crate) mod microphone;
mod pronunciation;
mod random;
pub mod recogniser;
pub mod stream;
#[cfg(test)]
pub(crate) mod testing;
pub mod vad;
pub mod voice;
pub mod worker_thread;
