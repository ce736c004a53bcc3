//! Voice activity detection: segments of speech in a stream.
//!
//! Invariant: segments are ordered and do not overlap; every frame of speech that opened a segment
//! lies in exactly one. The state advances by samples alone, never by a clock.

mod babble;
mod loudness;

use std::ops::Range;

use earshot::Detector;

use crate::audio::RATE_HZ;
use babble::Babble;
use loudness::Loudness;
pub(crate) use loudness::level_db;

/// Samples per decision of the detector: 16 ms.
const FRAME: usize = 256;
/// Frames after a segment that was released in which the detector may still find its speech.
const TAIL: usize = 12;

/// Settings of segmentation.
#[derive(Clone, Debug, PartialEq)]
pub struct SegmenterOptions {
    /// Score above which a frame may be speech, 0 to 1. 0.5 finds onsets within 44 ms (median) and
    /// yields no false alarms at 25 dB; higher values lose the ends of words.
    pub threshold: f32,
    /// Consecutive frames of speech that open a segment; fewer admit clicks.
    pub opening_frames: usize,
    /// Pause that closes a segment of which nothing else is known, seconds; for human speech 0.3 to
    /// 1.0. See [`Segmenter::set_closing`].
    pub closing_pause_s: f64,
    /// Audio before the onset that belongs to the segment, seconds: soft first consonants precede
    /// the detected onset.
    pub pre_roll_s: f64,
    /// Audio after the speech that belongs to the segment, seconds. The rest of the pause is not
    /// decoded, so that decoding can begin before the pause ends.
    pub post_roll_s: f64,
    /// Post-roll of a segment that closes before it is over, seconds.
    pub early_roll_s: f64,
    /// Longest speech in a segment, seconds; the rest becomes the next segment.
    pub longest_s: f64,
}

impl Default for SegmenterOptions {
    fn default() -> Self {
        Self {
            threshold: 0.5,
            opening_frames: 3,
            closing_pause_s: 0.6,
            pre_roll_s: 0.5,
            post_roll_s: 0.2,
            early_roll_s: 0.032,
            longest_s: 15.0,
        }
    }
}

/// When a pause closes a segment whose words so far were judged.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
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
    /// A pause as long as the early roll or the post-roll. Unless speech continues, the end carries
    /// the range and speech of one of them.
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
    loudness: Loudness,
    babble: Babble,
    /// Samples of an incomplete frame.
    rest: Vec<i16>,
    track: Track,
}

impl Segmenter {
    /// Returns a segmenter at the start of a stream.
    pub fn new(options: SegmenterOptions) -> Self {
        Self {
            options,
            detector: Box::default(),
            loudness: Loudness::default(),
            babble: Babble::default(),
            rest: Vec::with_capacity(FRAME),
            track: Track::default(),
        }
    }

    /// Processes the next samples.
    pub fn push(&mut self, samples: &[i16]) -> Vec<VadEvent> {
        let mut events = Vec::new();
        self.rest.extend_from_slice(samples);
        let rest = std::mem::take(&mut self.rest);
        let mut frames = rest.chunks_exact(FRAME);
        for frame in &mut frames {
            let is_speech = self.detector.predict_i16(frame) > self.options.threshold;
            let level_db = level_db(frame);
            let is_loud = self.loudness.is_voice(level_db, self.track.open.is_some());
            let is_user = self.babble.is_user(level_db, is_speech);
            self.track.frame(is_speech && is_loud && is_user, &self.options, &mut events);
        }
        self.rest = frames.remainder().to_vec();
        events
    }

    /// Sets the pause that closes the open segment, unless speech has continued in the meantime.
    pub fn set_closing(&mut self, closing: Closing) {
        if let Some(open) = &mut self.track.open
            && open.speech_end - open.onset == closing.speech
        {
            open.closing = Some(closing);
        }
    }

    /// Ends the open segment with its voice: a user who releases the button has nothing to add.
    /// Without a voice it ends with the next frame.
    pub fn release(&mut self) {
        if let Some(open) = &mut self.track.open {
            open.is_released = true;
        }
    }

    /// Ends the stream and an open segment with it. The next one begins in the same room: its
    /// background stays known.
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
    /// Frames of speech that still belong to the last segment, which was released: the detector
    /// notices the end of a voice later than its level shows it.
    tail: usize,
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
    /// Judgement of the frames since `speech_end`.
    closing: Option<Closing>,
    /// Whether it ends with the voice; see [`Segmenter::release`].
    is_released: bool,
}

impl Open {
    /// Returns the range to decode at sample `at`, and the speech in it. The range is that of a
    /// reported pause: the last one, or the judged one if that closes it.
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
        if self.is_released {
            return roll(options.early_roll_s);
        }
        samples(self.closing.map_or(options.closing_pause_s, |closing| closing.pause_s))
    }
}

impl Track {
    fn frame(&mut self, speech: bool, options: &SegmenterOptions, events: &mut Vec<VadEvent>) {
        self.at += FRAME;
        self.tail = if speech { self.tail.saturating_sub(1) } else { 0 };
        self.streak = if speech && self.tail == 0 { self.streak + 1 } else { 0 };
        match &mut self.open {
            None if self.streak >= options.opening_frames.max(1) => {
                let onset = self.at - self.streak * FRAME;
                let start = onset.saturating_sub(samples(options.pre_roll_s)).max(self.free_from);
                let speech_end = self.at;
                let (closing, is_released) = (None, false);
                self.open = Some(Open { start, onset, speech_end, closing, is_released });
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
                    self.tail = if open.is_released { TAIL } else { 0 };
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
mod tests;
