//! The recogniser as a device of the service.

use std::path::Path;

use crate::devices::ear::{
    Ear, EarEvent, EarOptions, EarState as Hearing, Segment as Heard, Sound,
};
use crate::devices::recogniser::{
    Backend, CommandOptions, Hypothesis as Decoded, Outcome, PocketSphinxOptions, WhisperOptions,
};
use crate::devices::stream::Cut;
use crate::devices::vad::SegmenterOptions;
use crate::{Hypothesis, In, Recognised, Segment, ToRecognise};
use config::Settings;
use messages::EarState;
use service::worker_channel::DeviceSender;

/// The recogniser, where there is one.
pub(super) struct EarDevice(Option<Ear>);

impl EarDevice {
    pub(super) fn start(settings: &Settings, work: &Path, inbox: &DeviceSender<In>) -> Self {
        let inbox = inbox.clone();
        if settings.speech.recogniser == config::Recogniser::None {
            inbox.send(In::Ear(EarState::Off));
            return Self(None);
        }
        let (ear, events) = Ear::start(&settings.scene, ear_options(settings, work));
        super::forward("ear", events, move |event| inbox.send(heard(event)));
        Self(Some(ear))
    }

    /// Listens to a sound.
    ///
    /// # Errors
    /// It cannot be listened to just now, or not at all; in words for people.
    pub(super) fn recognise(&self, sound: u64, what: ToRecognise) -> Result<(), String> {
        let ear =
            self.0.as_ref().ok_or("speech recognition is switched off (speech.recogniser)")?;
        ear.hear(sound, take(what)).map_err(|error| error.to_string())
    }

    /// Takes what somebody is saying.
    pub(super) fn overhear(&self, sound: u64, samples: Vec<i16>) {
        if let Some(ear) = &self.0 {
            ear.overhear(sound, samples);
        }
    }

    /// Takes what somebody has perhaps said in full.
    pub(super) fn expect(&self, sound: u64, cut: Cut) {
        if let Some(ear) = &self.0 {
            ear.expect(sound, cut);
        }
    }
}

fn take(what: ToRecognise) -> Sound {
    match what {
        ToRecognise::File(path) => Sound::File(path.into()),
        ToRecognise::Speech(cut) => Sound::Speech(cut),
    }
}

/// How speech is cut out of sound.
pub(super) fn segmenter(settings: &Settings) -> SegmenterOptions {
    SegmenterOptions {
        closing_pause_s: settings.speech.closing_pause.as_secs_f64(),
        longest_s: settings.speech.spoken_max.as_secs_f64(),
        ..SegmenterOptions::default()
    }
}

fn ear_options(settings: &Settings, work: &Path) -> EarOptions {
    let speech = &settings.speech;
    EarOptions {
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

fn heard(event: EarEvent) -> In {
    match event {
        EarEvent::State(state) => In::Ear(hearing(&state)),
        EarEvent::SoFar { id, text } => In::SoFar { sound: id, text },
        EarEvent::Heard { id, segments } => {
            let segments = segments.into_iter().map(measured).collect();
            In::Recognised(Recognised { sound: id, segments: Ok(segments) })
        }
        EarEvent::Failed { id, error } => {
            In::Recognised(Recognised { sound: id, segments: Err(error) })
        }
    }
}

/// What recognition needs, decibels above the noise; below it hardly half of what is said is
/// understood.
const SNR_MIN_DB: f32 = 15.0;

fn measured(segment: Heard) -> Segment {
    let snr_db = segment.snr_db;
    if snr_db < SNR_MIN_DB {
        tracing::warn!(snr_db, "hard to hear over the noise: come nearer, or type instead");
    }
    let span_s = (segment.onset_s, segment.end_s);
    Segment { span_s, snr_db, heard: understood(segment.outcome) }
}

fn hearing(state: &Hearing) -> EarState {
    match state {
        Hearing::Loading => EarState::Loading,
        Hearing::Ready { unpronounceable } => {
            if !unpronounceable.is_empty() {
                tracing::warn!(?unpronounceable, "words of the scene that cannot be recognised");
            }
            EarState::Ready
        }
        Hearing::Off { reason } => {
            tracing::warn!(reason, "speech cannot be recognised; typed text works");
            EarState::Off
        }
    }
}

fn understood(outcome: Outcome) -> Result<Vec<Hypothesis>, String> {
    match outcome {
        Outcome::Accepted(decoded) => Ok(decoded.into_iter().map(hypothesis).collect()),
        Outcome::Rejected { text, reason } => {
            tracing::info!(text, ?reason, "heard, but not for the robot");
            Err(text)
        }
    }
}

fn hypothesis(decoded: Decoded) -> Hypothesis {
    Hypothesis {
        weight: f64::from(decoded.confidence.max(1e-3)),
        confidence: decoded.words.iter().map(|(_, confidence)| *confidence).collect(),
        text: decoded.text,
    }
}
