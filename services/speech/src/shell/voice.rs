//! The voice as a device of the service.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::devices::stream::PlaybackMask;
use crate::devices::voice::{Voice, VoiceEvent, VoiceOptions, VoiceOutput};
use crate::{In, PlaybackRequest, PlaybackState};
use config::Settings;
use service::clock;
use service::worker_channel::DeviceSender;

/// The voice.
pub(super) struct VoiceDevice(Voice);

impl VoiceDevice {
    pub(super) fn start(
        settings: &Settings,
        work: &Path,
        mask: Arc<PlaybackMask>,
        inbox: &DeviceSender<In>,
    ) -> Self {
        let options = VoiceOptions {
            audio_dir: settings.voice_dir(work),
            ..VoiceOptions::of(&settings.speech, &work.join("voice"))
        };
        let (voice, events) = Voice::start(options);
        let inbox = inbox.clone();
        let is_aloud = AtomicBool::new(false);
        super::forward("voice", events, move |event| match event {
            VoiceEvent::Output(output) => {
                is_aloud.store(matches!(output, VoiceOutput::Aloud(_)), Ordering::Relaxed);
                log(&output);
                true
            }
            VoiceEvent::Playback(event) => {
                // Text on a screen does not reach any microphone.
                match event.state {
                    PlaybackState::Started if is_aloud.load(Ordering::Relaxed) => {
                        mask.begins(clock::now());
                    }
                    PlaybackState::Started => {}
                    _ => mask.ends(clock::now()),
                }
                inbox.send(In::Playback(event))
            }
        });
        Self(voice)
    }

    pub(super) fn speak(&self, request: &PlaybackRequest) {
        self.0.interrupt();
        let name = format!("{}-{}", request.prompt, request.presentation);
        if let Err(error) = self.0.speak(request.playback, &name, &request.text) {
            tracing::warn!(%error, "prompt not spoken");
        }
    }

    pub(super) fn stop(&self) {
        self.0.interrupt();
    }
}

fn log(output: &VoiceOutput) {
    match output {
        VoiceOutput::Aloud(player) => {
            tracing::info!(program = player.program, "questions are spoken");
        }
        VoiceOutput::Text { reason } => tracing::info!(reason, "questions are shown as text"),
    }
}
