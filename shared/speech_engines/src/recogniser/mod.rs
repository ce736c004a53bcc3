//! Speech recognition: from samples to words.

mod command;
mod ffi;
mod first_view;
mod pocketsphinx;
mod scene_files;
pub mod second_opinion;
mod word_confidence;

use std::io;
use std::ops::Range;
use std::path::Path;

use scene::Scene;

use crate::worker_thread::in_background;

pub use command::{Command, CommandOptions};
pub use first_view::FirstView;
pub use pocketsphinx::{PocketSphinx, PocketSphinxOptions};
pub use second_opinion::{Opinion, PendingOpinion, SecondOpinion};

/// Error of decoding an utterance.
///
/// Contains the reason; the next utterance may succeed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the recogniser failed on this utterance: {0}")]
pub struct RecogniseError(pub String);

/// Error of opening a recogniser: the reason, for the operator.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub enum RecogniserUnavailable {
    /// Something is missing, or does not fit.
    Missing(String),
    /// The disk has no room for its files: it can be opened once there is some.
    Short(String),
}

impl RecogniserUnavailable {
    /// A file of the model is missing.
    fn unreadable(file: &Path, error: &io::Error) -> Self {
        let file = file.display();
        Self::Missing(format!(
            "{file} cannot be read: {error}; help: install the package pocketsphinx-en-us"
        ))
    }

    /// A work file cannot be written.
    fn unwritable(file: &Path, error: &io::Error) -> Self {
        use io::ErrorKind::{FileTooLarge, QuotaExceeded, StorageFull};
        let what = format!("{} cannot be written: {error}", file.display());
        match error.kind() {
            StorageFull | QuotaExceeded | FileTooLarge => Self::Short(what),
            _ => Self::Missing(what),
        }
    }

    /// Returns the error of a rejected model.
    fn rejected(reason: &str) -> Self {
        Self::Missing(format!("pocketsphinx rejected its model: {reason}"))
    }
}

/// Result of recognising an utterance.
pub type Recognition = Result<FirstView, RecogniseError>;

/// A recogniser of whole utterances.
pub trait Recogniser: Send {
    /// Decodes one whole utterance, 16 kHz mono, in which `speech` are the samples of the voice;
    /// the noise is estimated around it.
    ///
    /// # Errors
    /// If the backend fails on these samples.
    fn recognise(&mut self, pcm: &[i16], speech: Range<usize>) -> Recognition;

    /// Returns whether decoding is cheap enough to begin before the utterance's end is certain.
    fn is_quick(&self) -> bool {
        false
    }

    /// Returns a function that opens a decoder of the same words for utterances in progress, if
    /// there is one. It may be called on another thread.
    fn interim_decoder(&self) -> Option<InterimDecoderOpener> {
        None
    }
}

/// Opens an [`InterimDecoder`]; logs the error and returns `None` if that fails.
pub type InterimDecoderOpener = Box<dyn FnOnce() -> Option<Box<dyn InterimDecoder>> + Send>;

/// A rough decoder of speech in progress.
pub trait InterimDecoder: Send {
    /// Begins an utterance; one in progress is abandoned.
    ///
    /// # Errors
    /// If the backend fails.
    fn begin(&mut self) -> Result<(), RecogniseError>;

    /// Decodes the next samples, 16 kHz mono. Returns the words so far, separated by blanks.
    ///
    /// # Errors
    /// If the backend fails on these samples.
    fn decode(&mut self, pcm: &[i16]) -> Result<String, RecogniseError>;
}

/// Hypotheses per utterance.
const N_BEST_MAX: usize = 5;

/// A choice of recogniser.
#[derive(Clone, Debug, PartialEq)]
pub enum Backend {
    /// The offline recogniser with the scene's own language model.
    PocketSphinx(PocketSphinxOptions),
    /// A program chosen by the operator.
    Command(CommandOptions),
}

impl Backend {
    /// Opens the recogniser for a scene. Also returns the scene's words that it cannot recognise.
    ///
    /// # Errors
    /// If a dependency is missing.
    pub fn open(
        &self,
        scene: &Scene,
    ) -> Result<(Box<dyn Recogniser>, Vec<String>), RecogniserUnavailable> {
        Ok(match self {
            Self::PocketSphinx(options) => {
                // A good part of the cost of starting the group; utterances wait meanwhile.
                let recogniser = in_background(|| PocketSphinx::open(scene, options))?;
                let unpronounceable = recogniser.unpronounceable().to_vec();
                (Box::new(recogniser), unpronounceable)
            }
            Self::Command(options) => (Box::new(Command::open(options.clone())?), Vec::new()),
        })
    }
}
