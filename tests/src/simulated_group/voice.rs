//! The robot's voice: sentences take their time, and are heard of when they begin and end.

use service::Span;
use speech::{PlaybackEvent, PlaybackRequest, PlaybackState};

use super::{SimulatedGroup, Time};

/// Duration of a robot's sentence: median, seconds, and standard deviation of the logarithm.
pub(super) const SENTENCE_S: (f64, f64) = (1.9, 0.12);
/// A sentence in a group that is quick, so that faults hit more of its dialogue.
pub(super) const QUICK_SENTENCE_S: (f64, f64) = (0.4, 0.0);

/// A sentence that the voice is saying.
pub(super) struct Saying {
    playback: u64,
    /// When it is heard, if it is not yet.
    begins: Option<Time>,
    pub(super) ends: Time,
}

impl SimulatedGroup {
    pub(super) fn finish_sentence(&mut self) {
        let now = self.now;
        if let Some(saying) = &mut self.saying
            && saying.begins.take_if(|begins| *begins <= now).is_some()
        {
            let playback = saying.playback;
            self.voice(playback, PlaybackState::Started);
        }
        if let Some(saying) = self.saying.take_if(|saying| saying.ends <= now) {
            self.voice(saying.playback, PlaybackState::Ended);
        }
    }

    pub(super) fn voice(&mut self, playback: u64, state: PlaybackState) {
        let event = PlaybackEvent { playback, state };
        self.inboxes.speech.push(speech::In::Playback(event));
    }

    pub(super) fn speak(&mut self, line: &PlaybackRequest) {
        self.stop_speaking();
        let length_s = self.rng.log_normal(self.sentence_s.0, self.sentence_s.1);
        self.log(format_args!("robot: {}", line.text));
        let begins = self.now + self.synthesis;
        let ends = begins + Span::from_s(length_s);
        self.saying = Some(Saying { playback: line.playback, begins: Some(begins), ends });
        if self.synthesis == Span(0) {
            self.finish_sentence();
        }
    }

    pub(super) fn stop_speaking(&mut self) {
        if let Some(saying) = self.saying.take() {
            self.log("robot: …");
            self.voice(saying.playback, PlaybackState::Interrupted);
        }
    }
}
