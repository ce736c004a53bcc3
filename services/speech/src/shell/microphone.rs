//! The microphone and clients' streams as devices of the service.

use std::sync::Arc;
use std::time::Duration;

use crate::In;
use crate::devices::client_streams::ClientStreams;
use crate::devices::microphone::{
    Microphone, MicrophoneEvent, MicrophoneOptions, MicrophoneState, MicrophoneStatus,
};
use crate::devices::stream::PlaybackMask;
use crate::shell::recogniser::segmenter;
use config::{MicrophoneMode, Recogniser, Settings};
use service::Span;
use service::worker_channel::DeviceSender;

/// The microphone, or why it is off.
pub(super) struct MicrophoneDevice(Result<Microphone, String>);

impl MicrophoneDevice {
    pub(super) fn start(
        settings: &Settings,
        mask: &Arc<PlaybackMask>,
        inbox: &DeviceSender<In>,
    ) -> Self {
        let speech = &settings.speech;
        let reason = match (speech.microphone.mode, speech.recogniser) {
            (MicrophoneMode::Off, _) => Some(OFF),
            (_, Recogniser::None) => Some(NO_RECOGNISER),
            _ => None,
        };
        if let Some(reason) = reason {
            let (state, note) = (MicrophoneState::Off, reason.to_owned());
            let status = MicrophoneStatus { state, note, ..MicrophoneStatus::closed() };
            inbox.send(In::Microphone(status));
            return Self(Err(reason.to_owned()));
        }
        let inbox = inbox.clone();
        let sink = Box::new(move |event| offer(&inbox, event));
        Self(Ok(Microphone::start(MicrophoneOptions::of(&settings.speech), Arc::clone(mask), sink)))
    }

    /// Records one utterance.
    ///
    /// # Errors
    /// The microphone is off or busy; for users.
    pub(super) fn talk(&self, sound: u64, longest: Span) -> Result<(), String> {
        let microphone =
            self.0.as_ref().map_err(|reason| format!("the microphone is off: {reason}"))?;
        let longest = Duration::from_secs_f64(longest.s());
        microphone.talk(sound, longest).map_err(|error| error.to_string())
    }
}

/// Starts the segmentation of clients' streams.
pub(super) fn streams(
    settings: &Settings,
    mask: &Arc<PlaybackMask>,
    inbox: &DeviceSender<In>,
) -> ClientStreams {
    let inbox = inbox.clone();
    let sink = Box::new(move |event| offer(&inbox, event));
    ClientStreams::start(segmenter(settings), Arc::clone(mask), sink)
}

fn offer(inbox: &DeviceSender<In>, event: MicrophoneEvent) -> Result<(), MicrophoneEvent> {
    let message = match event {
        MicrophoneEvent::Stream(event) => In::Stream(event),
        MicrophoneEvent::Status(status) => In::Microphone(status),
    };
    match inbox.offer(message) {
        Err(In::Stream(event)) => Err(MicrophoneEvent::Stream(event)),
        Err(In::Microphone(status)) => Err(MicrophoneEvent::Status(status)),
        Ok(()) | Err(_) => Ok(()),
    }
}

const OFF: &str = "set mode = \"push-to-talk\" (file speech.toml, table [microphone]) and run: \
    whichone reload";
const NO_RECOGNISER: &str = "speech recognition is switched off (speech.recogniser)";
