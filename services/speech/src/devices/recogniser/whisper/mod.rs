//! Recognition with whisper.cpp and a model file of the operator's: behind the feature `whisper`,
//! because building it requires a C++ compiler, cmake and libclang.

#[cfg(feature = "whisper")]
mod engine;

use std::path::PathBuf;
use std::time::Duration;

use super::{Recogniser, RecogniserUnavailable};

#[cfg(not(feature = "whisper"))]
const NOT_BUILT: &str = "speech.toml: recogniser: `whisper` is not part of this build; \
    help: build with `--features speech/whisper` (WHICHONE_FEATURES=speech/whisper scripts/run), or set `command`";

/// Model file and time limit.
#[derive(Clone, Debug, PartialEq)]
pub struct WhisperOptions {
    /// Model file in whisper.cpp's own format (`ggml-….bin`).
    pub model: PathBuf,
    /// Time limit per utterance. It is checked between the parts of the network, so an answer may be
    /// late by the duration of the largest part.
    pub deadline: Duration,
}

impl WhisperOptions {
    /// Returns options for the model with the default limit.
    pub fn new(model: impl Into<PathBuf>) -> Self {
        Self { model: model.into(), deadline: Duration::from_secs(20) }
    }

    /// Loads the model.
    ///
    /// # Errors
    /// If the file is missing or the library rejects it, or this build lacks the library.
    pub fn open(&self) -> Result<Box<dyn Recogniser>, RecogniserUnavailable> {
        #[cfg(not(feature = "whisper"))]
        return Err(RecogniserUnavailable(NOT_BUILT.to_owned()));
        #[cfg(feature = "whisper")]
        match engine::Engine::open(self) {
            Ok(engine) => Ok(Box::new(engine)),
            Err(reason) => Err(RecogniserUnavailable(format!(
                "{} cannot be loaded: {reason}; help: set speech.whisper_model to a model of \
                 whisper.cpp, ggml-….bin",
                self.model.display()
            ))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whisper_names_what_is_missing() {
        let Err(error) = WhisperOptions::new("/no/such/ggml-model.bin").open() else {
            panic!("a missing model opened")
        };
        let help = if cfg!(feature = "whisper") {
            "speech.whisper_model"
        } else {
            "speech.toml: recogniser: `whisper` is not part of this build"
        };
        assert!(error.to_string().contains(help), "{error}");
    }
}
