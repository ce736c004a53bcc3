//! The recogniser as a device of the service.

use std::path::Path;

use crate::devices::asr_worker::{AsrEvent, AsrOptions, AsrState, AsrWorker};
use crate::devices::recogniser::{Backend, CommandOptions, PocketSphinxOptions, WhisperOptions};
use crate::devices::stream::SpeechSegment;
use crate::devices::vad::SegmenterOptions;
use crate::{In, Recognised, RecognitionInput};
use config::Settings;
use messages::EarState;
use service::worker_channel::DeviceSender;

/// The recogniser, if there is one.
pub(super) struct RecogniserDevice(Option<AsrWorker>);

impl RecogniserDevice {
    pub(super) fn start(settings: &Settings, work: &Path, inbox: &DeviceSender<In>) -> Self {
        let inbox = inbox.clone();
        if settings.speech.recogniser == config::Recogniser::None {
            inbox.send(In::RecogniserState(EarState::Off));
            return Self(None);
        }
        let (worker, events) = AsrWorker::start(&settings.scene, options(settings, work));
        super::forward("recogniser", events, move |event| inbox.send(input(event)));
        Self(Some(worker))
    }

    /// Queues input.
    ///
    /// # Errors
    /// Recognition is off or its queue is full; for users.
    pub(super) fn submit(&self, sound: u64, input: RecognitionInput) -> Result<(), String> {
        let worker =
            self.0.as_ref().ok_or("speech recognition is switched off (speech.recogniser)")?;
        worker.submit(sound, input).map_err(|error| error.to_string())
    }

    /// Offers the next samples of a sound in progress.
    pub(super) fn interim_samples(&self, sound: u64, samples: Vec<i16>) {
        if let Some(worker) = &self.0 {
            worker.interim_samples(sound, samples);
        }
    }

    /// Offers a possible end of a sound.
    pub(super) fn decode_early(&self, sound: u64, segment: SpeechSegment) {
        if let Some(worker) = &self.0 {
            worker.decode_early(sound, segment);
        }
    }
}

/// Returns the settings of segmentation.
pub(super) fn segmenter(settings: &Settings) -> SegmenterOptions {
    SegmenterOptions {
        closing_pause_s: settings.speech.closing_pause.as_secs_f64(),
        longest_s: settings.speech.spoken_max.as_secs_f64(),
        ..SegmenterOptions::default()
    }
}

fn options(settings: &Settings, work: &Path) -> AsrOptions {
    let speech = &settings.speech;
    AsrOptions {
        recogniser: backend(speech, work),
        segmenter: segmenter(settings),
        gate_threshold: speech.accept_score_min as f32,
        longest_s: speech.recording_max.as_secs_f64(),
    }
}

fn backend(speech: &config::Speech, work: &Path) -> Backend {
    if speech.recogniser == config::Recogniser::Command {
        let command = speech.recogniser_command.clone().unwrap_or_default();
        return Backend::Command(CommandOptions::new(command));
    }
    if speech.recogniser == config::Recogniser::Whisper {
        let model = speech.whisper_model.clone().unwrap_or_default();
        return Backend::Whisper(WhisperOptions::new(model));
    }
    let options = PocketSphinxOptions::debian(work.join("recogniser"));
    let model = speech.model_dir.clone().unwrap_or_else(|| options.model.clone());
    Backend::PocketSphinx(PocketSphinxOptions { model, ..options })
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
