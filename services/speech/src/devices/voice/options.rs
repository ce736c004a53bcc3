//! How the voice sounds and what it needs.

use std::path::{Path, PathBuf};

use super::{Player, Program};

/// How sentences are presented.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VoiceMode {
    /// Aloud where the program that speaks and a player that works are there, else as text alone.
    #[default]
    Auto,
    /// Aloud; where that is impossible every sentence fails.
    Aloud,
    /// As text alone: a sentence ends as soon as it starts.
    Print,
}

/// How the voice sounds and what it needs.
#[derive(Clone, Debug, PartialEq)]
pub struct VoiceOptions {
    /// How sentences are presented.
    pub mode: VoiceMode,
    /// The program that makes the sound.
    pub program: Program,
    /// That program's own name for a voice, e.g. `en-us`.
    pub voice: String,
    /// Speed, words a minute.
    pub words_per_minute: u16,
    /// Players to try, the preferred one first.
    pub players: Vec<Player>,
    /// A folder of this service's own for the sound of sentences.
    pub work: PathBuf,
    /// Where the sound of the latest [`super::KEPT_MAX`] sentences is kept for others, if anywhere.
    pub kept: Option<PathBuf>,
}

impl VoiceOptions {
    /// An American voice at a calm pace, aloud where possible.
    pub fn new(work: impl Into<PathBuf>) -> Self {
        Self {
            mode: VoiceMode::Auto,
            program: Program::EspeakNg("espeak-ng".into()),
            voice: "en-us".to_owned(),
            words_per_minute: 150,
            players: Player::usual(),
            work: work.into(),
            kept: None,
        }
    }

    /// The voice of the settings.
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
            kept: speech.voice_dir.clone(),
        }
    }
}
