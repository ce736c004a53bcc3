//! The voice as a device of the service.

use std::path::Path;
use std::sync::Arc;

use crate::{Device, In, PlaybackState, options};
use config::Settings;
use service::clock;
use service::worker_channel::DeviceSender;
use speech_engines::stream::PlaybackMask;
use speech_engines::voice::{Voice, VoiceEvent, VoiceOptions, VoiceOutput};

/// Starts the voice.
pub(super) fn start(
    settings: &Settings,
    work: &Path,
    mask: Arc<PlaybackMask>,
    inbox: &DeviceSender<In<'static>>,
) -> Voice {
    let options = VoiceOptions {
        audio_dir: settings.voice_dir(work),
        foreseen: dialogue::rendering::foreseen(&settings.scene),
        ..options::voice(&settings.speech, &work.join("voice"))
    };
    let (voice, events) = Voice::start(options);
    let (inbox, mut is_aloud) = (inbox.clone(), false);
    super::forward("voice", events, move |event| match event {
        VoiceEvent::Output(output) => {
            match &output {
                VoiceOutput::Aloud(player) => {
                    tracing::info!(program = player.program, "questions are spoken");
                }
                VoiceOutput::Text { reason } => {
                    tracing::info!(reason, "questions are shown as text");
                }
            }
            is_aloud = matches!(output, VoiceOutput::Aloud(_));
            true
        }
        VoiceEvent::Playback(event) => {
            // Text on a screen does not reach any microphone.
            match event.state {
                PlaybackState::Started if is_aloud => mask.begins(clock::now()),
                PlaybackState::Started => {}
                _ => mask.ends(clock::now()),
            }
            inbox.send(In::Playback(event))
        }
        VoiceEvent::Server(note) => inbox.send(In::Server { of: Device::Voice, note }),
    });
    voice
}
