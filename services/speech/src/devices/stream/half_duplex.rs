//! Half-duplex listening: nothing is heard while the robot itself speaks.

use std::sync::Arc;

use service::Time;

use super::{Closings, PlaybackMask, Stream, shifted};
use crate::devices::vad::SegmenterOptions;
use crate::stream_events::{Begin, StreamEvent};

/// Samples per decision: 16 ms.
const BLOCK: usize = 256;

/// Separation of a stream from the robot's own voice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Duplex {
    /// It may: the stream is muted while the robot speaks.
    Half,
    /// It does not (headset, echo cancellation, push-to-talk): the user may interrupt the robot.
    Full,
}

/// A [`Stream`] without the robot's own voice.
pub struct MaskedStream {
    stream: Stream,
    mask: Arc<PlaybackMask>,
    is_muted: bool,
}

impl MaskedStream {
    /// Returns a stream that has not begun.
    pub fn new(
        options: SegmenterOptions,
        mask: Arc<PlaybackMask>,
        closings: Arc<Closings>,
    ) -> Self {
        Self { stream: Stream::new(options, closings), mask, is_muted: false }
    }

    /// Processes the next samples; see [`Stream::push`]. An utterance in progress ends when the robot
    /// begins to speak.
    pub fn push(
        &mut self,
        at: Time,
        samples: &[i16],
        duplex: Duplex,
        began: Begin<'_>,
    ) -> Vec<StreamEvent> {
        let mut events = Vec::new();
        for (n, block) in samples.chunks(BLOCK).enumerate() {
            let at = shifted(at, (n * BLOCK) as i64);
            let mute = duplex == Duplex::Half && self.mask.covers(at);
            if mute && !self.is_muted {
                events.extend(self.stream.finish());
            }
            self.is_muted = mute;
            if !mute {
                events.extend(self.stream.push(at, block, began));
            }
        }
        events
    }

    /// Ends the utterance in progress with its voice; see [`Stream::release`].
    pub fn release(&mut self) {
        self.stream.release();
    }

    /// Ends the stream; see [`Stream::finish`].
    pub fn finish(&mut self) -> Option<StreamEvent> {
        self.is_muted = false;
        self.stream.finish()
    }

    /// Returns the utterance in progress.
    pub fn sound_in_progress(&self) -> Option<u64> {
        self.stream.sound_in_progress()
    }

    /// Returns whether the latest samples were dropped.
    pub fn is_muted(&self) -> bool {
        self.is_muted
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::{began, voice};
    use service::Span;

    fn s(seconds: f64) -> Time {
        Time(1_000_000_000) + Span::from_s(seconds)
    }

    /// Returns the utterances found in four seconds of voice while the robot speaks from 1 s to 2 s.
    fn spans(duplex: Duplex) -> Vec<(f64, f64)> {
        let mask = Arc::new(PlaybackMask::new(Span::from_ms(300)));
        mask.begins(s(1.0));
        mask.ends(s(2.0));
        let mut stream = MaskedStream::new(SegmenterOptions::default(), mask, Arc::default());
        let mut events = Vec::new();
        for (n, samples) in voice(4.0).chunks(1_600).enumerate() {
            events.extend(stream.push(s(n as f64 / 10.0), samples, duplex, &mut began));
        }
        events.extend(stream.finish());
        let spans = events.iter().filter_map(|event| match event {
            StreamEvent::Ended { segment, .. } => {
                Some((segment.onset.since(s(0.0)).s(), segment.end.since(s(0.0)).s()))
            }
            _ => None,
        });
        spans.collect()
    }

    #[test]
    fn half_duplex_omits_the_robots_own_voice_and_full_duplex_does_not() {
        let half = spans(Duplex::Half);
        let [(began, ended), (again, end)] = half[..] else { panic!("{half:?}") };
        assert!(began < 0.3 && (0.9..1.02).contains(&ended), "{half:?}");
        assert!((2.29..2.7).contains(&again) && end > 3.8, "{half:?}");
        let full = spans(Duplex::Full);
        let [(began, ended)] = full[..] else { panic!("{full:?}") };
        assert!(began < 0.3 && ended > 3.8, "{full:?}");
    }
}
