//! Settings of the voice.

use std::path::{Path, PathBuf};

use super::{Player, Program};

/// Presentation of prompts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VoiceMode {
    /// Aloud where synthesis and a player work, otherwise as text.
    #[default]
    Auto,
    /// Aloud; where that is impossible every prompt fails.
    Aloud,
    /// As text: a prompt ends as soon as it starts.
    Print,
}

/// Settings of the voice.
#[derive(Clone, Debug, PartialEq)]
pub struct VoiceOptions {
    /// Presentation of prompts.
    pub mode: VoiceMode,
    /// The synthesis program.
    pub program: Program,
    /// The program's name of a voice, e.g. `en-us`.
    pub voice: String,
    /// Pace, words per minute.
    pub words_per_minute: u16,
    /// Players, the preferred one first.
    pub players: Vec<Player>,
    /// Private folder for synthesised audio.
    pub work: PathBuf,
    /// Folder for the audio of the latest [`super::CACHED_MAX`] prompts, if any.
    pub audio_dir: Option<PathBuf>,
    /// Prompts that are synthesised in advance while the voice is silent, the most likely first.
    pub foreseen: Vec<String>,
}

impl VoiceOptions {
    /// Returns an American voice at a calm pace, aloud where possible.
    pub fn new(work: impl Into<PathBuf>) -> Self {
        Self {
            mode: VoiceMode::Auto,
            program: Program::EspeakNg("espeak-ng".into()),
            voice: "en-us".to_owned(),
            words_per_minute: 150,
            players: Player::default_players(),
            work: work.into(),
            audio_dir: None,
            foreseen: Vec::new(),
        }
    }

    /// Returns the options of the configuration.
    pub fn of(speech: &config::Speech, work: &Path) -> Self {
        let defaults = Self::new(work);
        let players = match speech.player.as_deref() {
            Some([program, arguments @ ..]) => {
                vec![Player { program: program.clone(), arguments: arguments.to_vec() }]
            }
            _ => defaults.players,
        };
        let espeak_ng = defaults.program;
        let (mode, program) = match speech.voice {
            config::Voice::Auto => (VoiceMode::Auto, espeak_ng),
            config::Voice::EspeakNg => (VoiceMode::Aloud, espeak_ng),
            config::Voice::Flite => (VoiceMode::Aloud, Program::Flite("flite".into())),
            config::Voice::Command => {
                let words = speech.voice_command.clone().unwrap_or_default();
                (VoiceMode::Aloud, Program::Command(words))
            }
            config::Voice::Print => (VoiceMode::Print, espeak_ng),
        };
        Self {
            mode,
            program,
            voice: speech.voice_name.clone(),
            words_per_minute: u16::try_from(speech.voice_words_per_minute).unwrap_or(u16::MAX),
            players,
            work: defaults.work,
            audio_dir: speech.voice_dir.clone(),
            foreseen: Vec::new(),
        }
    }
}
