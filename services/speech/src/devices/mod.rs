//! The devices of the service: recogniser, voice detector, microphone, WAV files and voice.
//!
//! Invariant: no device decides anything about the dialogue, and none can block the service:
//! [`AsrWorker`](asr_worker::AsrWorker) and [`Voice`](voice::Voice) work on threads of their own,
//! behind bounded queues. An error about a missing library or program names its package.

pub mod asr_worker;
pub mod audio;
pub(crate) mod child_process;
pub mod client_streams;
pub mod language_model;
pub mod microphone;
pub mod pronunciation;
mod random;
pub mod recogniser;
pub mod stream;
#[cfg(test)]
pub(crate) mod testing;
pub mod vad;
pub mod voice;
pub mod worker_thread;
