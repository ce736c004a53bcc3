//! Speech recognition: from samples to words.

mod command;
mod ffi;
mod first_view;
pub mod interim;
mod pocketsphinx;
mod scene_files;
pub mod second_opinion;
mod server;
mod word_confidence;

use std::io;
use std::ops::Range;
use std::path::Path;
use std::time::Duration;

use scene::Scene;

use crate::worker_thread::in_background;

pub use command::{Command, CommandOptions};
pub use first_view::FirstView;
pub use pocketsphinx::{PocketSphinx, PocketSphinxOptions};
pub use second_opinion::{Opinion, PendingOpinion, SecondOpinion};
pub use server::{Report, WyomingOptions};

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

    /// Returns whether it stands for one that is not installed, and so recognises nothing.
    fn is_missing(&self) -> bool {
        false
    }

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

/// Opens the offline recogniser: a good part of the cost of starting the group, during which
/// utterances wait.
fn built_in(
    scene: &Scene,
    options: &PocketSphinxOptions,
) -> Result<PocketSphinx, RecogniserUnavailable> {
    in_background(|| PocketSphinx::open(scene, options))
}

/// Time that a client notices the end of its limit late.
const SLACK: Duration = Duration::from_millis(100);
/// Hypotheses per utterance.
const N_BEST_MAX: usize = 5;

/// A choice of recogniser.
#[derive(Clone, Debug, PartialEq)]
pub enum Backend {
    /// The offline recogniser with the scene's own language model.
    PocketSphinx(PocketSphinxOptions),
    /// A program chosen by the operator.
    Command(CommandOptions),
    /// A server of the Wyoming protocol, which decides. The offline recogniser listens beside it.
    Wyoming(WyomingOptions),
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
                let recogniser = built_in(scene, options)?;
                let unpronounceable = recogniser.unpronounceable().to_vec();
                (Box::new(recogniser), unpronounceable)
            }
            Self::Command(options) => (Box::new(Command::open(options.clone())?), Vec::new()),
            Self::Wyoming(WyomingOptions { built_in: options, .. }) => {
                (server::beside(built_in(scene, options))?, Vec::new())
            }
        })
    }

    /// Starts the server's client, if there is one: it decides in place of `first`, the recogniser
    /// of [`Self::open`]. `report` is called on a thread of its own.
    pub fn server(
        &self,
        scene: &Scene,
        first: &dyn Recogniser,
        report: Report,
    ) -> Option<SecondOpinion> {
        match self {
            Self::Wyoming(options) => Some(server::start(options, scene, first, report)),
            Self::PocketSphinx(_) | Self::Command(_) => None,
        }
    }

    /// Returns the longest time until the server's answer, or zero without a server.
    pub fn server_limit(&self) -> Duration {
        match self {
            Self::Wyoming(WyomingOptions { client, .. }) => client.connect + client.answer + SLACK,
            Self::PocketSphinx(_) | Self::Command(_) => Duration::ZERO,
        }
    }
}
