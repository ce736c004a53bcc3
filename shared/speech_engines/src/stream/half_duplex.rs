//! Half-duplex listening: nothing is heard while the robot itself speaks.
//!
//! Users answer before the echo of the robot's voice is over. An echo only decays: a sound that
//! rises after a pause is a user, who is heard from that pause on. Without a pause the beginning of
//! an utterance may be missing, and with it a "not": such an utterance is marked as cut.

use std::sync::Arc;

use audio::shifted;
use vocabulary::time::{Span, Time};

use super::closings::Closings;
use super::events::{Began, Begin, StreamEvent};
use super::playback_mask::{OwnVoice, PlaybackMask};
use super::segmented_stream::Stream;
use crate::vad::{SegmenterOptions, level_db};

/// Samples per decision: 16 ms.
const BLOCK: usize = 256;
/// Blocks of a pause before a beginning: longer than the closure within a word.
const PAUSE: usize = 6;
/// A pause is at least this far below the voice that follows it, decibels.
const RISE_DB: f32 = 18.0;
/// The longest time in which the detector of speech finds a voice that is in progress, and by how
/// much it may become louder meanwhile, decibels.
const LATE: Span = Span::from_ms(400);
const LATE_DB: f32 = 10.0;

/// Separation of a stream from the robot's own voice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Duplex {
    /// Echo is possible: the stream is muted while the robot speaks.
    Half,
    /// No echo (headset, echo cancellation, push-to-talk): the user may interrupt the robot.
    Full,
}

/// A [`Stream`] without the robot's own voice.
pub struct MaskedStream {
    stream: Stream,
    mask: Arc<PlaybackMask>,
    own_voice: OwnVoice,
    /// Sound after the robot's voice, until the user's part of it is known.
    tail: Option<Tail>,
    /// Level of sound that follows the echo without a pause, and end of its test for a voice.
    edge: Option<(f32, Time)>,
}

/// The samples that follow the robot's voice.
#[derive(Default)]
struct Tail {
    samples: Vec<i16>,
    /// Number of samples that may contain the echo.
    echo: usize,
}

impl MaskedStream {
    /// Returns a stream that has not begun.
    pub fn new(
        options: SegmenterOptions,
        mask: Arc<PlaybackMask>,
        closings: Arc<Closings>,
    ) -> Self {
        Self {
            stream: Stream::new(options, closings),
            mask,
            own_voice: OwnVoice::Silent,
            tail: None,
            edge: None,
        }
    }

    /// Processes the next samples; see [`Stream::push`]. An utterance in progress ends when the
    /// robot begins to speak.
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
            self.own_voice = match duplex {
                Duplex::Half => self.mask.own_voice(at),
                Duplex::Full => OwnVoice::Silent,
            };
            match (self.own_voice, &mut self.tail) {
                (OwnVoice::Silent, None) => events.extend(self.listen(at, block, began)),
                (OwnVoice::Silent, Some(tail)) => {
                    tail.samples.extend_from_slice(block);
                    let end = shifted(at, block.len() as i64);
                    let after = tail.samples.len() - tail.echo;
                    if duplex == Duplex::Full || after >= PAUSE * BLOCK {
                        events.extend(self.unmute(end, duplex, began));
                    }
                }
                (OwnVoice::Echo, Some(tail)) => {
                    tail.samples.extend_from_slice(block);
                    tail.echo = tail.samples.len();
                }
                (OwnVoice::Echo | OwnVoice::Speaking, _) => {
                    self.tail = Some(Tail::default());
                    events.extend(self.cut_off());
                }
            }
        }
        events
    }

    /// Ends the utterance in progress, of which the robot covers the rest.
    fn cut_off(&mut self) -> impl Iterator<Item = StreamEvent> + use<> {
        let cut = self.stream.sound_in_progress().map(|sound| StreamEvent::Cut { sound });
        cut.into_iter().chain(self.stream.finish())
    }

    /// Listens again, from the user's beginning in the tail, which ends at `end`.
    fn unmute(&mut self, end: Time, duplex: Duplex, began: Begin<'_>) -> Vec<StreamEvent> {
        let Tail { samples, echo } = self.tail.take().unwrap_or_default();
        let begins = beginning(&samples);
        let from = begins.unwrap_or(echo);
        let at = |sample: usize| shifted(end, sample as i64 - samples.len() as i64);
        let is_uncertain = begins.is_none() && duplex == Duplex::Half;
        self.edge = is_uncertain.then(|| (level_db(&samples[from..]), at(from) + LATE));
        self.listen(at(from), &samples[from..], began)
    }

    fn listen(&mut self, at: Time, samples: &[i16], began: Begin<'_>) -> Vec<StreamEvent> {
        let mut events = Vec::new();
        for event in self.stream.push(at, samples, began) {
            let is_cut = |began: &Began| {
                self.edge.is_some_and(|(edge_db, until)| {
                    began.at < until && level_db(samples) < edge_db + LATE_DB
                })
            };
            let cut = match &event {
                StreamEvent::Began(began) if is_cut(began) => Some(began.sound),
                _ => None,
            };
            events.push(event);
            events.extend(cut.map(|sound| StreamEvent::Cut { sound }));
        }
        events
    }

    /// Ends the utterance in progress with its voice; see [`Stream::release`].
    pub fn release(&mut self) {
        self.stream.release();
    }

    /// Ends the stream; see [`Stream::finish`].
    pub fn finish(&mut self) -> Option<StreamEvent> {
        (self.own_voice, self.tail) = (OwnVoice::Silent, None);
        self.stream.finish()
    }

    /// Returns the utterance in progress.
    pub fn sound_in_progress(&self) -> Option<u64> {
        self.stream.sound_in_progress()
    }

    /// Returns whether the latest samples were dropped.
    pub fn is_muted(&self) -> bool {
        self.own_voice != OwnVoice::Silent
    }
}

/// Returns the first sample of the pause after which a user begins to speak, if any.
fn beginning(tail: &[i16]) -> Option<usize> {
    let levels: Vec<f32> = tail.chunks_exact(BLOCK).map(level_db).collect();
    let loudest = |levels: &[f32]| levels.iter().copied().fold(f32::MIN, f32::max);
    let pause = |at: &usize| loudest(&levels[*at..at + PAUSE]);
    let begins = |at: &usize| loudest(&levels[at + PAUSE..]) >= pause(at) + RISE_DB;
    (0..levels.len().saturating_sub(PAUSE)).find(begins).map(|block| block * BLOCK)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Rng, signed};
    use crate::testing::{began, voice};
    use vocabulary::time::Span;

    const RATE: f64 = 16_000.0;
    /// How long the microphone is muted after the robot's voice, seconds.
    const ECHO_S: f64 = 0.3;
    /// Reverberation time of a furnished room, seconds, and its level below the voice.
    const REVERBERATION_S: f64 = 0.4;
    const REVERBERATION: f64 = 0.3;

    fn s(seconds: f64) -> Time {
        Time(1_000_000_000) + Span::from_s(seconds)
    }

    /// Returns the beginnings and ends of the utterances that are heard in `recording` while the
    /// robot speaks from 1 s to 2 s, and whether a part of each is missing.
    fn spans(recording: &[i16], duplex: Duplex) -> Vec<(f64, f64, bool)> {
        let mask = Arc::new(PlaybackMask::new(Span::from_s(ECHO_S)));
        mask.begins(s(1.0));
        mask.ends(s(2.0));
        let mut stream = MaskedStream::new(SegmenterOptions::default(), mask, Arc::default());
        let mut events = Vec::new();
        for (n, samples) in recording.chunks(1_600).enumerate() {
            events.extend(stream.push(s(n as f64 / 10.0), samples, duplex, &mut began));
        }
        events.extend(stream.finish());
        let mut is_cut = false;
        let spans = events.iter().filter_map(|event| match event {
            StreamEvent::Began(_) => {
                is_cut = false;
                None
            }
            StreamEvent::Cut { .. } => {
                is_cut = true;
                None
            }
            StreamEvent::Ended { segment, .. } => {
                Some((segment.onset.since(s(0.0)).s(), segment.end.since(s(0.0)).s(), is_cut))
            }
            _ => None,
        });
        spans.collect()
    }

    /// Returns four seconds of a quiet room in which the robot speaks from 1 s to 2 s, and a user,
    /// half as loud, in these intervals.
    fn room(user: &[(f64, f64)]) -> Vec<i16> {
        let mut rng = Rng::new(1);
        let mut sound: Vec<f64> = (0..64_000).map(|_| f64::from(signed(&mut rng)) * 12.0).collect();
        let mut add = |from_s: f64, samples: &[i16], gain: f64| {
            for (sample, added) in sound[(from_s * RATE) as usize..].iter_mut().zip(samples) {
                *sample += gain * f64::from(*added);
            }
        };
        add(1.0, &voice(1.0), 1.0);
        for (from_s, to_s) in user {
            add(*from_s, &voice(to_s - from_s), 0.5);
        }
        let mut tail = |n: usize| {
            let fallen_db = 60.0 * n as f64 / RATE / REVERBERATION_S;
            let level = 6_000.0 * REVERBERATION * 10_f64.powf(-fallen_db / 20.0);
            (level * f64::from(signed(&mut rng))) as i16
        };
        let reverberation: Vec<i16> = (0..8_000).map(&mut tail).collect();
        add(2.0, &reverberation, 1.0);
        sound.into_iter().map(|sample| sample as i16).collect()
    }

    #[test]
    fn half_duplex_omits_the_robots_own_voice_and_its_echo() {
        assert_eq!(spans(&room(&[]), Duplex::Half), []);
        let robot = spans(&room(&[]), Duplex::Full);
        assert!(matches!(robot[..], [(began, ..)] if (0.9..1.2).contains(&began)), "{robot:?}");
    }

    #[test]
    fn full_duplex_hears_everything_from_the_first_word_on() {
        let full = spans(&voice(4.0), Duplex::Full);
        let [(began, ended, false)] = full[..] else { panic!("{full:?}") };
        assert!(began < 0.3 && ended > 3.8, "{full:?}");
    }

    #[test]
    fn half_duplex_marks_what_it_has_cut_out_of_an_utterance() {
        let half = spans(&voice(4.0), Duplex::Half);
        let [(began, ended, true), (again, end, true)] = half[..] else { panic!("{half:?}") };
        assert!(began < 0.3 && (0.9..1.02).contains(&ended), "{half:?}");
        assert!((2.29..2.7).contains(&again) && end > 3.8, "{half:?}");
    }

    /// Speech that begins in the tail of the mask is heard from its beginning on, unless it follows
    /// the robot's voice so closely that it may have begun before.
    #[test]
    fn half_duplex_hears_answers_from_their_beginning_as_far_as_that_can_be_told() {
        for (what, from, to, expected) in [
            ("during the robot's last words", 1.6, 2.9, Some((2.29..2.7, true))),
            ("at the end of its voice", 2.0, 2.8, Some((2.29..2.7, true))),
            ("in the tail", 2.2, 2.8, Some((2.17..2.3, false))),
            ("late in the tail", 2.26, 2.8, Some((2.2..2.33, false))),
            ("at the end of the tail", 2.31, 2.9, Some((2.27..2.4, false))),
            ("behind the tail", 2.5, 3.0, Some((2.45..2.6, false))),
            ("too short to be heard", 1.9, 2.25, None),
        ] {
            let heard = spans(&room(&[(from, to)]), Duplex::Half);
            match (expected, &heard[..]) {
                (None, []) => {}
                (Some((onset, is_cut)), [(began, ended, cut)]) => {
                    assert!(onset.contains(began) && *cut == is_cut, "{what}: {heard:?}");
                    assert!((to - 0.2..to + 0.2).contains(ended), "{what}: {heard:?}");
                }
                _ => panic!("{what}: {heard:?}"),
            }
        }
    }

    /// A pause within an utterance that the robot's voice covers is not a beginning.
    #[test]
    fn half_duplex_does_not_take_the_closure_within_a_word_for_a_beginning() {
        let heard = spans(&room(&[(1.5, 2.18), (2.24, 2.9)]), Duplex::Half);
        assert!(matches!(heard[..], [(.., true)]), "{heard:?}");
    }
}
