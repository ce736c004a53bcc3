//! Recognition with whisper.cpp and a model file of the operator's: behind the feature `whisper`,
//! because building it takes a C++ compiler, cmake and libclang.
//!
//! Invariant: a model file is looked through before the library sees it, since the library takes
//! the beginning of a file for the whole and ends the process over some damaged ones.

#[cfg(feature = "whisper")]
mod engine;
// Without the feature these two are compiled for their tests alone.
#[cfg(any(feature = "whisper", test))]
mod model_file;
#[cfg(test)]
mod testing;
#[cfg(any(feature = "whisper", test))]
mod wording;

use std::path::PathBuf;
use std::time::Duration;

use scene::Scene;

use super::{Recogniser, RecogniserUnavailable};

/// Which model, and how long it may take.
#[derive(Clone, Debug, PartialEq)]
pub struct WhisperOptions {
    /// The model, a file of whisper.cpp's own kind (`ggml-….bin`).
    pub model: PathBuf,
    /// What an utterance may take at most. It is looked at between the parts of the network, so an
    /// answer may be later by the largest of them.
    pub deadline: Duration,
}

impl WhisperOptions {
    /// The model with the usual limit.
    pub fn new(model: impl Into<PathBuf>) -> Self {
        Self { model: model.into(), deadline: Duration::from_secs(20) }
    }

    /// Loads the model for a scene.
    ///
    /// # Errors
    /// If the file is missing, damaged or of another kind.
    #[cfg(feature = "whisper")]
    pub fn open(&self, scene: &Scene) -> Result<Box<dyn Recogniser>, RecogniserUnavailable> {
        match engine::Engine::open(scene, self) {
            Ok(engine) => Ok(Box::new(engine)),
            Err(reason) => {
                Err(RecogniserUnavailable::WhisperModel { path: self.model.clone(), reason })
            }
        }
    }

    /// Loads the model for a scene, in builds that have the library.
    ///
    /// # Errors
    /// This build has it not.
    #[cfg(not(feature = "whisper"))]
    pub fn open(&self, _: &Scene) -> Result<Box<dyn Recogniser>, RecogniserUnavailable> {
        Err(RecogniserUnavailable::WhisperNotBuilt)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::bowls;

    fn refusal(options: &WhisperOptions) -> String {
        match options.open(&bowls()) {
            Ok(_) => panic!("it opened"),
            Err(error) => error.to_string(),
        }
    }

    #[cfg(not(feature = "whisper"))]
    #[test]
    fn a_build_without_it_names_key_and_cure() {
        let told = refusal(&WhisperOptions::new("/no/such/ggml-model.bin"));
        assert!(told.starts_with("speech.toml: recogniser: `whisper`"), "{told}");
        assert!(told.contains("--features speech/whisper") && told.contains("`command`"), "{told}");
    }

    #[cfg(feature = "whisper")]
    #[test]
    fn a_file_that_is_missing_or_cut_short_is_named_with_the_cure() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("ggml-model.bin");
        let model = WhisperOptions::new(&path);
        let told = refusal(&model);
        assert!(told.contains("ggml-model.bin cannot be used: No such file"), "{told}");
        assert!(told.contains("speech.whisper_model"), "{told}");
        std::fs::write(&path, &testing::model(1)[..1_000_000]).unwrap();
        let told = refusal(&model);
        assert!(told.contains("is cut short"), "{told}");
    }
}
