//! A microphone that does not listen while the robot itself speaks.

use std::sync::Arc;

use service::Time;

use super::{OwnVoice, Stream, StreamEvent, shifted};
use crate::devices::vad::SegmenterOptions;

/// Stretches of which it is decided whether they are heard: 16 ms.
const STRETCH: usize = 256;

/// Whether a stream may hold the robot's own voice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Duplex {
    /// It may: nothing is listened to while the robot speaks.
    Half,
    /// It does not (a headset, cancelled echo, a key that is held while the person speaks): the
    /// person may interrupt the robot.
    Full,
}

/// A [`Stream`] with the robot's own voice left out.
pub struct Listener {
    stream: Stream,
    own_voice: Arc<OwnVoice>,
    is_muted: bool,
}

impl Listener {
    /// A stream that has not begun.
    pub fn new(options: SegmenterOptions, own_voice: Arc<OwnVoice>) -> Self {
        Self { stream: Stream::new(options), own_voice, is_muted: false }
    }

    /// Takes the next samples, the first of which was taken at `at`. An utterance that is going on
    /// when the robot begins to speak ends there.
    pub fn hear(&mut self, at: Time, samples: &[i16], duplex: Duplex) -> Vec<StreamEvent> {
        let mut events = Vec::new();
        for (n, stretch) in samples.chunks(STRETCH).enumerate() {
            let at = shifted(at, (n * STRETCH) as i64);
            let mute = duplex == Duplex::Half && self.own_voice.sounds_at(at);
            if mute && !self.is_muted {
                events.extend(self.stream.finish());
            }
            self.is_muted = mute;
            if !mute {
                events.extend(self.stream.push(at, stretch));
            }
        }
        events
    }

    /// The stream ends or is broken; see [`Stream::finish`].
    pub fn finish(&mut self) -> Vec<StreamEvent> {
        self.is_muted = false;
        self.stream.finish()
    }

    /// Whether the latest samples were left out.
    pub fn is_muted(&self) -> bool {
        self.is_muted
    }

    /// Whether somebody is speaking.
    pub fn is_open(&self) -> bool {
        self.stream.is_open()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::voice;
    use service::Span;

    fn s(seconds: f64) -> Time {
        Time(1_000_000_000) + Span::from_s(seconds)
    }

    /// What is heard of a voice that goes on for four seconds, of which the robot's own sounds from
    /// 1 s to 2 s.
    fn heard(duplex: Duplex) -> Vec<(f64, f64)> {
        let own_voice = Arc::new(OwnVoice::new(Span::from_ms(300)));
        own_voice.begins(s(1.0));
        own_voice.ends(s(2.0));
        let mut listener = Listener::new(SegmenterOptions::default(), own_voice);
        let mut events = Vec::new();
        for (n, samples) in voice(4.0).chunks(1_600).enumerate() {
            events.extend(listener.hear(s(n as f64 / 10.0), samples, duplex));
        }
        events.extend(listener.finish());
        let spans = events.iter().filter_map(|event| match event {
            StreamEvent::Ended(cut) => {
                Some((cut.onset.since(s(0.0)).s(), cut.end.since(s(0.0)).s()))
            }
            _ => None,
        });
        spans.collect()
    }

    #[test]
    fn the_robots_own_voice_is_left_out() {
        let spans = heard(Duplex::Half);
        let [(began, ended), (again, end)] = spans.as_slice() else { panic!("{spans:?}") };
        assert!(*began < 0.3 && (0.9..1.02).contains(ended), "{spans:?}");
        assert!((2.29..2.7).contains(again) && *end > 3.8, "{spans:?}");
    }

    #[test]
    fn a_headset_hears_the_person_all_the_time() {
        let spans = heard(Duplex::Full);
        let [(began, ended)] = spans.as_slice() else { panic!("{spans:?}") };
        assert!(*began < 0.3 && *ended > 3.8, "{spans:?}");
    }
}
