//! The voice as a device of the service.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::devices::stream::OwnVoice;
use crate::devices::voice::{Voice, VoiceEvent as Device, VoiceOptions, VoiceOutput};
use crate::{In, Line, Spoken, VoiceEvent};
use config::Settings;
use service::clock;
use service::worker_channel::DeviceSender;

/// The voice.
pub(super) struct VoiceDevice(Voice);

impl VoiceDevice {
    pub(super) fn start(
        settings: &Settings,
        work: &Path,
        own_voice: Arc<OwnVoice>,
        inbox: &DeviceSender<In>,
    ) -> Self {
        let usual = VoiceOptions::of(&settings.speech, &work.join("voice"));
        let options = VoiceOptions { kept: settings.voice_dir(work), ..usual };
        let (voice, events) = Voice::start(options);
        let inbox = inbox.clone();
        let is_aloud = AtomicBool::new(false);
        super::forward("voice", events, move |event| {
            if let Device::Output(output) = &event {
                is_aloud.store(matches!(output, VoiceOutput::Aloud(_)), Ordering::Relaxed);
            }
            let Some((line, what)) = spoken(event) else { return true };
            // What is only shown does not sound in any microphone.
            match what {
                Spoken::Started if is_aloud.load(Ordering::Relaxed) => {
                    own_voice.begins(clock::now());
                }
                Spoken::Started => {}
                Spoken::Ended | Spoken::Interrupted => own_voice.ends(clock::now()),
            }
            inbox.send(In::Voice(VoiceEvent { line, what }))
        });
        Self(voice)
    }

    pub(super) fn speak(&self, line: &Line) {
        self.0.interrupt();
        if let Err(error) =
            self.0.speak(line.number, &format!("{}-{}", line.prompt, line.presentation), &line.text)
        {
            tracing::warn!(%error, "not said");
        }
    }

    pub(super) fn hush(&self) {
        self.0.interrupt();
    }
}

fn spoken(event: Device) -> Option<(u64, Spoken)> {
    match event {
        Device::Output(VoiceOutput::Aloud(player)) => {
            tracing::info!(program = player.program, "questions are spoken");
            None
        }
        Device::Output(VoiceOutput::Text { reason }) => {
            tracing::info!(reason, "questions are shown as text");
            None
        }
        Device::Started { id } => Some((id, Spoken::Started)),
        Device::Ended { id } => Some((id, Spoken::Ended)),
        Device::Interrupted { id } => Some((id, Spoken::Interrupted)),
        // Consoles show the text all the same, so the question counts as asked.
        Device::Failed { id, error } => {
            tracing::warn!(error, "shown as text instead of spoken");
            Some((id, Spoken::Ended))
        }
    }
}
