//! The recogniser as a device of the service.

use std::path::Path;

use crate::devices::asr_worker::{AsrEvent, AsrOptions, AsrState, AsrWorker};
use crate::{In, Recognised};
use config::Settings;
use messages::EarState;
use service::worker_channel::DeviceSender;

/// Starts the recogniser, or returns why it is off.
pub(super) fn start(
    settings: &Settings,
    work: &Path,
    inbox: &DeviceSender<In>,
) -> Result<AsrWorker, String> {
    if settings.speech.recogniser == config::Recogniser::None {
        inbox.send(In::RecogniserState(EarState::Off));
        return Err("speech recognition is switched off (speech.recogniser)".to_owned());
    }
    let options = AsrOptions::of(&settings.speech, &work.join("recogniser"));
    let (worker, events) = AsrWorker::start(&settings.scene, options);
    let inbox = inbox.clone();
    super::forward("recogniser", events, move |event| inbox.send(input(event)));
    Ok(worker)
}

fn input(event: AsrEvent) -> In {
    match event {
        AsrEvent::State(state) => In::RecogniserState(published(&state)),
        AsrEvent::InterimResult { sound, text } => In::InterimResult { sound, text },
        AsrEvent::Recognised(recognised) => {
            warn_of_noise(&recognised);
            In::Recognised(recognised)
        }
    }
}

/// Signal-to-noise ratio, decibels, below which hardly half of the speech is understood.
const SNR_MIN_DB: f32 = 15.0;

fn warn_of_noise(recognised: &Recognised) {
    for segment in recognised.segments.iter().flatten() {
        let snr_db = segment.snr_db;
        if snr_db < SNR_MIN_DB {
            tracing::warn!(snr_db, "loud background noise; help: speak closer, or type instead");
        }
    }
}

fn published(state: &AsrState) -> EarState {
    match state {
        AsrState::Loading => EarState::Loading,
        AsrState::Ready { unpronounceable } => {
            if !unpronounceable.is_empty() {
                tracing::warn!(?unpronounceable, "words of the scene that cannot be recognised");
            }
            EarState::Ready
        }
        AsrState::Off { reason } => {
            tracing::warn!(reason, "speech cannot be recognised; typed text works");
            EarState::Off
        }
    }
}
