//! Programs that play a WAV file.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::child_process::{self, ChildProcess, ProcessError};

/// A program that plays the WAV file named by its last argument, and exits at its end. The name
/// `none` plays nothing: prompts take as long as they would, without sound.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Player {
    /// The program.
    pub program: String,
    /// Arguments before the file.
    pub arguments: Vec<String>,
}

/// Time limit for playing a moment of silence; a slower player hangs on a device.
const TRIAL_TIMEOUT: Duration = Duration::from_secs(3);

impl Player {
    /// Returns the players of ALSA (package alsa-utils), PipeWire (pipewire-bin) and PulseAudio
    /// (pulseaudio-utils).
    pub fn default_players() -> Vec<Self> {
        let player = |program: &str, arguments: &[&str]| Self {
            program: program.to_owned(),
            arguments: arguments.iter().map(|&a| a.to_owned()).collect(),
        };
        vec![player("aplay", &["-q"]), player("pw-play", &[]), player("paplay", &[])]
    }

    /// Returns whether the player plays nothing.
    pub fn is_none(&self) -> bool {
        self.program == "none"
    }

    /// Returns the first of `players` that plays `silence`, a short WAV file: an installed program
    /// or a listed card may still be unusable.
    ///
    /// # Errors
    /// If none does; with the reason for each.
    pub(super) fn find(players: &[Self], silence: &Path) -> Result<Self, String> {
        let mut reasons = Vec::new();
        for player in players {
            if player.is_none() {
                return Ok(player.clone());
            }
            match child_process::run(player.command(silence), TRIAL_TIMEOUT) {
                Ok(()) => return Ok(player.clone()),
                Err(error) => reasons.push(error.to_string()),
            }
        }
        Err(format!("no working sound card: {}", reasons.join("; ")))
    }

    /// Starts playing a file.
    pub(super) fn play(&self, file: &Path) -> Result<ChildProcess, ProcessError> {
        let mut command = self.command(file);
        command.stdout(Stdio::null());
        ChildProcess::start(command)
    }

    fn command(&self, file: &Path) -> Command {
        let mut command = Command::new(&self.program);
        command.args(&self.arguments).arg(file);
        command
    }
}
