//! Checks of recogniser, voice and microphone for `whichone doctor`.

use std::io;
use std::path::Path;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};

use config::{MicrophoneMode, Recogniser, Settings, Voice};
use safe_files::TemporaryFolder;
use service::Span;
use service::inspection::Finding;
use speech_engines::live_events::LiveEvent;
use speech_engines::microphone::{Microphone, MicrophoneOptions, MicrophoneState};
use speech_engines::recogniser::{Backend, second_opinion};
use speech_engines::stream::PlaybackMask;
use speech_engines::voice::{self, VoiceEvent, VoiceOptions, VoiceOutput};

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
    match backend.open(&settings.scene) {
        Ok((_, unpronounceable)) if unpronounceable.is_empty() => Finding::good(
            WHAT,
            match &backend {
                Backend::PocketSphinx(options) => {
                    format!("pocketsphinx with {}", options.model.display())
                }
                Backend::Command(options) => options.command.join(" "),
            },
        ),
        Ok((_, words)) => {
            let words = words.join(", ");
            Finding::poor(WHAT, format!("words of the scene that cannot be recognised: {words}"))
        }
        Err(error) => Finding::poor(WHAT, format!("{error}; without it only typed text works")),
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
    if settings.speech.voice == Voice::Print {
        return Finding::good(WHAT, "switched off (speech.voice)");
    }
    let work = match TemporaryFolder::new() {
        Ok(work) => work,
        Err(error) => return no_folder(WHAT, &error),
    };
    // No prompt is spoken, so no audio is cached.
    let options = VoiceOptions { audio_dir: None, ..options::voice(&settings.speech, work.path()) };
    let program = options.program.name();
    let (_voice, events) = voice::Voice::start(options);
    match events.recv() {
        Ok(VoiceEvent::Output(VoiceOutput::Aloud(player))) => {
            Finding::good(WHAT, format!("{program} through {}", player.program))
        }
        Ok(VoiceEvent::Output(VoiceOutput::Text { reason })) => {
            Finding::poor(WHAT, format!("{reason}; questions are shown as text"))
        }
        _ => Finding::poor(WHAT, "it crashed; questions are shown as text"),
    }
}

/// Time limit for the first samples of a microphone.
const MICROPHONE_TIMEOUT: Duration = Duration::from_secs(3);

/// Records for a moment as the service does.
fn microphone(settings: &Settings) -> Finding {
    const WHAT: &str = "microphone";
    if settings.speech.microphone.mode == MicrophoneMode::Off {
        return Finding::good(WHAT, "switched off (speech.microphone.mode)");
    }
    let options = MicrophoneOptions { hands_free: true, ..options::microphone(&settings.speech) };
    let programs = options.programs.len();
    let (send, events) = mpsc::channel();
    let sink = move |event| {
        // Without a receiver the result is known already.
        let _ = send.send(event);
        Ok(())
    };
    let mask = Arc::new(PlaybackMask::new(Span::from_ms(0)));
    let _microphone = Microphone::start(options, mask, Arc::default(), Box::new(sink));
    let (until, mut failed) = (Instant::now() + MICROPHONE_TIMEOUT, Vec::new());
    while failed.len() < programs {
        let timeout = until.saturating_duration_since(Instant::now());
        match events.recv_timeout(timeout) {
            Ok(LiveEvent::Microphone(status)) => match status.state {
                MicrophoneState::Listening => {
                    return Finding::good(WHAT, format!("{} records", status.note));
                }
                MicrophoneState::Broken => failed.push(status.note),
                _ => {}
            },
            Ok(_) => {}
            Err(_) => {
                failed.push("the program delivers no audio".to_owned());
                break;
            }
        }
    }
    let why = failed.join("; ");
    Finding::poor(
        WHAT,
        format!("{why}; help: connect one, or set a program in speech.microphone.command"),
    )
}
