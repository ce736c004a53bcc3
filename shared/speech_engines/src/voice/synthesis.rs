//! Speech synthesis with a cache; leading and trailing silence is trimmed.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::server::Server;
use super::{VoiceOptions, trim};
use crate::audio::{RATE_HZ, read_wav, write_wav};
use crate::child_process::{ChildProcess, End, ProcessError};

/// Error of synthesis.
#[derive(Debug, thiserror::Error)]
pub enum SynthesisError {
    /// The program, its output or the folder is to blame; the reason is for the operator.
    #[error("{0}")]
    Failed(String),
    /// Cancelled.
    #[error("cancelled")]
    Cancelled,
}

/// A synthesised prompt.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Sound {
    pub(super) file: PathBuf,
    /// Duration of the audible part, seconds.
    pub(super) seconds: f64,
}

/// Synthesises prompts, each once while it is cached.
pub struct Synthesiser {
    options: VoiceOptions,
    server: Option<Server>,
    /// Texts and their audio, the latest last.
    cache: VecDeque<(String, Sound)>,
    /// Number of synthesised prompts: numbers the files.
    count: usize,
}

/// Longest text, characters; the rest is not spoken.
const TEXT_MAX: usize = 500;
/// espeak-ng takes 20 to 40 ms, flite 160 ms; a command may take longer.
const DEADLINE: Duration = Duration::from_secs(5);
/// Longest audio: 500 characters at the slowest pace, seconds.
pub(super) const SOUND_MAX_S: f64 = 120.0;
/// Cached prompts: all that are foreseen, and as many that were not.
const CACHED_MAX: usize = 2 * FORESEEN_MAX;
/// Prompts that are synthesised in advance; the questions of most scenes are fewer.
pub(super) const FORESEEN_MAX: usize = 64;

impl Synthesiser {
    /// Returns a synthesiser with program, server, voice, pace and folder of the options.
    pub fn new(options: &VoiceOptions) -> Self {
        let server = options.server.clone().map(Server::new);
        Self { options: options.clone(), server, cache: VecDeque::new(), count: 0 }
    }

    /// Returns what stands in the server's place and why, for the operator; `None` if it works, or
    /// there is none.
    pub(super) fn note(&self) -> Option<&str> {
        self.server.as_ref().and_then(|server| server.state.note())
    }

    /// Synthesises a text as samples at [`RATE_HZ`].
    ///
    /// # Errors
    /// If the program is missing or fails.
    pub fn samples(&mut self, text: &str) -> Result<Vec<i16>, SynthesisError> {
        match self.speak(text, || false)? {
            Some(sound) => read(&sound.file),
            None => Ok(Vec::new()),
        }
    }

    /// Synthesises a text as a WAV file; `None` if it has no words. The file remains until
    /// [`CACHED_MAX`] other prompts were synthesised; one in a server's place until the next.
    pub(super) fn speak(
        &mut self,
        text: &str,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<Sound>, SynthesisError> {
        let text = speakable(text);
        if !text.contains(char::is_alphanumeric) {
            return Ok(None);
        }
        if let Some(known) = self.cached(&text) {
            return Ok(Some(known));
        }
        let file = self.file(&format!("sentence-{:03}.wav", self.count % (CACHED_MAX + 1)))?;
        let by_server = match &mut self.server {
            Some(server) => server.speak(&text, &file, &is_cancelled)?,
            None => false,
        };
        let in_place = self.server.is_some() && !by_server;
        let file = if in_place { self.file("in-place.wav")? } else { file };
        if !by_server {
            let VoiceOptions { program, voice, words_per_minute, .. } = &self.options;
            self.run(program.speak(&text, voice, *words_per_minute, &file), is_cancelled)?;
        }
        let seconds = trim::trim(&file)?;
        let sound = Sound { file, seconds };
        // The server may work the next time.
        if !in_place {
            self.keep(text, sound.clone());
        }
        Ok(Some(sound))
    }

    fn keep(&mut self, text: String, sound: Sound) {
        self.count += 1;
        if self.cache.len() == CACHED_MAX {
            self.cache.pop_front();
        }
        self.cache.push_back((text, sound));
    }

    /// Returns the audio of an earlier prompt if it still exists.
    fn cached(&self, text: &str) -> Option<Sound> {
        let (_, sound) = self.cache.iter().find(|(known, _)| known == text)?;
        sound.file.is_file().then(|| sound.clone())
    }

    fn run(
        &self,
        mut command: Command,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<(), SynthesisError> {
        let failed = |error: ProcessError| {
            SynthesisError::Failed(format!("{error}{}", self.options.program.hint(&error)))
        };
        command.stdout(std::process::Stdio::null());
        let mut running = ChildProcess::start(command).map_err(failed)?;
        let pause = |time| {
            std::thread::sleep(time);
            is_cancelled()
        };
        match running.wait(DEADLINE, pause).map_err(failed)? {
            End::Done => Ok(()),
            End::Cancelled => Err(SynthesisError::Cancelled),
        }
    }

    /// Synthesises a short text to check the program.
    pub(super) fn try_out(
        &mut self,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<(), SynthesisError> {
        self.speak("hello", is_cancelled).map(|_| ())
    }

    /// Writes a WAV file with a twentieth of a second of silence.
    pub(super) fn silence(&self) -> Result<PathBuf, SynthesisError> {
        let file = self.file("silence.wav")?;
        write_wav(&file, &[0; RATE_HZ as usize / 20])
            .map_err(|error| trim::unwritten(&file, &error))?;
        Ok(file)
    }

    fn file(&self, name: &str) -> Result<PathBuf, SynthesisError> {
        match fs::create_dir_all(&self.options.work) {
            Ok(()) => Ok(self.options.work.join(name)),
            Err(error) => {
                let folder = self.options.work.display();
                Err(SynthesisError::Failed(format!("{folder} cannot be written: {error}")))
            }
        }
    }
}

/// Returns the samples of a synthesised file.
pub(super) fn read(file: &Path) -> Result<Vec<i16>, SynthesisError> {
    read_wav(file, SOUND_MAX_S)
        .map_err(|error| SynthesisError::Failed(format!("invalid audio from the voice: {error}")))
}

/// Returns the text without instructions for espeak-ng: `[[` begins phoneme names.
fn speakable(text: &str) -> String {
    let plain = |c: char| if c.is_control() || matches!(c, '[' | ']') { ' ' } else { c };
    text.chars().take(TEXT_MAX).map(plain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn synthesis_removes_instructions_and_needs_a_folder_only_for_words() {
        assert_eq!(speakable("a[[h@'loU]]\0b\n"), "a  h@'loU   b ");
        assert_eq!(speakable(&"x".repeat(2_000)).len(), TEXT_MAX);
        let mut synthesiser = Synthesiser::new(&VoiceOptions::new("/dev/null/folder"));
        assert!(synthesiser.samples(" ?! \n").unwrap().is_empty());
        let error = synthesiser.samples("hello").unwrap_err();
        assert!(error.to_string().contains("/dev/null/folder"), "{error}");
    }
}
