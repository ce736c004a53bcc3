//! From text to sound: a cache before the program that speaks, and the silence cut off behind it.

use std::collections::VecDeque;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use super::program::Program;
use super::{VoiceOptions, trim};
use crate::devices::audio::{RATE_HZ, WavError, read_wav};
use crate::devices::child::{ChildError, End, Running};

/// Why a text could not be made sound.
#[derive(Debug, thiserror::Error)]
pub enum SynthesisError {
    /// The program is missing or failed.
    #[error("{source}{hint}")]
    Program {
        /// How it failed.
        source: ChildError,
        /// What can be done about it.
        hint: &'static str,
    },
    /// What it wrote cannot be read.
    #[error("the voice's sound is unusable: {0}")]
    Sound(#[from] WavError),
    /// The folder for the sound cannot be written.
    #[error("{} cannot be written: {source}", path.display())]
    Work {
        /// The file or folder.
        path: PathBuf,
        /// Why not.
        source: std::io::Error,
    },
    /// Nobody wants to hear it any more.
    #[error("called off")]
    CalledOff,
}

/// A sentence as sound.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sound {
    pub(super) file: PathBuf,
    /// From its first sound to its last, seconds.
    pub(super) seconds: f64,
}

/// Makes sentences sound, each once while it is remembered.
pub struct Synthesiser {
    program: Program,
    voice: String,
    words_per_minute: u16,
    work: PathBuf,
    /// Sentences and their sound, the latest last.
    made: VecDeque<(String, Sound)>,
    /// Sentences made so far: numbers the files.
    count: usize,
}

/// Characters of a sentence that are spoken; what is longer is no sentence.
const TEXT_MAX: usize = 500;
/// espeak-ng needs 20 to 40 ms for a sentence, flite 160 ms; a command may need more.
const DEADLINE: Duration = Duration::from_secs(5);
/// Longest sound of a sentence: 500 characters at the slowest pace, seconds.
pub(super) const SOUND_MAX_S: f64 = 120.0;
/// Sentences whose sound is remembered. The questions of a scene are fewer.
const MADE_MAX: usize = 64;

impl Synthesiser {
    /// A synthesiser with these options' program, voice, pace and folder.
    pub fn new(options: &VoiceOptions) -> Self {
        let VoiceOptions { program, voice, words_per_minute, work, .. } = options.clone();
        Self { program, voice, words_per_minute, work, made: VecDeque::new(), count: 0 }
    }

    /// The text as samples at [`RATE_HZ`].
    ///
    /// # Errors
    /// If the program is missing or fails.
    pub fn samples(&mut self, text: &str) -> Result<Vec<i16>, SynthesisError> {
        match self.speak(text, || false)? {
            Some(sound) => Ok(read_wav(&sound.file, SOUND_MAX_S)?),
            None => Ok(Vec::new()),
        }
    }

    /// The text as a WAV file; `None` if there is nothing to say in it. The file stays as it is
    /// until [`MADE_MAX`] other sentences were made.
    pub(super) fn speak(
        &mut self,
        text: &str,
        is_called_off: impl Fn() -> bool,
    ) -> Result<Option<Sound>, SynthesisError> {
        let text = speakable(text);
        if !text.contains(char::is_alphanumeric) {
            return Ok(None);
        }
        if let Some(known) = self.remembered(&text) {
            return Ok(Some(known));
        }
        let file = self.file(&format!("sentence-{:02}.wav", self.count % (MADE_MAX + 1)))?;
        let command = self.program.speak(&text, &self.voice, self.words_per_minute, &file);
        self.run(command, is_called_off)?;
        let seconds = trim::trim(&file)?;
        let sound = Sound { file, seconds };
        self.count += 1;
        if self.made.len() == MADE_MAX {
            self.made.pop_front();
        }
        self.made.push_back((text, sound.clone()));
        Ok(Some(sound))
    }

    /// The sound of a sentence that was made before and is still there.
    fn remembered(&self, text: &str) -> Option<Sound> {
        let (_, sound) = self.made.iter().find(|(known, _)| known == text)?;
        sound.file.is_file().then(|| sound.clone())
    }

    fn run(
        &self,
        mut command: Command,
        is_called_off: impl Fn() -> bool,
    ) -> Result<(), SynthesisError> {
        let fault = |source: ChildError| {
            let hint = self.program.hint(&source);
            SynthesisError::Program { source, hint }
        };
        command.stdout(std::process::Stdio::null());
        let mut running = Running::start(command).map_err(fault)?;
        let pause = |time| {
            std::thread::sleep(time);
            is_called_off()
        };
        match running.wait(DEADLINE, pause).map_err(fault)? {
            End::Done => Ok(()),
            End::CalledOff => Err(SynthesisError::CalledOff),
        }
    }

    /// Makes a short sentence, to see whether the program works.
    pub(super) fn try_out(&mut self) -> Result<(), SynthesisError> {
        self.speak("hello", || false).map(|_| ())
    }

    /// A WAV file with a twentieth of a second of silence.
    pub(super) fn silence(&self) -> Result<PathBuf, SynthesisError> {
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
        written.map_err(|error| trim::unwritten(&file, error))?;
        Ok(file)
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
        let mut synthesiser = Synthesiser::new(&options);
        assert!(synthesiser.samples(" ?! \n").unwrap().is_empty());
    }

    #[test]
    fn a_folder_that_cannot_be_made_is_named() {
        let mut synthesiser = Synthesiser::new(&VoiceOptions::new("/dev/null/folder"));
        let error = synthesiser.samples("hello").unwrap_err();
        assert!(error.to_string().contains("/dev/null/folder"), "{error}");
    }
}
