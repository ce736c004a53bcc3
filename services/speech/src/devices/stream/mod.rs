//! A live stream of sound, cut into utterances while it comes in.
//!
//! Invariant: every [`StreamEvent::Began`] is followed by exactly one [`StreamEvent::Ended`], at
//! the latest when the stream ends, and what lies between is about that utterance; a
//! [`StreamEvent::Paused`] after which nobody goes on holds the very cut of the end. What is kept is
//! bounded by the longest utterance.

mod clock;
mod half_duplex;
mod own_voice;

use std::ops::Range;

use service::Time;

pub use clock::SampleClock;
pub(crate) use clock::shifted;
pub use half_duplex::{Duplex, Listener};
pub use own_voice::OwnVoice;

use crate::devices::audio::RATE_HZ;
use crate::devices::vad::{SegmentEvent, Segmenter, SegmenterOptions};

/// Samples beyond the pre-roll that are kept while nobody speaks: the detector decides on the
/// third frame of speech, and a frame may be incomplete.
const UNDECIDED: usize = 8 * 256;

/// Sound of an utterance that is told while it lasts, in pieces of this many samples: 350 ms.
const PIECE: usize = 5_600;

/// An utterance cut out of a stream, with the quiet around it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cut {
    /// When the person began to speak.
    pub onset: Time,
    /// When the person had ended.
    pub end: Time,
    /// What to decode, one channel at [`RATE_HZ`].
    pub samples: Vec<i16>,
    /// Where in `samples` the speech is.
    pub speech: Range<usize>,
}

/// What a stream has come to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum StreamEvent {
    /// Somebody began to speak at this time.
    Began(Time),
    /// Who speaks has come so far: the samples since the last such event, from the quiet before the
    /// voice on.
    SoFar(Vec<i16>),
    /// Who speaks has paused; perhaps this is all.
    Paused(Cut),
    /// Whoever spoke has ended.
    Ended(Cut),
}

/// Finds the utterances in a stream.
pub struct Stream {
    segmenter: Segmenter,
    pre_roll: usize,
    /// The latest samples.
    kept: Vec<i16>,
    /// Number of the first sample that is kept, from the stream's beginning.
    first: usize,
    /// The number of a sample, and its time.
    anchor: (usize, Time),
    /// While somebody speaks, the number of the first sample that was not told yet.
    open: Option<usize>,
}

impl Stream {
    /// A stream that has not begun.
    pub fn new(options: SegmenterOptions) -> Self {
        let pre_roll = (options.pre_roll_s * f64::from(RATE_HZ)) as usize;
        let segmenter = Segmenter::new(options);
        Self { segmenter, pre_roll, kept: Vec::new(), first: 0, anchor: (0, Time(0)), open: None }
    }

    /// Whether somebody is speaking.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Takes the next samples, the first of which was taken at `at`.
    pub fn push(&mut self, at: Time, samples: &[i16]) -> Vec<StreamEvent> {
        self.anchor = (self.first + self.kept.len(), at);
        self.kept.extend_from_slice(samples);
        let found = self.segmenter.push(samples);
        let mut events = self.told(found);
        events.extend(self.so_far());
        if !self.is_open() {
            let spare = self.kept.len().saturating_sub(self.pre_roll + UNDECIDED);
            self.kept.drain(..spare);
            self.first += spare;
        }
        events
    }

    /// The stream ends or is broken: an utterance that is going on ends with it. What comes next
    /// is a new stream.
    pub fn finish(&mut self) -> Vec<StreamEvent> {
        let found = self.segmenter.finish();
        let events = self.told(found);
        self.kept.clear();
        self.first = 0;
        events
    }

    /// What was said since this was told last.
    fn so_far(&mut self) -> Vec<StreamEvent> {
        let Some(from) = &mut self.open else { return Vec::new() };
        let untold = &self.kept[(*from - self.first).min(self.kept.len())..];
        let pieces = untold.chunks_exact(PIECE);
        let events: Vec<_> = pieces.map(|piece| StreamEvent::SoFar(piece.to_vec())).collect();
        *from += events.len() * PIECE;
        events
    }

    fn told(&mut self, found: Vec<SegmentEvent>) -> Vec<StreamEvent> {
        found.into_iter().map(|event| self.event(event)).collect()
    }

    fn event(&mut self, event: SegmentEvent) -> StreamEvent {
        match event {
            SegmentEvent::Onset { at_sample } => {
                self.open = Some(at_sample.saturating_sub(self.pre_roll).max(self.first));
                StreamEvent::Began(self.time(at_sample))
            }
            SegmentEvent::Pause { range, speech } => StreamEvent::Paused(self.cut(range, speech)),
            SegmentEvent::End { range, speech } => {
                self.open = None;
                StreamEvent::Ended(self.cut(range, speech))
            }
        }
    }

    fn cut(&self, range: Range<usize>, speech: Range<usize>) -> Cut {
        let kept = |sample: usize| sample.saturating_sub(self.first).min(self.kept.len());
        let samples = self.kept[kept(range.start)..kept(range.end)].to_vec();
        let inside = |sample: usize| (kept(sample) - kept(range.start)).min(samples.len());
        Cut {
            onset: self.time(speech.start),
            end: self.time(speech.end),
            speech: inside(speech.start)..inside(speech.end),
            samples,
        }
    }

    fn time(&self, sample: usize) -> Time {
        let (number, time) = self.anchor;
        shifted(time, sample as i64 - number as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::voice;

    const MS: u64 = 1_000_000;
    const BEGAN: u64 = 50_000;

    /// Two utterances in a stream that begins at [`BEGAN`] ms: 1 s to 2 s and 3.5 s to 4.1 s.
    fn sound() -> Vec<i16> {
        let quiet = |s: f64| vec![0; (s * f64::from(RATE_HZ)) as usize];
        [quiet(1.0), voice(1.0), quiet(1.5), voice(0.6), quiet(1.0)].concat()
    }

    fn run(stream: &mut Stream, sound: &[i16], piece: usize) -> Vec<StreamEvent> {
        let mut events = Vec::new();
        for (n, samples) in sound.chunks(piece).enumerate() {
            let at = shifted(Time(BEGAN * MS), (n * piece) as i64);
            events.extend(stream.push(at, samples));
        }
        events
    }

    /// Without what is told while an utterance lasts.
    fn edges(events: Vec<StreamEvent>) -> Vec<StreamEvent> {
        let is_edge = |e: &StreamEvent| matches!(e, StreamEvent::Began(_) | StreamEvent::Ended(_));
        events.into_iter().filter(is_edge).collect()
    }

    fn near(time: Time, ms: u64) -> bool {
        time.ns().abs_diff((BEGAN + ms) * MS) < 200 * MS
    }

    #[test]
    fn each_utterance_begins_and_ends_at_its_time_with_its_sound() {
        let sound = sound();
        let mut stream = Stream::new(SegmenterOptions::default());
        let events = edges(run(&mut stream, &sound, 320));
        let [
            StreamEvent::Began(first),
            StreamEvent::Ended(a),
            StreamEvent::Began(second),
            StreamEvent::Ended(b),
        ] = events.as_slice()
        else {
            panic!("{events:?}")
        };
        assert!(near(*first, 1_000) && near(a.end, 2_000) && a.onset == *first);
        assert!(near(*second, 3_500) && near(b.end, 4_100) && b.onset == *second);
        for cut in [a, b] {
            let at = cut.onset.since(Time(BEGAN * MS)).0 / 62_500;
            let from = at as usize - cut.speech.start;
            assert_eq!(cut.samples, sound[from..from + cut.samples.len()], "the very samples");
            assert_eq!(cut.speech.start, 8_000, "half a second of pre-roll");
        }
        assert!(!stream.is_open() && stream.finish().is_empty());
    }

    #[test]
    fn pieces_of_any_length_tell_alike() {
        let sound = sound();
        let run = |piece| edges(run(&mut Stream::new(SegmenterOptions::default()), &sound, piece));
        let expected = run(320);
        for piece in [33, 256, 1_600, sound.len()] {
            assert_eq!(run(piece), expected, "pieces of {piece}");
        }
    }

    #[test]
    fn a_stream_that_ends_in_the_middle_of_a_word_ends_the_utterance_once() {
        let mut stream = Stream::new(SegmenterOptions::default());
        let events = edges(run(&mut stream, &sound()[..24_000], 320));
        assert!(matches!(events.as_slice(), [StreamEvent::Began(_)]), "{events:?}");
        assert!(stream.is_open());
        let events = stream.finish();
        let [StreamEvent::Ended(cut)] = events.as_slice() else { panic!("{events:?}") };
        assert!(near(cut.end, 1_500), "{:?}", cut.end);
        assert!(!stream.is_open() && stream.finish().is_empty());
        assert_eq!(edges(run(&mut stream, &sound(), 320)).len(), 4, "and is as new");
    }

    #[test]
    fn a_pause_after_which_nobody_goes_on_holds_the_cut_of_the_end() {
        let pause = vec![0; 5_000];
        let sound = [sound()[..30_000].to_vec(), pause, voice(0.5), vec![0; 16_000]].concat();
        let events = run(&mut Stream::new(SegmenterOptions::default()), &sound, 320);
        let cuts = events.iter().filter_map(|event| match event {
            StreamEvent::Paused(cut) | StreamEvent::Ended(cut) => Some(cut),
            _ => None,
        });
        let [first, second, end] = cuts.collect::<Vec<_>>()[..] else { panic!("{events:?}") };
        assert_eq!(second, end, "the very cut");
        assert_eq!(first.onset, end.onset);
        assert!(first.samples.len() < end.samples.len(), "somebody went on after the first pause");
    }

    #[test]
    fn what_is_told_while_somebody_speaks_is_the_sound_from_before_the_voice_on() {
        let sound = sound();
        for piece in [320, 4_000, sound.len()] {
            let events =
                run(&mut Stream::new(SegmenterOptions::default()), &sound[..50_000], piece);
            let told = events.iter().filter_map(|event| match event {
                StreamEvent::SoFar(samples) => Some(samples.clone()),
                _ => None,
            });
            let told: Vec<i16> = told.flatten().collect();
            let StreamEvent::Began(at) = events[0] else { panic!("{events:?}") };
            let onset = (at.since(Time(BEGAN * MS)).0 / 62_500) as usize;
            let expected = &sound[onset - 8_000..];
            assert!(told.len() >= 11_200 || piece > 16_000, "{} samples", told.len());
            assert!(told == expected[..told.len()], "the very samples");
        }
    }

    #[test]
    fn what_is_kept_is_bounded() {
        let options = SegmenterOptions { longest_s: 2.0, ..SegmenterOptions::default() };
        let mut stream = Stream::new(options);
        run(&mut stream, &vec![0; 160_000], 320);
        assert!(stream.kept.len() <= 8_000 + UNDECIDED);
        let mut most = 0;
        for (n, samples) in voice(10.0).chunks(320).enumerate() {
            stream.push(shifted(Time(BEGAN * MS), n as i64 * 320), samples);
            most = most.max(stream.kept.len());
        }
        assert!(most < 32_000 + 8_000 + UNDECIDED + 8_000, "{most} samples");
    }
}
