use messages::{EarState, Hearing, MicrophoneState};
use serde::Serialize;

/// Quality of the microphone signal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HearingView<'a> {
    /// State of the microphone.
    pub microphone: MicrophoneState,
    /// State of the recogniser.
    pub recogniser: EarState,
    /// Loudness, dB of full scale.
    pub level_db: f32,
    /// Signal-to-noise ratio of the latest utterance, dB; none before the first measurement.
    pub snr_db: Option<f32>,
    /// Sounds that wait for recognition.
    pub pending: u32,
    /// Restarts of the microphone's program.
    pub restarts: u32,
    /// Utterances that were lost.
    pub dropped: u32,
    /// The microphone's program, or why there is none.
    pub note: &'a str,
}

impl<'a> HearingView<'a> {
    /// Makes the view of a message, levels to whole decibels.
    pub fn new(hearing: &'a Hearing) -> Self {
        Self {
            microphone: hearing.microphone.get(),
            recogniser: hearing.ear.get(),
            level_db: hearing.level_db.round(),
            snr_db: (hearing.measured != 0).then(|| hearing.snr_db.round()),
            pending: hearing.pending,
            restarts: hearing.restarts,
            dropped: hearing.dropped,
            note: hearing.note.as_str().unwrap_or_default(),
        }
    }
}
