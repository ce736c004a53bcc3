//! The microphone and clients' streams as devices of the service.

use std::sync::Arc;

use crate::{In, options};
use config::{MicrophoneMode, Recogniser, Settings};
use service::worker_channel::DeviceSender;
use speech_engines::live_events::{MicrophoneStatus, Sink};
use speech_engines::microphone::{Microphone, MicrophoneState};
use speech_engines::stream::{Closings, PlaybackMask};

/// Starts the microphone, or returns why it is off.
pub(super) fn start(
    settings: &Settings,
    mask: &Arc<PlaybackMask>,
    closings: &Arc<Closings>,
    inbox: &DeviceSender<In<'static>>,
) -> Result<Microphone, String> {
    let speech = &settings.speech;
    let reason = match (speech.microphone.mode, speech.recogniser) {
        (MicrophoneMode::Off, _) => OFF,
        (_, Recogniser::None) => NO_RECOGNISER,
        _ => {
            let options = options::microphone(speech);
            return Ok(Microphone::start(
                options,
                Arc::clone(mask),
                Arc::clone(closings),
                sink(inbox),
            ));
        }
    };
    let (state, note) = (MicrophoneState::Off, reason.to_owned());
    inbox.send(In::Microphone(MicrophoneStatus { state, note, ..MicrophoneStatus::closed() }));
    Err(format!("the microphone is off: {reason}"))
}

/// Returns a sink for the events of a live source: the main loop, which may be busy.
pub(super) fn sink(inbox: &DeviceSender<In<'static>>) -> Sink {
    let inbox = inbox.clone();
    Box::new(move |event| {
        let refused = inbox.offer(In::from(event)).err();
        refused.and_then(In::live).map_or(Ok(()), Err)
    })
}

const OFF: &str = "set mode = \"push-to-talk\" (file speech.toml, table [microphone]) and run: \
    whichone reload";
const NO_RECOGNISER: &str = "speech recognition is switched off (speech.recogniser)";
