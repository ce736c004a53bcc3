//! The microphone as a device of the service.

use std::sync::Arc;
use std::time::Duration;

use crate::In;
use crate::devices::client_streams::ClientStreams;
use crate::devices::microphone::{
    Microphone, MicrophoneEvent, MicrophoneOptions, MicrophoneState, MicrophoneStatus,
};
use crate::devices::stream::OwnVoice;
use crate::shell::ear::segmenter;
use config::{MicrophoneMode, Recogniser, Settings};
use service::Span;
use service::worker_channel::DeviceSender;

/// The microphone, or why there is none.
pub(super) struct MicrophoneDevice(Result<Microphone, String>);

impl MicrophoneDevice {
    pub(super) fn start(
        settings: &Settings,
        own_voice: &Arc<OwnVoice>,
        inbox: &DeviceSender<In>,
    ) -> Self {
        let speech = &settings.speech;
        let why_not = match (speech.microphone.mode, speech.recogniser) {
            (MicrophoneMode::Off, _) => Some(OFF),
            (_, Recogniser::None) => Some(NO_RECOGNISER),
            _ => None,
        };
        if let Some(why) = why_not {
            let (state, note) = (MicrophoneState::Off, why.to_owned());
            inbox.send(In::Microphone(MicrophoneStatus {
                state,
                note,
                ..MicrophoneStatus::closed()
            }));
            return Self(Err(why.to_owned()));
        }
        let inbox = inbox.clone();
        let sink = Box::new(move |event| hand_over(&inbox, event));
        Self(Ok(Microphone::start(
            MicrophoneOptions::of(&settings.speech),
            Arc::clone(own_voice),
            sink,
        )))
    }

    /// Listens for one utterance.
    ///
    /// # Errors
    /// There is no microphone, or somebody talks already; in words for people.
    pub(super) fn talk(&self, sound: u64, longest: Span) -> Result<(), String> {
        let microphone = self.0.as_ref().map_err(|why| format!("the microphone is off: {why}"))?;
        let longest = Duration::from_secs_f64(longest.s());
        microphone.talk(sound, longest).map_err(|error| error.to_string())
    }
}

/// The listener to clients' streams.
pub(super) fn streams(
    settings: &Settings,
    own_voice: &Arc<OwnVoice>,
    inbox: &DeviceSender<In>,
) -> ClientStreams {
    let inbox = inbox.clone();
    let sink = Box::new(move |event| hand_over(&inbox, event));
    ClientStreams::start(segmenter(settings), Arc::clone(own_voice), sink)
}

fn hand_over(inbox: &DeviceSender<In>, event: MicrophoneEvent) -> Result<(), MicrophoneEvent> {
    let message = match event {
        MicrophoneEvent::Live(live) => In::Live(live),
        MicrophoneEvent::Status(status) => In::Microphone(status),
    };
    match inbox.offer(message) {
        Err(In::Live(live)) => Err(MicrophoneEvent::Live(live)),
        Err(In::Microphone(status)) => Err(MicrophoneEvent::Status(status)),
        Ok(()) | Err(_) => Ok(()),
    }
}

const OFF: &str = "set mode = \"push-to-talk\" (file speech.toml, table [microphone]) and run: \
    whichone reload";
const NO_RECOGNISER: &str = "speech recognition is switched off (speech.recogniser)";
