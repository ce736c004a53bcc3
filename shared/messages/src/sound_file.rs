//! Files with the sound of the robot's prompts.

use std::fmt;

use crate::Presented;

/// Beginning of their names.
pub const PREFIX: &str = "line-";
/// End of their names.
const SUFFIX: &str = ".wav";

/// The file of one presentation of a prompt, `line-PROMPT-PRESENTATION.wav`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SoundFile {
    /// The prompt's number.
    pub prompt: u64,
    /// Number of the presentation, from 1.
    pub presentation: u32,
}

impl SoundFile {
    /// The file of a presentation.
    pub fn of(presented: &Presented) -> Self {
        Self { prompt: presented.prompt, presentation: presented.presentation }
    }

    /// Reads a name, which may come from anywhere; `None` unless it is exactly that of such a file.
    pub fn parse(name: &str) -> Option<Self> {
        let numbers = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?;
        let (prompt, presentation) = numbers.split_once('-')?;
        let file = Self { prompt: prompt.parse().ok()?, presentation: presentation.parse().ok()? };
        // A number may be written in several ways, `+1` among them; a file has one name.
        (file.to_string() == name).then_some(file)
    }
}

impl fmt::Display for SoundFile {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{PREFIX}{}-{}{SUFFIX}", self.prompt, self.presentation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_sound_files_lead_nowhere_else() {
        let presented = Presented { prompt: 12, presentation: 1, ..Presented::default() };
        let file = SoundFile::of(&presented);
        assert_eq!(file.to_string(), "line-12-1.wav");
        assert_eq!(SoundFile::parse("line-12-1.wav"), Some(file));
        for other in [
            "",
            "line-1.wav",
            "line-1-2",
            "line-1-1.txt",
            "line--.wav",
            "line--1.wav",
            "line-+1-1.wav",
            "line-01-1.wav",
            "line-1-2-3.wav",
            "line-a-1.wav",
            "line-1-1.wav/..",
            "line-../x.wav",
            "line-../1-1.wav",
            "../line-1-1.wav",
            "/line-1-1.wav",
            "line-1-99999999999999999999.wav",
        ] {
            assert_eq!(SoundFile::parse(other), None, "{other}");
        }
    }
}
