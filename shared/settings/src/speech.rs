//! `speech.toml`: how the robot hears and speaks.

use std::path::PathBuf;
use std::time::Duration;

use crate::fields::Fields;

/// Hearing and speaking.
#[derive(Clone, Debug, PartialEq)]
pub struct Speech {
    /// What says the robot's questions.
    pub voice: Voice,
    /// The voice's own name for a voice or language, e.g. `en-us`.
    pub voice_name: String,
    /// Speed of the voice.
    pub voice_words_per_minute: u32,
    /// Program, with its arguments before the file, that plays a WAV file; found by itself where
    /// nothing is said.
    pub player: Option<Vec<String>>,
    /// What turns audio into words.
    pub recogniser: Recogniser,
    /// Folder of the recogniser's acoustic model; found by itself where nothing is said.
    pub model_dir: Option<PathBuf>,
    /// Share of the scene's words times their mean posterior below which speech is taken not to be
    /// meant for the robot, 0 … 1.
    pub accept_score_min: f64,
    /// Quiet that ends an utterance.
    pub closing_pause: Duration,
    /// Longest typed or injected utterance, bytes of UTF-8.
    pub utterance_bytes_max: usize,
    /// Longest recording that is recognised.
    pub recording_max: Duration,
}

/// What says the robot's questions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Voice {
    /// The first that this machine has, else print.
    Auto,
    /// The espeak-ng program.
    EspeakNg,
    /// No sound: the text alone.
    Print,
}

/// What turns audio into words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recogniser {
    /// The first that this machine has, else none.
    Auto,
    /// The pocketsphinx library.
    PocketSphinx,
    /// None: typed text only.
    None,
}

pub(crate) fn read(f: &mut Fields<'_>) -> Speech {
    Speech {
        voice: f.choice(
            "voice",
            &[("auto", Voice::Auto), ("espeak-ng", Voice::EspeakNg), ("print", Voice::Print)],
        ),
        voice_name: f.text("voice_name"),
        voice_words_per_minute: f.whole("voice_words_per_minute", 80..=450),
        player: f.optional_command("player"),
        recogniser: f.choice(
            "recogniser",
            &[
                ("auto", Recogniser::Auto),
                ("pocketsphinx", Recogniser::PocketSphinx),
                ("none", Recogniser::None),
            ],
        ),
        model_dir: model_dir(f),
        accept_score_min: f.number("accept_score_min", 0.0..=1.0),
        closing_pause: Duration::from_millis(f.whole("closing_pause_ms", 100..=5000)),
        utterance_bytes_max: f.whole("utterance_bytes_max", 16..=UTTERANCE_BYTES_MAX) as usize,
        recording_max: f.seconds("recording_s_max", 1.0..=600.0),
    }
}

/// What the utterance topic carries at most, bytes.
const UTTERANCE_BYTES_MAX: u32 = 16_384;

/// The services run in other folders than the one where this was written, so it must be absolute.
fn model_dir(f: &mut Fields<'_>) -> Option<PathBuf> {
    let dir = PathBuf::from(f.optional_text("model_dir")?);
    if !dir.is_absolute() {
        f.problem("model_dir", "is not an absolute path", "write it from `/` on");
    }
    Some(dir)
}
