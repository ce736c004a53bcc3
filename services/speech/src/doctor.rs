//! Checks of recogniser, voice and microphone for `whichone doctor`.

use std::io;
use std::path::Path;

use config::{MicrophoneMode, Recogniser, Settings};
use safe_files::TemporaryFolder;
use service::inspection::Finding;
use speech_engines::microphone::Microphone;
use speech_engines::recogniser::{Backend, second_opinion};
use speech_engines::voice::{Voice, VoiceOptions};

use crate::options;

/// Checks all devices as the service opens them.
pub(crate) fn examine(settings: &Settings) -> Vec<Finding> {
    let second = settings.speech.whisper_model.as_deref();
    let second = second.map(|model| second_recogniser(model, settings));
    let found = vec![recogniser(settings), voice(settings), microphone(settings)];
    found.into_iter().chain(second).collect()
}

/// Opens the recogniser as the service does.
fn recogniser(settings: &Settings) -> Finding {
    const WHAT: &str = "recogniser";
    if settings.speech.recogniser == Recogniser::None {
        return Finding::good(WHAT, "switched off (speech.recogniser)");
    }
    let work = match TemporaryFolder::new() {
        Ok(work) => work,
        Err(error) => return no_folder(WHAT, &error),
    };
    let backend = options::backend(&settings.speech, work.path());
    let (first, words) = match backend.open(&settings.scene) {
        Ok(opened) => opened,
        Err(error) => {
            return Finding::poor(WHAT, format!("{error}; without it only typed text works"));
        }
    };
    if !words.is_empty() {
        let words = words.join(", ");
        return Finding::poor(
            WHAT,
            format!("words of the scene that cannot be recognised: {words}"),
        );
    }
    match &backend {
        Backend::PocketSphinx(options) => {
            Finding::good(WHAT, format!("pocketsphinx with {}", options.model.display()))
        }
        Backend::Command(options) => Finding::good(WHAT, options.command.join(" ")),
        Backend::Wyoming(options) => server(WHAT, options.examine(), first.is_missing()),
    }
}

/// Returns the finding about a server. `is_alone`: no built-in recogniser listens beside it.
fn server(what: &str, examined: Result<String, String>, is_alone: bool) -> Finding {
    const ALONE: &str = "nothing stops the arm by voice without the server; help: install the \
                         packages libpocketsphinx3 and pocketsphinx-en-us";
    match (examined, is_alone) {
        (Ok(programs), false) => Finding::good(what, programs),
        (Ok(found) | Err(found), true) => Finding::poor(what, format!("{found}; {ALONE}")),
        (Err(reason), false) => {
            Finding::poor(what, format!("{reason}; the built-in one takes its place"))
        }
    }
}

fn no_folder(what: &str, error: &io::Error) -> Finding {
    Finding::poor(what, format!("not examined: no temporary folder: {error}"))
}

/// Loads the second recogniser's model as the service does.
fn second_recogniser(model: &Path, settings: &Settings) -> Finding {
    const WHAT: &str = "second recogniser";
    match second_opinion::load(model, &settings.scene) {
        Ok(_) => Finding::good(WHAT, format!("whisper.cpp with {}", model.display())),
        Err(error) => Finding::poor(WHAT, format!("{error}; without it the first one decides")),
    }
}

/// Starts the voice as the service does.
fn voice(settings: &Settings) -> Finding {
    const WHAT: &str = "voice";
    if settings.speech.voice == config::Voice::Print {
        return Finding::good(WHAT, "switched off (speech.voice)");
    }
    let work = match TemporaryFolder::new() {
        Ok(work) => work,
        Err(error) => return no_folder(WHAT, &error),
    };
    // No prompt is spoken, so no audio is cached.
    let options = VoiceOptions { audio_dir: None, ..options::voice(&settings.speech, work.path()) };
    match Voice::try_out(options) {
        Ok(what) => Finding::good(WHAT, what),
        Err(reason) => Finding::poor(WHAT, reason),
    }
}

/// Records for a moment as the service does.
fn microphone(settings: &Settings) -> Finding {
    const WHAT: &str = "microphone";
    if settings.speech.microphone.mode == MicrophoneMode::Off {
        return Finding::good(WHAT, "switched off (speech.microphone.mode)");
    }
    match Microphone::try_out(options::microphone(&settings.speech)) {
        Ok(program) => Finding::good(WHAT, format!("{program} records")),
        Err(why) => Finding::poor(
            WHAT,
            format!("{why}; help: connect one, or set a program in speech.microphone.command"),
        ),
    }
}
