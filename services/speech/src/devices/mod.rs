//! What the service hears and speaks with: the recogniser, the detector of speech, WAV files, and
//! the voice.
//!
//! Invariant: nothing here decides anything about the dialogue, and nothing here can hold the
//! service up: [`Ear`](ear::Ear) and [`Voice`](voice::Voice) work on threads of their own, behind
//! bounded queues. Where a library or program is missing, the error names the package.

pub mod audio;
pub(crate) mod child;
pub mod client_streams;
pub mod ear;
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
pub mod watched_folder;
