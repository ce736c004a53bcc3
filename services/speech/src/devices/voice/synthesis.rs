//! From text to sound, by the program espeak-ng. It stays a program: its licence (GPL-3) would
//! become that of anything that links it.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use super::VoiceOptions;
use crate::devices::audio::{RATE_HZ, WavError, read_wav, seconds};
use crate::devices::child::{self, ChildError};

/// Why a text could not be made sound.
#[derive(Debug, thiserror::Error)]
pub enum SynthesisError {
    /// espeak-ng is missing or failed.
    #[error("{source}{}", install_hint(source))]
    Espeak {
        /// How it failed.
        #[from]
        source: ChildError,
    },
    /// What it wrote cannot be read.
    #[error("espeak-ng's sound is unusable: {0}")]
    Sound(#[from] WavError),
    /// The folder for the sound cannot be written.
    #[error("{} cannot be written: {source}", path.display())]
    Work {
        /// The file or folder.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
}

fn install_hint(error: &ChildError) -> &'static str {
    match error {
        ChildError::NotInstalled { .. } => " (install the package espeak-ng)",
        _ => "",
    }
}

/// A sentence as sound.
pub(super) struct Sound {
    pub(super) file: PathBuf,
    pub(super) seconds: f64,
}

/// Makes sentences sound.
pub struct Synthesiser {
    espeak_ng: PathBuf,
    voice: String,
    words_per_minute: u16,
    work: PathBuf,
}

/// Characters of a sentence that are spoken; what is longer is no sentence.
const TEXT_MAX: usize = 500;
/// espeak-ng needs 20 to 40 ms for a sentence.
const DEADLINE: Duration = Duration::from_secs(5);
/// Longest sound of a sentence: 500 characters at the slowest pace, seconds.
const SOUND_MAX_S: f64 = 120.0;

impl Synthesiser {
    /// A synthesiser with these options' voice, pace and folder.
    pub fn new(options: &VoiceOptions) -> Self {
        let VoiceOptions { espeak_ng, voice, words_per_minute, work, .. } = options.clone();
        Self { espeak_ng, voice, words_per_minute, work }
    }

    /// The text as samples at [`RATE_HZ`].
    ///
    /// # Errors
    /// If espeak-ng is missing or fails.
    pub fn samples(&self, text: &str) -> Result<Vec<i16>, SynthesisError> {
        match self.speak(text)? {
            Some(sound) => Ok(read_wav(&sound.file, SOUND_MAX_S)?),
            None => Ok(Vec::new()),
        }
    }

    /// Writes the text as a WAV file; `None` if there is nothing to say in it.
    pub(super) fn speak(&self, text: &str) -> Result<Option<Sound>, SynthesisError> {
        let text = speakable(text);
        if !text.contains(char::is_alphanumeric) {
            return Ok(None);
        }
        let file = self.file("sentence.wav")?;
        let mut command = Command::new(&self.espeak_ng);
        command.arg("-v").arg(&self.voice);
        command.arg("-s").arg(self.words_per_minute.to_string());
        command.arg("-w").arg(&file).arg("--").arg(text);
        child::run(command, DEADLINE)?;
        let seconds = seconds(read_wav(&file, SOUND_MAX_S)?.len());
        Ok(Some(Sound { file, seconds }))
    }

    /// A WAV file with a twentieth of a second of silence, once espeak-ng has shown that it is
    /// there.
    pub(super) fn silence(&self) -> Result<PathBuf, SynthesisError> {
        let mut version = Command::new(&self.espeak_ng);
        version.arg("--version");
        child::run(version, DEADLINE)?;
        let file = self.file("silence.wav")?;
        let spec = hound::WavSpec {
            channels: 1,
            sample_rate: RATE_HZ,
            bits_per_sample: 16,
            sample_format: hound::SampleFormat::Int,
        };
        let written = hound::WavWriter::create(&file, spec).and_then(|mut wav| {
            (0..RATE_HZ / 20).try_for_each(|_| wav.write_sample(0_i16))?;
            wav.finalize()
        });
        match written {
            Ok(()) => Ok(file),
            Err(hound::Error::IoError(source)) => Err(SynthesisError::Work { path: file, source }),
            Err(error) => {
                let reason = error.to_string();
                Err(WavError::NotWav { path: file, reason }.into())
            }
        }
    }

    fn file(&self, name: &str) -> Result<PathBuf, SynthesisError> {
        match fs::create_dir_all(&self.work) {
            Ok(()) => Ok(self.work.join(name)),
            Err(source) => Err(SynthesisError::Work { path: self.work.clone(), source }),
        }
    }
}

/// The text without what espeak-ng would take for instructions: `[[` begins phoneme names.
fn speakable(text: &str) -> String {
    let plain = |c: char| if c.is_control() || matches!(c, '[' | ']') { ' ' } else { c };
    text.chars().take(TEXT_MAX).map(plain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instructions_are_taken_out_of_the_text() {
        assert_eq!(speakable("a[[h@'loU]]\0b\n"), "a  h@'loU   b ");
        assert_eq!(speakable(&"x".repeat(2_000)).len(), TEXT_MAX);
    }

    #[test]
    fn nothing_to_say_needs_no_program() {
        let options = VoiceOptions::new("/nonexistent/folder");
        let synthesiser = Synthesiser::new(&options);
        assert!(synthesiser.samples(" ?! \n").unwrap().is_empty());
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let synthesiser = Synthesiser::new(&VoiceOptions::new("/dev/null/folder"));
        let error = synthesiser.samples("hello").unwrap_err();
        assert!(error.to_string().contains("/dev/null/folder"), "{error}");
    }
}
