//! Why speech cannot be recognised, in words for the operator.

use std::io;
use std::path::PathBuf;

/// Why there is no recogniser.
#[derive(Debug, thiserror::Error)]
pub enum RecogniserUnavailable {
    /// The shared object is missing or is another one.
    #[error("{} cannot be used: {reason} (install the package libpocketsphinx3)", file.display())]
    Library {
        /// The file that was looked for.
        file: PathBuf,
        /// The loader's reason.
        reason: String,
    },
    /// A file of the model is missing.
    #[error("{} cannot be read: {source} (install the package pocketsphinx-en-us)", path.display())]
    Model {
        /// The file.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The scene's dictionary or language model could not be written.
    #[error("{} cannot be written: {source}", path.display())]
    Work {
        /// The file or folder.
        path: PathBuf,
        /// Why not.
        source: io::Error,
    },
    /// The library would not open a decoder.
    #[error("pocketsphinx refused its model: {reason}")]
    Refused {
        /// The last errors that it reported.
        reason: String,
    },
    /// The program of the operator's did not start.
    #[error("{reason} (set speech.recogniser_command to a program and its arguments)")]
    Command {
        /// Why not.
        reason: String,
    },
    /// whisper.cpp is asked for and not part of this build.
    #[error(
        "speech.toml: recogniser: `whisper` is not part of this build \
         (build with `--features speech/whisper`, or WHICHONE_FEATURES=speech/whisper scripts/run; or use `command`)"
    )]
    WhisperNotBuilt,
    /// The model file is missing, damaged or of another kind.
    #[error("{} cannot be used: {reason} (set speech.whisper_model to a model of whisper.cpp, ggml-….bin)", path.display())]
    WhisperModel {
        /// The file.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
}
