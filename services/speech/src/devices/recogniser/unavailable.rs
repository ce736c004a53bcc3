//! Reasons why speech cannot be recognised, for the operator.

use std::io;
use std::path::PathBuf;

/// Error of opening a recogniser.
#[derive(Debug, thiserror::Error)]
pub enum RecogniserUnavailable {
    /// The shared object is missing or incompatible.
    #[error("{} cannot be loaded: {reason}; help: install the package libpocketsphinx3", file.display())]
    Library {
        /// The file.
        file: PathBuf,
        /// Reason given by the loader.
        reason: String,
    },
    /// A file of the model is missing.
    #[error("{} cannot be read: {source}; help: install the package pocketsphinx-en-us", path.display())]
    Model {
        /// The file.
        path: PathBuf,
        /// Reason.
        source: io::Error,
    },
    /// The scene's dictionary or language model could not be written.
    #[error("{} cannot be written: {source}", path.display())]
    Work {
        /// The file or folder.
        path: PathBuf,
        /// Reason.
        source: io::Error,
    },
    /// The library rejected its model.
    #[error("pocketsphinx rejected its model: {reason}")]
    Refused {
        /// The last errors that it logged.
        reason: String,
    },
    /// The operator's program cannot be started.
    #[error("{reason}; help: set speech.recogniser_command to a program and its arguments")]
    Command {
        /// Reason.
        reason: String,
    },
    /// whisper.cpp is not part of this build.
    #[error(
        "speech.toml: recogniser: `whisper` is not part of this build; \
         help: build with `--features speech/whisper` (WHICHONE_FEATURES=speech/whisper scripts/run), or set `command`"
    )]
    WhisperNotBuilt,
    /// The model file is missing or invalid.
    #[error("{} cannot be loaded: {reason}; help: set speech.whisper_model to a model of whisper.cpp, ggml-….bin", path.display())]
    WhisperModel {
        /// The file.
        path: PathBuf,
        /// Reason.
        reason: String,
    },
}
