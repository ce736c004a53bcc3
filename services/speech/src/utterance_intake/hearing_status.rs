//! Quality of hearing, as published to clients and the policy.

use messages::{Activity, EarState, FixedText, Hearing};
use service::Time;
use speech_engines::live_events::MicrophoneStatus;

use crate::{Fx, Out};

/// State of microphone and recogniser, and measurements of the last utterance.
#[derive(serde::Serialize, serde::Deserialize)]
pub(super) struct HearingStatus {
    recogniser: EarState,
    hearing: Hearing,
}

impl Default for HearingStatus {
    fn default() -> Self {
        Self { recogniser: EarState::Loading, hearing: Hearing::default() }
    }
}

impl HearingStatus {
    pub(super) fn set_recogniser(&mut self, state: EarState) {
        self.recogniser = state;
    }

    pub(super) fn set_microphone(&mut self, status: &MicrophoneStatus) {
        self.hearing.microphone = status.state.code();
        self.hearing.level_db = status.level_db;
        self.hearing.restarts = status.restarts;
        self.hearing.dropped = status.dropped;
        self.hearing.note = FixedText::truncated(&status.note);
    }

    pub(super) fn set_onset(&mut self, onset: Time) {
        self.hearing.onset_ns = onset.ns();
    }

    pub(super) fn set_measured(&mut self, onset: Time, snr_db: f32) {
        self.set_onset(onset);
        (self.hearing.snr_db, self.hearing.measured) = (snr_db, 1);
    }

    /// Publishes the status with the number of pending sounds.
    pub(super) fn publish(&self, pending: usize, fx: &mut Fx) {
        let (pending, ear) = (pending as u32, self.recogniser.code());
        fx.publish(Out::Hearing(Hearing { pending, ear, ..self.hearing }));
    }

    /// Returns the activity of users: since when one speaks, and how much is pending.
    pub(super) fn activity(&self, since: Option<Time>, pending: usize) -> Activity {
        Activity {
            onset_ns: since.map_or(0, Time::ns),
            pending: pending as u32,
            ear: self.recogniser.code(),
            ..Activity::default()
        }
    }
}
