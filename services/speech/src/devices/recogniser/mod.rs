//! From samples to words.

mod agreement;
mod command;
mod ffi;
mod gate;
mod pocketsphinx;
mod scene_files;
mod unavailable;
mod whisper;

use std::ops::Range;

use scene::Scene;

pub use command::{Command, CommandOptions};
pub use gate::{Gate, Outcome, RejectReason};
pub use pocketsphinx::{PocketSphinx, PocketSphinxOptions};
pub use unavailable::RecogniserUnavailable;
pub use whisper::WhisperOptions;

/// One way to understand an utterance.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// The words, separated by blanks, lower case.
    pub text: String,
    /// Its share among the hypotheses of the utterance, 0 to 1; they sum to 1 at most.
    pub confidence: f32,
    /// Each word of the text with the probability that it was said there, 0 to 1.
    pub words: Vec<(String, f32)>,
}

/// Why an utterance was not decoded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RecogniseError {
    /// The library reported a failure; the next utterance may do better.
    #[error("the recogniser failed on this utterance")]
    Failed,
    /// A program reported a failure, or failed itself.
    #[error("the recogniser failed on this utterance: {reason}")]
    Told {
        /// Its words, or what became of it.
        reason: String,
    },
}

/// Turns an utterance into words.
pub trait Recogniser: Send {
    /// Decodes one whole utterance, 16 kHz mono, in which `speech` are the samples of the voice;
    /// the noise around it tells what to leave out. The hypotheses come best first, with different
    /// texts; none if nothing was recognised.
    ///
    /// # Errors
    /// If the backend fails on these samples.
    fn recognise(
        &mut self,
        pcm: &[i16],
        speech: Range<usize>,
    ) -> Result<Vec<Hypothesis>, RecogniseError>;

    /// Whether decoding costs so little that it may begin while it is not certain that nothing more
    /// will be said.
    fn is_quick(&self) -> bool {
        false
    }

    /// What opens a recogniser of the same words for utterances that are still being spoken, if
    /// there is one. It may be called on another thread.
    fn preview(&self) -> Option<PreviewOpener> {
        None
    }
}

/// Opens a [`Preview`]; none where it cannot be had, which has been logged then.
pub type PreviewOpener = Box<dyn FnOnce() -> Option<Box<dyn Preview>> + Send>;

/// Tells roughly what is being said while it is being said.
pub trait Preview: Send {
    /// A new utterance begins; one that is going on is given up.
    ///
    /// # Errors
    /// If the backend fails.
    fn begin(&mut self) -> Result<(), RecogniseError>;

    /// Takes the next samples, 16 kHz mono. Returns the words so far, separated by blanks.
    ///
    /// # Errors
    /// If the backend fails on these samples.
    fn hear(&mut self, pcm: &[i16]) -> Result<String, RecogniseError>;
}

/// What turns samples into words.
#[derive(Clone, Debug, PartialEq)]
pub enum Backend {
    /// The offline recogniser with the scene's own language model.
    PocketSphinx(PocketSphinxOptions),
    /// A program of the operator's.
    Command(CommandOptions),
    /// whisper.cpp, in builds that have it.
    Whisper(WhisperOptions),
}

impl Backend {
    /// Makes the recogniser for a scene; with it come the scene's words that it cannot know.
    ///
    /// # Errors
    /// If something that it needs is not there.
    pub fn open(
        &self,
        scene: &Scene,
    ) -> Result<(Box<dyn Recogniser>, Vec<String>), RecogniserUnavailable> {
        Ok(match self {
            Self::PocketSphinx(options) => {
                let recogniser = PocketSphinx::open(scene, options)?;
                let unpronounceable = recogniser.unpronounceable().to_vec();
                (Box::new(recogniser), unpronounceable)
            }
            Self::Command(options) => (Box::new(Command::open(options.clone())?), Vec::new()),
            Self::Whisper(options) => (options.open(scene)?, Vec::new()),
        })
    }
}
