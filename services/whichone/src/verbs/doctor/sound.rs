//! Whether the robot can hear and be heard here.

use std::env;
use std::path::PathBuf;

use settings::{Recogniser, Settings, Voice};
use speech::devices::recogniser::{PocketSphinx, PocketSphinxOptions};
use speech::devices::voice::{self, VoiceEvent, VoiceOptions, VoiceOutput};

use super::{Finding, good, poor};

/// A folder for what the devices write, gone with this.
struct Work(PathBuf);

impl Work {
    fn new(name: &str) -> Self {
        Self(env::temp_dir().join(format!("whichone-doctor-{name}-{}", std::process::id())))
    }
}

impl Drop for Work {
    fn drop(&mut self) {
        // It may not have been made at all.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Opens the recogniser as the speech service does.
pub(super) fn recogniser(settings: &Settings) -> Finding {
    const WHAT: &str = "recogniser";
    if settings.speech.recogniser == Recogniser::None {
        return good(WHAT, "switched off (speech.recogniser)");
    }
    let work = Work::new("recogniser");
    let defaults = PocketSphinxOptions::debian(&work.0);
    let model = settings.speech.model_dir.clone().unwrap_or_else(|| defaults.model.clone());
    let options = PocketSphinxOptions { model, ..defaults };
    match PocketSphinx::open(&settings.scene, &options) {
        Ok(recogniser) if recogniser.unpronounceable().is_empty() => {
            good(WHAT, format!("pocketsphinx with {}", options.model.display()))
        }
        Ok(recogniser) => {
            let words = recogniser.unpronounceable().join(", ");
            poor(WHAT, format!("these words of the scene cannot be heard: {words}"))
        }
        Err(error) => poor(WHAT, format!("{error}; without it only typed words are heard")),
    }
}

/// Tries the voice as the speech service does.
pub(super) fn voice(settings: &Settings) -> Finding {
    const WHAT: &str = "voice";
    let work = Work::new("voice");
    if settings.speech.voice == Voice::Print {
        return good(WHAT, "switched off (speech.voice)");
    }
    // Nothing is said, so nothing is to be kept.
    let options = VoiceOptions { kept: None, ..VoiceOptions::of(&settings.speech, &work.0) };
    let speaks = options.program.name();
    let (_voice, events) = voice::Voice::start(options);
    match events.recv() {
        Ok(VoiceEvent::Output(VoiceOutput::Aloud(player))) => {
            good(WHAT, format!("{speaks} through {}", player.program))
        }
        Ok(VoiceEvent::Output(VoiceOutput::Text { reason })) => {
            poor(WHAT, format!("{reason}; questions are shown and not heard"))
        }
        _ => poor(WHAT, "it broke down; questions are shown and not heard"),
    }
}
