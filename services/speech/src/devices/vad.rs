//! Voice activity detection: segments of speech in a stream.
//!
//! Invariant: segments are ordered and do not overlap; every frame of speech that opened a segment lies
//! in exactly one. The state advances by samples alone, never by a clock.

use std::ops::Range;

use earshot::Detector;

use crate::devices::audio::RATE_HZ;

/// Samples per decision of the detector: 16 ms.
const FRAME: usize = 256;

/// Settings of segmentation.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmenterOptions {
    /// Score above which a frame is speech, 0 to 1. 0.5 finds onsets within 44 ms (median) and yields
    /// no false alarms at 25 dB; higher values lose the ends of words.
    pub threshold: f32,
    /// Consecutive frames of speech that open a segment; fewer admit clicks.
    pub opening_frames: usize,
    /// Pause that closes a segment of which nothing else is known, seconds; for human speech 0.3 to
    /// 1.0. See [`Segmenter::set_closing`].
    pub closing_pause_s: f64,
    /// Audio before the onset that belongs to the segment, seconds: soft first consonants precede the
    /// detected onset.
    pub pre_roll_s: f64,
    /// Audio after the speech that belongs to the segment, seconds. The rest of the pause is not
    /// decoded, so that decoding can begin before the pause ends.
    pub post_roll_s: f64,
    /// The same for a segment that closes before the post-roll is over, seconds.
    pub early_roll_s: f64,
    /// Longest speech in a segment, seconds; the rest becomes the next segment.
    pub longest_s: f64,
}

impl SegmenterOptions {
    /// Returns the options of the configuration.
    pub fn of(speech: &config::Speech) -> Self {
        Self {
            closing_pause_s: speech.closing_pause.as_secs_f64(),
            longest_s: speech.spoken_max.as_secs_f64(),
            ..Self::default()
        }
    }
}

impl Default for SegmenterOptions {
    fn default() -> Self {
        Self {
            threshold: 0.5,
            opening_frames: 3,
            closing_pause_s: 0.5,
            pre_roll_s: 0.5,
            post_roll_s: 0.2,
            early_roll_s: 0.048,
            longest_s: 15.0,
        }
    }
}

/// When a pause closes a segment whose words so far were judged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closing {
    /// Length of the speech that was judged, samples.
    pub speech: usize,
    /// Audio after it that was decoded, samples.
    pub roll: usize,
    /// The pause, seconds.
    pub pause_s: f64,
}

/// An event of the segmenter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VadEvent {
    /// Speech began.
    Onset {
        /// First sample of the speech, counted from the stream's start.
        at_sample: usize,
    },
    /// A pause as long as the early roll or the post-roll. Unless speech continues, the end carries the
    /// range and speech of one of them.
    Pause {
        /// The samples to decode.
        range: Range<usize>,
        /// The speech itself.
        speech: Range<usize>,
    },
    /// Speech ended.
    End {
        /// The samples to decode: the speech with pre-roll and post-roll.
        range: Range<usize>,
        /// The speech itself.
        speech: Range<usize>,
    },
}

/// Finds segments of speech in a stream at [`RATE_HZ`], given in blocks of any length.
pub struct Segmenter {
    options: SegmenterOptions,
    detector: Box<Detector>,
    /// Samples of an incomplete frame.
    rest: Vec<i16>,
    track: Track,
}

impl Segmenter {
    /// Returns a segmenter at the start of a stream.
    pub fn new(options: SegmenterOptions) -> Self {
        let detector = Box::new(Detector::default());
        Self { options, detector, rest: Vec::with_capacity(FRAME), track: Track::default() }
    }

    /// Processes the next samples.
    pub fn push(&mut self, samples: &[i16]) -> Vec<VadEvent> {
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

    /// Sets the pause that closes the open segment, unless speech has continued since it was judged.
    pub fn set_closing(&mut self, closing: Closing) {
        if let Some(open) = &mut self.track.open
            && open.speech_end - open.onset == closing.speech
        {
            open.closing = Some(closing);
        }
    }

    /// Ends the stream and an open segment with it, and resets the segmenter.
    pub fn finish(&mut self) -> Option<VadEvent> {
        let track = std::mem::take(&mut self.track);
        let end = track.at + self.rest.len();
        self.rest.clear();
        self.detector.reset();
        let open = track.open?;
        // Speech in the last frame may continue in the incomplete one.
        let speech_end = if open.speech_end == track.at { end } else { open.speech_end };
        let (range, speech) = open.cut(speech_end, end, &self.options);
        Some(VadEvent::End { range, speech })
    }
}

/// The decisions without the detector.
#[derive(Debug, Default)]
struct Track {
    /// Samples processed.
    at: usize,
    /// Consecutive frames of speech while no segment is open.
    streak: usize,
    /// End of the last segment; the next one begins no earlier.
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
    /// What was judged since.
    closing: Option<Closing>,
}

impl Open {
    /// Returns the range to decode at sample `at`, and the speech in it. The range is that of a pause that
    /// was reported: of the last one, or of the one that was judged if it is closed by that.
    fn cut(
        &self,
        speech_end: usize,
        at: usize,
        options: &SegmenterOptions,
    ) -> (Range<usize>, Range<usize>) {
        let (early, late) = (roll(options.early_roll_s), roll(options.post_roll_s));
        let paused = at - speech_end;
        let is_closed = |closing: &&Closing| {
            closing.pause_s < options.closing_pause_s && paused >= samples(closing.pause_s)
        };
        let judged = self.closing.as_ref().filter(is_closed).map(|closing| closing.roll);
        let roll = judged.unwrap_or(if paused >= late {
            late
        } else if paused >= early {
            early
        } else {
            paused
        });
        (self.start..speech_end + roll.min(paused), self.onset..speech_end)
    }

    fn closing_pause(&self, options: &SegmenterOptions) -> usize {
        samples(self.closing.map_or(options.closing_pause_s, |closing| closing.pause_s))
    }
}

impl Track {
    fn frame(&mut self, speech: bool, options: &SegmenterOptions, events: &mut Vec<VadEvent>) {
        self.at += FRAME;
        self.streak = if speech { self.streak + 1 } else { 0 };
        match &mut self.open {
            None if self.streak >= options.opening_frames.max(1) => {
                let onset = self.at - self.streak * FRAME;
                let start = onset.saturating_sub(samples(options.pre_roll_s)).max(self.free_from);
                self.open = Some(Open { start, onset, speech_end: self.at, closing: None });
                events.push(VadEvent::Onset { at_sample: onset });
            }
            None => {}
            Some(open) => {
                if speech {
                    (open.speech_end, open.closing) = (self.at, None);
                }
                let pause = self.at - open.speech_end;
                let paused = pause > 0 && pause >= open.closing_pause(options);
                let full = self.at - open.onset >= samples(options.longest_s);
                let (range, speech) = open.cut(open.speech_end, self.at, options);
                if paused || full {
                    self.free_from = range.end;
                    self.streak = 0;
                    self.open = None;
                    events.push(VadEvent::End { range, speech });
                } else if [options.early_roll_s, options.post_roll_s].map(roll).contains(&pause) {
                    events.push(VadEvent::Pause { range, speech });
                }
            }
        }
    }
}

fn samples(seconds: f64) -> usize {
    (seconds * f64::from(RATE_HZ)) as usize
}

/// Returns the length of a segment after its speech: whole frames, at least one.
fn roll(seconds: f64) -> usize {
    samples(seconds).div_ceil(FRAME).max(1) * FRAME
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::random::{Rng, signed};

    /// Processes frames written as `#` (speech) and `.` (none).
    fn track(frames: &str, options: &SegmenterOptions) -> Vec<VadEvent> {
        let (mut track, mut events) = (Track::default(), Vec::new());
        for frame in frames.chars() {
            track.frame(frame == '#', options, &mut events);
        }
        events
    }

    /// Returns settings by which three frames open and two close, with one frame of pre-roll and eight frames
    /// at most.
    fn short() -> SegmenterOptions {
        let frame_s = FRAME as f64 / f64::from(RATE_HZ);
        SegmenterOptions {
            closing_pause_s: 2.0 * frame_s,
            pre_roll_s: frame_s,
            post_roll_s: 2.0 * frame_s,
            early_roll_s: 2.0 * frame_s,
            longest_s: 8.0 * frame_s,
            ..SegmenterOptions::default()
        }
    }

    fn onset(frame: usize) -> VadEvent {
        VadEvent::Onset { at_sample: frame * FRAME }
    }

    fn end(range: Range<usize>, speech: Range<usize>) -> VadEvent {
        let samples = |r: Range<usize>| r.start * FRAME..r.end * FRAME;
        VadEvent::End { range: samples(range), speech: samples(speech) }
    }

    fn pause(range: Range<usize>, speech: Range<usize>) -> VadEvent {
        match end(range, speech) {
            VadEvent::End { range, speech } => VadEvent::Pause { range, speech },
            event => event,
        }
    }

    #[test]
    fn vad_segments_follow_the_frames() {
        let frame_s = FRAME as f64 / f64::from(RATE_HZ);
        let pausing =
            SegmenterOptions { closing_pause_s: 4.0 * frame_s, longest_s: 1.0, ..short() };
        let long_pauses = vec![
            onset(1),
            pause(0..10, 1..8),
            pause(0..13, 1..11),
            end(0..13, 1..11),
            onset(15),
            pause(14..20, 15..18),
            end(14..20, 15..18),
        ];
        for (what, frames, options, expected) in [
            ("a pause closes", "..####.#..", short(), vec![onset(2), end(1..10, 2..8)]),
            ("a pause precedes its end", ".####.##..#....###....", pausing, long_pauses),
            ("clicks", ".##.#.##..", short(), vec![]),
            (
                "pre-roll does not overlap",
                "###..###..",
                short(),
                vec![onset(0), end(0..5, 0..3), onset(5), end(5..10, 5..8)],
            ),
            (
                "endless speech is split",
                "############..",
                short(),
                vec![onset(0), end(0..8, 0..8), onset(8), end(8..14, 8..12)],
            ),
        ] {
            assert_eq!(track(frames, &options), expected, "{what}");
        }
    }

    /// Processes frames; `judged` is known after frame `after`, of the pause at which it was decoded.
    fn judged(frames: &str, after: usize, pause_frames: usize, roll: usize) -> Vec<VadEvent> {
        let frame_s = FRAME as f64 / f64::from(RATE_HZ);
        let options = SegmenterOptions {
            early_roll_s: frame_s,
            post_roll_s: 3.0 * frame_s,
            closing_pause_s: 6.0 * frame_s,
            longest_s: 1.0,
            ..short()
        };
        let mut segmenter = Segmenter::new(options.clone());
        let mut events = Vec::new();
        for (n, frame) in frames.chars().enumerate() {
            segmenter.track.frame(frame == '#', &options, &mut events);
            if n + 1 == after {
                let pause_s = pause_frames as f64 * frame_s;
                segmenter.set_closing(Closing { speech: 4 * FRAME, roll: roll * FRAME, pause_s });
            }
        }
        events
    }

    #[test]
    fn vad_segments_close_by_what_was_judged() {
        let early = || vec![onset(0), pause(0..5, 0..4)];
        let late = || [early(), vec![pause(0..7, 0..4)]].concat();
        for (what, events, expected) in [
            (
                "complete: after two frames, with the range that was decoded",
                judged("####..........", 5, 2, 1),
                [early(), vec![end(0..5, 0..4)]].concat(),
            ),
            (
                "judged late: at once, with the range that was decoded",
                judged("####..........", 8, 2, 1),
                [late(), vec![end(0..5, 0..4)]].concat(),
            ),
            (
                "open: after nine frames",
                judged("####.........###", 6, 9, 1),
                [late(), vec![end(0..7, 0..4), onset(13)]].concat(),
            ),
            (
                "speech has continued: as if nothing was judged",
                judged("####.#.......###", 6, 1, 1),
                vec![
                    onset(0),
                    pause(0..5, 0..4),
                    pause(0..7, 0..6),
                    pause(0..9, 0..6),
                    end(0..9, 0..6),
                    onset(13),
                ],
            ),
            (
                "speech continues after it was judged",
                judged("####..#......###", 5, 4, 1),
                vec![
                    onset(0),
                    pause(0..5, 0..4),
                    pause(0..8, 0..7),
                    pause(0..10, 0..7),
                    end(0..10, 0..7),
                    onset(13),
                ],
            ),
        ] {
            assert_eq!(events, expected, "{what}");
        }
    }

    #[test]
    fn vad_ignores_silence_and_noise() {
        let mut segmenter = Segmenter::new(SegmenterOptions::default());
        assert_eq!(segmenter.push(&vec![0; samples(2.0)]), []);
        let mut rng = Rng::new(1);
        let noise: Vec<i16> =
            (0..samples(3.0)).map(|_| (signed(&mut rng) * 128.0) as i16).collect();
        assert_eq!(segmenter.push(&noise), []);
        assert_eq!(segmenter.finish(), None);
    }
}
