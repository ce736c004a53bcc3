//! Settings of the voice.

use std::path::PathBuf;

use super::{Player, Program, ServerOptions};

/// Presentation of prompts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum VoiceMode {
    /// Aloud if synthesis and a player work, otherwise as text.
    #[default]
    Auto,
    /// Aloud; if that is impossible, every prompt fails.
    Aloud,
    /// Printed as text: a prompt ends as soon as it starts.
    Print,
}

/// Settings of the voice.
#[derive(Clone, Debug, PartialEq)]
pub struct VoiceOptions {
    /// Presentation of prompts.
    pub mode: VoiceMode,
    /// The synthesis program; the one in the server's place, if there is a server.
    pub program: Program,
    /// A server that synthesises as long as it works.
    pub server: Option<ServerOptions>,
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
    /// Returns an American voice at a calm pace, aloud if possible.
    pub fn new(work: impl Into<PathBuf>) -> Self {
        Self {
            mode: VoiceMode::Auto,
            program: Program::EspeakNg("espeak-ng".into()),
            server: None,
            voice: "en-us".to_owned(),
            words_per_minute: 150,
            players: Player::default_players(),
            work: work.into(),
            audio_dir: None,
            foreseen: Vec::new(),
        }
    }
}
