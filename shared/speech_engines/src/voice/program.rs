//! Speech synthesis programs. They are not linked because of espeak-ng's licence (GPL-3).

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::child_process::ProcessError;

/// A program that synthesises a text into a WAV file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Program {
    /// The program espeak-ng, by path.
    EspeakNg(PathBuf),
    /// The program flite, by path.
    Flite(PathBuf),
    /// Another one: its words, with the placeholders `{text}` and `{wav}`.
    Command(Vec<String>),
}

/// Default pace of flite's voices, words per minute.
const FLITE_WPM: f64 = 165.0;

impl Program {
    /// Returns the program's name.
    pub fn name(&self) -> String {
        match self {
            Self::EspeakNg(path) | Self::Flite(path) => path.display().to_string(),
            Self::Command(words) => words.first().cloned().unwrap_or_default(),
        }
    }

    /// Returns help for a missing program.
    pub(super) fn hint(&self, error: &ProcessError) -> &'static str {
        match (self, error) {
            (_, ProcessError::Failed(_)) => "",
            (Self::EspeakNg(_), _) => "; help: install the package espeak-ng",
            (Self::Flite(_), _) => "; help: install the package flite",
            (Self::Command(_), _) => "; help: see speech.voice_command",
        }
    }

    /// Returns the command that synthesises `text` into the file `wav`; `pace` in words per minute.
    /// No shell interprets the text.
    pub(super) fn speak(&self, text: &str, voice: &str, pace: u16, wav: &Path) -> Command {
        match self {
            Self::EspeakNg(path) => {
                let mut command = Command::new(path);
                command.arg("-v").arg(voice).arg("-s").arg(pace.to_string());
                command.arg("-w").arg(wav).arg("--").arg(text);
                command
            }
            Self::Flite(path) => {
                let stretch = FLITE_WPM / f64::from(pace.max(1));
                let mut command = Command::new(path);
                command.arg("-voice").arg(voice);
                command.arg("--setf").arg(format!("duration_stretch={stretch:.3}"));
                command.arg("-o").arg(wav).arg("-t").arg(text);
                command
            }
            Self::Command(words) => {
                let file = wav.to_string_lossy();
                // Word by word and the file first: a text may contain `{wav}`.
                let word = |word: &String| word.replace("{wav}", &file).replace("{text}", text);
                let (program, arguments) =
                    words.split_first().map_or(("", words.as_slice()), |w| (w.0.as_str(), w.1));
                let mut command = Command::new(program);
                command.args(arguments.iter().map(word));
                command
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(program: &Program, text: &str) -> Vec<String> {
        let command = program.speak(text, "slt", 330, Path::new("/w/a.wav"));
        let words = std::iter::once(command.get_program()).chain(command.get_args());
        words.map(|word| word.to_string_lossy().into_owned()).collect()
    }

    #[test]
    fn voice_command_is_filled_in_and_flite_follows_the_pace() {
        let template = ["say", "--to={wav}", "-t", "{text}"].map(str::to_owned);
        let program = Program::Command(template.to_vec());
        assert_eq!(words(&program, "a {wav} $(b)"), ["say", "--to=/w/a.wav", "-t", "a {wav} $(b)"]);
        let flite = words(&Program::Flite("flite".into()), "hello");
        assert!(flite.contains(&"duration_stretch=0.500".to_owned()), "{flite:?}");
        assert_eq!(flite.last().unwrap(), "hello");
    }
}
