//! A live audio stream, segmented into utterances as it arrives.
//!
//! Invariant: every [`StreamEvent::Began`] is followed by exactly one [`StreamEvent::Ended`], at
//! the latest at the end of the stream, and all events between them belong to that utterance.
//! Unless speech continues, one of the [`StreamEvent::Paused`] carries the same segment as the end.
//! Memory is bounded by the longest utterance.

use std::ops::Range;
use std::sync::Arc;

use audio::shifted;
use vocabulary::time::Time;

use super::closings::Closings;
use super::events::{Begin, StreamEvent};
use super::segment::SpeechSegment;
use crate::audio::RATE_HZ;
use crate::vad::{Segmenter, SegmenterOptions, VadEvent};

/// Samples beyond the pre-roll that are kept between utterances: the detector decides on the third
/// frame of speech, and a frame may be incomplete.
const UNDECIDED: usize = 8 * 256;

/// Samples per block of an utterance in progress: 350 ms.
const BLOCK: usize = 5_600;

/// Finds the utterances in a stream.
pub struct Stream {
    segmenter: Segmenter,
    pre_roll: usize,
    /// The latest samples.
    buffer: Vec<i16>,
    /// Number of the first sample in the buffer, from the beginning of the stream.
    first: usize,
    /// Number and time of a sample.
    anchor: (usize, Time),
    /// The utterance in progress, and the number of its next sample to publish.
    open: Option<(u64, usize)>,
    closings: Arc<Closings>,
}

impl Stream {
    /// Returns a stream that has not begun.
    pub fn new(options: SegmenterOptions, closings: Arc<Closings>) -> Self {
        Self {
            closings,
            pre_roll: (options.pre_roll_s * f64::from(RATE_HZ)) as usize,
            segmenter: Segmenter::new(options),
            buffer: Vec::new(),
            first: 0,
            anchor: (0, Time(0)),
            open: None,
        }
    }

    /// Returns the utterance in progress.
    pub fn sound_in_progress(&self) -> Option<u64> {
        self.open.map(|(sound, _)| sound)
    }

    /// Processes the next samples, the first of which was recorded at `at`. `began` numbers an
    /// utterance by the time of its onset.
    pub fn push(&mut self, at: Time, samples: &[i16], began: Begin<'_>) -> Vec<StreamEvent> {
        self.anchor = (self.first + self.buffer.len(), at);
        if let Some((sound, _)) = self.open
            && let Some(closing) = self.closings.take(sound)
        {
            self.segmenter.set_closing(closing);
        }
        self.buffer.extend_from_slice(samples);
        let found = self.segmenter.push(samples).into_iter();
        let mut events: Vec<_> = found.filter_map(|event| self.event(event, began)).collect();
        events.extend(self.next_blocks());
        if self.open.is_none() {
            let spare = self.buffer.len().saturating_sub(self.pre_roll + UNDECIDED);
            self.buffer.drain(..spare);
            self.first += spare;
        }
        events
    }

    /// Ends the utterance in progress with its voice; see [`Segmenter::release`].
    pub fn release(&mut self) {
        self.segmenter.release();
    }

    /// Ends the stream and an utterance in progress with it. Further samples start a new stream.
    pub fn finish(&mut self) -> Option<StreamEvent> {
        let event = match self.segmenter.finish() {
            Some(VadEvent::End { range, speech }) => self.end(range, speech),
            _ => None,
        };
        self.buffer.clear();
        self.first = 0;
        event
    }

    /// Returns the blocks of the utterance in progress since the last call.
    fn next_blocks(&mut self) -> Vec<StreamEvent> {
        let Some((sound, from)) = &mut self.open else { return Vec::new() };
        let samples = &self.buffer[(*from - self.first).min(self.buffer.len())..];
        let block = |block: &[i16]| StreamEvent::Samples { sound: *sound, samples: block.to_vec() };
        let events: Vec<_> = samples.chunks_exact(BLOCK).map(block).collect();
        *from += events.len() * BLOCK;
        events
    }

    fn event(&mut self, event: VadEvent, began: Begin<'_>) -> Option<StreamEvent> {
        Some(match event {
            VadEvent::Onset { at_sample } => {
                let began = began(self.time(at_sample));
                let from = at_sample.saturating_sub(self.pre_roll).max(self.first);
                self.open = Some((began.sound, from));
                StreamEvent::Began(began)
            }
            VadEvent::Pause { range, speech } => {
                let (sound, _) = self.open?;
                StreamEvent::Paused { sound, segment: self.segment(range, speech) }
            }
            VadEvent::End { range, speech } => return self.end(range, speech),
        })
    }

    fn end(&mut self, range: Range<usize>, speech: Range<usize>) -> Option<StreamEvent> {
        let (sound, _) = self.open.take()?;
        Some(StreamEvent::Ended { sound, segment: self.segment(range, speech) })
    }

    fn segment(&self, range: Range<usize>, speech: Range<usize>) -> SpeechSegment {
        let offset = |sample: usize| sample.saturating_sub(self.first).min(self.buffer.len());
        let samples = self.buffer[offset(range.start)..offset(range.end)].to_vec();
        let inside = |sample: usize| (offset(sample) - offset(range.start)).min(samples.len());
        SpeechSegment {
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
    use crate::stream::Began;
    use crate::testing::{began, voice};
    use std::time::Duration;

    const MS: u64 = 1_000_000;
    const BEGAN: u64 = 50_000;

    /// Returns a stream with two utterances: 1 s to 2 s and 3.5 s to 4.1 s after [`BEGAN`] ms.
    fn recording() -> Vec<i16> {
        let quiet = |s: f64| vec![0; (s * f64::from(RATE_HZ)) as usize];
        [quiet(1.0), voice(1.0), quiet(1.5), voice(0.6), quiet(1.0)].concat()
    }

    fn run(stream: &mut Stream, samples: &[i16], block: usize) -> Vec<StreamEvent> {
        let mut events = Vec::new();
        for (n, samples) in samples.chunks(block).enumerate() {
            let at = shifted(Time(BEGAN * MS), (n * block) as i64);
            events.extend(stream.push(at, samples, &mut began));
        }
        events
    }

    fn new() -> Stream {
        Stream::new(SegmenterOptions::default(), Arc::default())
    }

    fn edges(events: Vec<StreamEvent>) -> Vec<StreamEvent> {
        events.into_iter().filter(|event| !event.is_optional()).collect()
    }

    fn near(time: Time, ms: u64) -> bool {
        time.ns().abs_diff((BEGAN + ms) * MS) < 200 * MS
    }

    #[test]
    fn stream_reports_utterances_with_times_and_samples() {
        let recording = recording();
        let mut stream = new();
        let events = edges(run(&mut stream, &recording, 320));
        let [
            StreamEvent::Began(Began { at: first, .. }),
            StreamEvent::Ended { segment: a, .. },
            StreamEvent::Began(Began { at: second, .. }),
            StreamEvent::Ended { segment: b, .. },
        ] = events.as_slice()
        else {
            panic!("{events:?}")
        };
        assert!(near(*first, 1_000) && near(a.end, 2_000) && a.onset == *first);
        assert!(near(*second, 3_500) && near(b.end, 4_100) && b.onset == *second);
        for segment in [a, b] {
            let at = segment.onset.since(Time(BEGAN * MS)).0 / 62_500;
            let from = at as usize - segment.speech.start;
            assert_eq!(segment.samples, recording[from..from + segment.samples.len()]);
            assert_eq!(segment.speech.start, 8_000, "half a second of pre-roll");
        }
        assert!(stream.sound_in_progress().is_none() && stream.finish().is_none());
        for block in [33, 256, 1_600, recording.len()] {
            assert_eq!(edges(run(&mut new(), &recording, block)), events, "blocks of {block}");
        }
    }

    #[test]
    fn stream_end_ends_an_utterance_in_progress_once() {
        let mut stream = new();
        let events = edges(run(&mut stream, &recording()[..24_000], 320));
        assert!(matches!(events.as_slice(), [StreamEvent::Began(_)]), "{events:?}");
        assert!(stream.sound_in_progress().is_some());
        let Some(StreamEvent::Ended { segment, .. }) = stream.finish() else { panic!() };
        assert!(near(segment.end, 1_500), "{:?}", segment.end);
        assert!(stream.sound_in_progress().is_none() && stream.finish().is_none());
        assert_eq!(edges(run(&mut stream, &recording(), 320)).len(), 4, "reusable");
    }

    #[test]
    fn stream_pause_carries_the_segment_of_the_end() {
        let pause = vec![0; 5_000];
        let samples = [recording()[..30_000].to_vec(), pause, voice(0.5), vec![0; 16_000]].concat();
        let events = run(&mut new(), &samples, 320);
        let segments = events.iter().filter_map(|event| match event {
            StreamEvent::Paused { segment, .. } | StreamEvent::Ended { segment, .. } => {
                Some(segment)
            }
            _ => None,
        });
        let segments = segments.collect::<Vec<_>>();
        let [first, .., second, end] = segments[..] else { panic!("{events:?}") };
        assert_eq!(second, end);
        assert_eq!(first.onset, end.onset);
        assert!(first.samples.len() < end.samples.len(), "speech continued after the first pause");
    }

    #[test]
    fn stream_closes_an_utterance_that_was_judged_with_the_samples_that_were_decoded() {
        let closings = Arc::new(Closings::default());
        let mut stream = Stream::new(SegmenterOptions::default(), Arc::clone(&closings));
        let mut judged: Option<SpeechSegment> = None;
        for (n, samples) in recording()[..48_000].chunks(320).enumerate() {
            let at = shifted(Time(BEGAN * MS), (n * 320) as i64);
            for event in stream.push(at, samples, &mut began) {
                match event {
                    StreamEvent::Paused { sound, segment } => {
                        closings.set(sound, segment.closing(Duration::from_millis(120)));
                        closings.set(sound + 1, segment.closing(Duration::ZERO));
                        judged = Some(segment);
                    }
                    StreamEvent::Ended { segment, .. } => {
                        assert_eq!(Some(&segment), judged.as_ref());
                        let later = segment.end + vocabulary::time::Span::from_ms(120);
                        let now = shifted(at, 320);
                        assert!(now >= later && now.since(later).s() < 0.05, "{now:?} {later:?}");
                        return;
                    }
                    _ => {}
                }
            }
        }
        panic!("no end");
    }

    #[test]
    fn stream_publishes_samples_in_progress_from_the_pre_roll_on() {
        let recording = recording();
        for block in [320, 4_000, recording.len()] {
            let events = run(&mut new(), &recording[..50_000], block);
            let samples = events.iter().filter_map(|event| match event {
                StreamEvent::Samples { samples, .. } => Some(samples.clone()),
                _ => None,
            });
            let samples: Vec<i16> = samples.flatten().collect();
            let StreamEvent::Began(Began { at, .. }) = events[0] else { panic!("{events:?}") };
            let onset = (at.since(Time(BEGAN * MS)).0 / 62_500) as usize;
            assert!(samples.len() >= 11_200 || block > 16_000, "{} samples", samples.len());
            assert!(samples == recording[onset - 8_000..][..samples.len()]);
        }
    }

    #[test]
    fn stream_memory_is_bounded() {
        let options = SegmenterOptions { longest_s: 2.0, ..SegmenterOptions::default() };
        let mut stream = Stream::new(options, Arc::default());
        run(&mut stream, &vec![0; 160_000], 320);
        assert!(stream.buffer.len() <= 8_000 + UNDECIDED);
        let mut most = 0;
        for (n, samples) in voice(10.0).chunks(320).enumerate() {
            stream.push(shifted(Time(BEGAN * MS), n as i64 * 320), samples, &mut began);
            most = most.max(stream.buffer.len());
        }
        assert!(most < 32_000 + 8_000 + UNDECIDED + 8_000, "{most} samples");
    }
}
