//! Where in a stream of sound somebody speaks.
//!
//! Invariant: segments do not overlap and come in order; every frame of speech that opened a
//! segment lies in exactly one. The state advances by samples alone, never by a clock.

use std::ops::Range;

use earshot::Detector;

use crate::devices::audio::RATE_HZ;

/// Samples per decision of the detector: 16 ms.
const FRAME: usize = 256;

/// What makes a segment.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmenterOptions {
    /// Score above which a frame is speech, 0 to 1. 0.5 finds onsets within 44 ms (median) and
    /// takes no noise for speech at 25 dB; higher values lose the ends of words.
    pub threshold: f32,
    /// Frames of speech in a row that open a segment; fewer let clicks in.
    pub opening_frames: usize,
    /// Pause that closes a segment, seconds. People pause longer than synthesis: 0.3 to 1.0.
    pub closing_pause_s: f64,
    /// Sound before the onset that belongs to the segment, seconds: soft first consonants lie
    /// before the detector's onset.
    pub pre_roll_s: f64,
    /// Sound behind the speech that belongs to the segment, seconds. What the pause holds beyond it is
    /// not decoded, so that decoding can begin before the pause is over.
    pub post_roll_s: f64,
    /// Longest speech in a segment, seconds; what follows becomes the next segment.
    pub longest_s: f64,
}

impl Default for SegmenterOptions {
    fn default() -> Self {
        Self {
            threshold: 0.5,
            opening_frames: 3,
            closing_pause_s: 0.5,
            pre_roll_s: 0.5,
            post_roll_s: 0.2,
            longest_s: 15.0,
        }
    }
}

/// What the segmenter found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SegmentEvent {
    /// Somebody began to speak.
    Onset {
        /// First sample of the speech, counted from the stream's start.
        at_sample: usize,
    },
    /// Nobody has spoken for as long as the segment reaches behind the speech. If nobody goes on,
    /// its end will tell the same range and speech.
    Pause {
        /// The samples to decode.
        range: Range<usize>,
        /// The speech itself.
        speech: Range<usize>,
    },
    /// The speech is over.
    End {
        /// The samples to decode: the speech with the sound before and behind it.
        range: Range<usize>,
        /// The speech itself.
        speech: Range<usize>,
    },
}

/// Finds segments of speech in a stream at [`RATE_HZ`], given in pieces of any length.
pub struct Segmenter {
    options: SegmenterOptions,
    detector: Box<Detector>,
    /// Samples of a frame that is not full yet.
    rest: Vec<i16>,
    track: Track,
}

impl Segmenter {
    /// A segmenter at the start of a stream.
    pub fn new(options: SegmenterOptions) -> Self {
        let detector = Box::new(Detector::default());
        Self { options, detector, rest: Vec::with_capacity(FRAME), track: Track::default() }
    }

    /// Takes the next samples and tells what they decided.
    pub fn push(&mut self, samples: &[i16]) -> Vec<SegmentEvent> {
        let mut events = Vec::new();
        self.rest.extend_from_slice(samples);
        let rest = std::mem::take(&mut self.rest);
        let mut frames = rest.chunks_exact(FRAME);
        for frame in &mut frames {
            let speech = self.detector.predict_i16(frame) > self.options.threshold;
            self.track.frame(speech, &self.options, &mut events);
        }
        self.rest = frames.remainder().to_vec();
        events
    }

    /// Ends the stream: a segment that is still open ends with it, and the segmenter is as new.
    pub fn finish(&mut self) -> Vec<SegmentEvent> {
        let mut events = Vec::new();
        let track = std::mem::take(&mut self.track);
        if let Some(open) = track.open {
            let end = track.at + self.rest.len();
            // Speech that goes on in the last frame may go on in the samples behind it.
            let speech_end = if open.speech_end == track.at { end } else { open.speech_end };
            let (range, speech) = open.cut(speech_end, end, &self.options);
            events.push(SegmentEvent::End { range, speech });
        }
        self.rest.clear();
        self.detector.reset();
        events
    }
}

/// The decisions, apart from the detector.
#[derive(Debug, Default)]
struct Track {
    /// Samples seen.
    at: usize,
    /// Frames of speech in a row while no segment is open.
    streak: usize,
    /// Where the last segment ended; the next begins no earlier.
    free_from: usize,
    open: Option<Open>,
}

#[derive(Debug)]
struct Open {
    /// First sample to decode.
    start: usize,
    /// First sample of speech.
    onset: usize,
    /// End of the last frame of speech.
    speech_end: usize,
}

impl Open {
    /// What to decode at sample `at`, and the speech in it.
    fn cut(
        &self,
        speech_end: usize,
        at: usize,
        options: &SegmenterOptions,
    ) -> (Range<usize>, Range<usize>) {
        (self.start..at.min(speech_end + post_roll(options)), self.onset..speech_end)
    }
}

impl Track {
    fn frame(&mut self, speech: bool, options: &SegmenterOptions, events: &mut Vec<SegmentEvent>) {
        self.at += FRAME;
        self.streak = if speech { self.streak + 1 } else { 0 };
        match &mut self.open {
            None if self.streak >= options.opening_frames.max(1) => {
                let onset = self.at - self.streak * FRAME;
                let start = onset.saturating_sub(samples(options.pre_roll_s)).max(self.free_from);
                self.open = Some(Open { start, onset, speech_end: self.at });
                events.push(SegmentEvent::Onset { at_sample: onset });
            }
            None => {}
            Some(open) => {
                if speech {
                    open.speech_end = self.at;
                }
                let paused = self.at - open.speech_end >= samples(options.closing_pause_s);
                let full = self.at - open.onset >= samples(options.longest_s);
                let (range, speech) = open.cut(open.speech_end, self.at, options);
                if paused || full {
                    self.free_from = range.end;
                    self.streak = 0;
                    self.open = None;
                    events.push(SegmentEvent::End { range, speech });
                } else if self.at - open.speech_end == post_roll(options) {
                    events.push(SegmentEvent::Pause { range, speech });
                }
            }
        }
    }
}

fn samples(seconds: f64) -> usize {
    (seconds * f64::from(RATE_HZ)) as usize
}

/// How far a segment reaches behind its speech: whole frames, one at least.
fn post_roll(options: &SegmenterOptions) -> usize {
    samples(options.post_roll_s).div_ceil(FRAME).max(1) * FRAME
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::voice;

    /// Runs the decisions over frames written as `#` (speech) and `.` (none).
    fn track(frames: &str, options: &SegmenterOptions) -> Vec<SegmentEvent> {
        let (mut track, mut events) = (Track::default(), Vec::new());
        for frame in frames.chars() {
            track.frame(frame == '#', options, &mut events);
        }
        events
    }

    /// Three frames open, two frames close, one frame of pre-roll, eight frames at most.
    fn short() -> SegmenterOptions {
        let frame_s = FRAME as f64 / f64::from(RATE_HZ);
        SegmenterOptions {
            closing_pause_s: 2.0 * frame_s,
            pre_roll_s: frame_s,
            post_roll_s: 2.0 * frame_s,
            longest_s: 8.0 * frame_s,
            ..SegmenterOptions::default()
        }
    }

    fn onset(frame: usize) -> SegmentEvent {
        SegmentEvent::Onset { at_sample: frame * FRAME }
    }

    fn end(range: Range<usize>, speech: Range<usize>) -> SegmentEvent {
        let samples = |r: Range<usize>| r.start * FRAME..r.end * FRAME;
        SegmentEvent::End { range: samples(range), speech: samples(speech) }
    }

    #[test]
    fn three_frames_open_and_a_pause_closes() {
        let events = track("..####.#..", &short());
        assert_eq!(events, [onset(2), end(1..10, 2..8)]);
    }

    #[test]
    fn a_pause_is_told_with_what_its_end_will_tell_unless_somebody_goes_on() {
        let frame_s = FRAME as f64 / f64::from(RATE_HZ);
        let closing_pause_s = 4.0 * frame_s;
        let options = SegmenterOptions {
            closing_pause_s,
            post_roll_s: 2.0 * frame_s,
            longest_s: 1.0,
            ..short()
        };
        let events = track(".####.##..#....###....", &options);
        let pause = |range, speech| match end(range, speech) {
            SegmentEvent::End { range, speech } => SegmentEvent::Pause { range, speech },
            event => event,
        };
        let expected = [
            onset(1),
            pause(0..10, 1..8),
            pause(0..13, 1..11),
            end(0..13, 1..11),
            onset(15),
            pause(14..20, 15..18),
            end(14..20, 15..18),
        ];
        assert_eq!(events, expected);
    }

    #[test]
    fn clicks_open_nothing() {
        assert_eq!(track(".##.#.##..", &short()), []);
    }

    #[test]
    fn the_pre_roll_does_not_reach_into_the_segment_before() {
        let events = track("###..###..", &short());
        assert_eq!(events, [onset(0), end(0..5, 0..3), onset(5), end(5..10, 5..8)]);
    }

    #[test]
    fn endless_speech_is_cut() {
        let events = track("############..", &short());
        assert_eq!(events, [onset(0), end(0..8, 0..8), onset(8), end(8..14, 8..12)]);
    }

    fn speech(events: &[SegmentEvent]) -> Vec<Range<usize>> {
        (events.iter())
            .filter_map(|e| match e {
                SegmentEvent::End { speech, .. } => Some(speech.clone()),
                SegmentEvent::Onset { .. } | SegmentEvent::Pause { .. } => None,
            })
            .collect()
    }

    fn stream() -> Vec<i16> {
        let mut sound = vec![0; samples(1.0)];
        sound.extend(voice(1.0));
        sound.extend(vec![0; samples(1.0)]);
        sound.extend(voice(0.6));
        sound
    }

    #[test]
    fn a_voice_is_found_where_it_is_even_if_the_stream_ends_with_it() {
        let mut segmenter = Segmenter::new(SegmenterOptions::default());
        let mut events = segmenter.push(&stream());
        events.extend(segmenter.finish());
        let found = speech(&events);
        assert_eq!(found.len(), 2, "{events:?}");
        for (found, expected) in found.iter().zip([1.0..2.0, 3.0..3.6]) {
            let near = |sample: usize, s: f64| (sample as f64 / f64::from(RATE_HZ) - s).abs() < 0.2;
            assert!(
                near(found.start, expected.start) && near(found.end, expected.end),
                "{events:?}"
            );
        }
        assert!(found[1].end <= stream().len());
    }

    #[test]
    fn pieces_of_any_length_decide_alike() {
        let stream = stream();
        let mut whole = Segmenter::new(SegmenterOptions::default());
        let mut expected = whole.push(&stream);
        expected.extend(whole.finish());
        for len in [1, 100, 256, 999] {
            let mut segmenter = Segmenter::new(SegmenterOptions::default());
            let mut events: Vec<_> = stream.chunks(len).flat_map(|c| segmenter.push(c)).collect();
            events.extend(segmenter.finish());
            assert_eq!(events, expected, "pieces of {len}");
        }
    }

    #[test]
    fn silence_and_noise_are_no_speech() {
        let mut segmenter = Segmenter::new(SegmenterOptions::default());
        assert_eq!(segmenter.push(&vec![0; samples(2.0)]), []);
        let mut state = 1_u32;
        let noise: Vec<i16> = (0..samples(3.0))
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as i16 - 128
            })
            .collect();
        assert_eq!(segmenter.push(&noise), []);
        assert_eq!(segmenter.finish(), []);
    }

    #[test]
    fn a_finished_segmenter_is_as_new() {
        let mut segmenter = Segmenter::new(SegmenterOptions::default());
        let run = |segmenter: &mut Segmenter| {
            let mut events = segmenter.push(&stream());
            events.extend(segmenter.finish());
            events
        };
        assert_eq!(run(&mut segmenter), run(&mut segmenter));
    }
}
