//! Programs that play a WAV file on the sound card.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::devices::child::{self, ChildError, Running};

/// A program that plays the WAV file named by its last argument, and ends when it has been heard.
/// One of the name `none` plays nothing: sentences take as long as they would, unheard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Player {
    /// The program.
    pub program: String,
    /// Its arguments before the file.
    pub arguments: Vec<String>,
}

/// A player that needs longer for a moment of silence hangs on a device.
const TRIAL: Duration = Duration::from_secs(3);

impl Player {
    /// The players of ALSA (package alsa-utils), PipeWire (pipewire-bin) and PulseAudio
    /// (pulseaudio-utils).
    pub fn usual() -> Vec<Self> {
        let player = |program: &str, arguments: &[&str]| Self {
            program: program.to_owned(),
            arguments: arguments.iter().map(|&a| a.to_owned()).collect(),
        };
        vec![player("aplay", &["-q"]), player("pw-play", &[]), player("paplay", &[])]
    }

    /// Whether it plays nothing.
    pub fn is_none(&self) -> bool {
        self.program == "none"
    }

    /// The first of `players` that really plays `silence`, a short WAV file: that a program is
    /// installed or a card is listed does not yet mean that it may be used.
    ///
    /// # Errors
    /// If none does; the text says why for each.
    pub(super) fn find(players: &[Self], silence: &Path) -> Result<Self, String> {
        let mut reasons = Vec::new();
        for player in players {
            if player.is_none() {
                return Ok(player.clone());
            }
            match child::run(player.command(silence), TRIAL) {
                Ok(()) => return Ok(player.clone()),
                Err(error) => reasons.push(error.to_string()),
            }
        }
        Err(format!("no player has a sound card: {}", reasons.join("; ")))
    }

    /// Starts to play a file.
    pub(super) fn play(&self, file: &Path) -> Result<Running, ChildError> {
        let mut command = self.command(file);
        command.stdout(Stdio::null());
        Running::start(command)
    }

    fn command(&self, file: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).arg(file);
        command
    }
}
