//! Programs that make sound of text. They stay programs: espeak-ng's licence (GPL-3) would become
//! that of anything that links it.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::devices::child::ChildError;

/// A program that writes a text as a WAV file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Program {
    /// espeak-ng, at this path.
    EspeakNg(PathBuf),
    /// flite, at this path.
    Flite(PathBuf),
    /// Any other: its words, in which `{text}` and `{wav}` stand for the text and the file.
    Command(Vec<String>),
}

/// Words a minute at which flite's voices speak by themselves.
const FLITE_WPM: f64 = 165.0;

impl Program {
    /// Its name, for the operator.
    pub fn name(&self) -> String {
        match self {
            Self::EspeakNg(path) | Self::Flite(path) => path.display().to_string(),
            Self::Command(words) => words.first().cloned().unwrap_or_default(),
        }
    }

    /// What is to be done where it is missing.
    pub(super) fn hint(&self, error: &ChildError) -> &'static str {
        match (self, error) {
            (Self::EspeakNg(_), ChildError::NotInstalled { .. }) => {
                " (install the package espeak-ng)"
            }
            (Self::Flite(_), ChildError::NotInstalled { .. }) => " (install the package flite)",
            (Self::Command(_), ChildError::NotInstalled { .. }) => " (see speech.voice_command)",
            _ => "",
        }
    }

    /// Writes `text` to the file `wav` at this pace, words a minute. No shell reads the text.
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
                // Word by word and the file first: a text that holds `{wav}` stays a text.
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
    fn a_template_is_filled_in() {
        let template = ["say", "--to={wav}", "-t", "{text}"].map(str::to_owned);
        let program = Program::Command(template.to_vec());
        assert_eq!(words(&program, "a {wav} $(b)"), ["say", "--to=/w/a.wav", "-t", "a {wav} $(b)"]);
        assert_eq!(program.name(), "say");
    }

    #[test]
    fn flite_speaks_at_the_pace() {
        let said = words(&Program::Flite("flite".into()), "hello");
        assert!(said.contains(&"duration_stretch=0.500".to_owned()), "{said:?}");
        assert_eq!(said.last().unwrap(), "hello");
    }
}
