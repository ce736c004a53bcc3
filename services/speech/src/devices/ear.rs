//! The ear: from sound to segments of speech, each with what was understood, on a thread of its
//! own.
//!
//! Invariant: every sound that is taken yields exactly one `Heard` or `Failed`, in order; the
//! thread is there at once, the recogniser follows when it has loaded.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use scene::Scene;

use crate::devices::audio::{read_wav, seconds};
use crate::devices::recogniser::{
    Backend, Gate, Outcome, PocketSphinxOptions, RecogniseError, Recogniser,
};
use crate::devices::stream::Cut;
use crate::devices::vad::{SegmentEvent, Segmenter, SegmenterOptions};

/// What the ear is made of.
#[derive(Clone, Debug, PartialEq)]
pub struct EarOptions {
    /// The recogniser.
    pub recogniser: Backend,
    /// How speech is cut out of the sound.
    pub segmenter: SegmenterOptions,
    /// How sure it must be that speech is about the scene, 0 to 1 (see [`Gate`]).
    pub gate_threshold: f32,
    /// Longest sound that is listened to at once, seconds.
    pub longest_s: f64,
}

impl EarOptions {
    /// The measured defaults, with work files in `work`.
    pub fn new(work: impl Into<PathBuf>) -> Self {
        Self {
            recogniser: Backend::PocketSphinx(PocketSphinxOptions::debian(work)),
            segmenter: SegmenterOptions::default(),
            gate_threshold: Gate::THRESHOLD,
            longest_s: 60.0,
        }
    }
}

/// Whether the ear understands speech yet, or ever will.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EarState {
    /// The recogniser is being made; sounds wait for it.
    Loading,
    /// Sounds are understood.
    Ready {
        /// Words of the scene that cannot be recognised because nothing tells how they sound.
        unpronounceable: Vec<String>,
    },
    /// There is no recogniser; every sound fails with this reason.
    Off {
        /// Why, in words for the operator.
        reason: String,
    },
}

/// What to listen to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Sound {
    /// A WAV file.
    File(PathBuf),
    /// Samples of one channel at 16 kHz.
    Samples(Vec<i16>),
    /// One utterance that was cut out of a stream already.
    Speech(Cut),
}

/// A stretch of speech and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Segment {
    /// Where the speech begins, seconds from the sound's start.
    pub onset_s: f64,
    /// Where it ends, seconds from the sound's start.
    pub end_s: f64,
    /// How far it stands above the noise around it, decibels, 0 to 60. Recognition is good from
    /// 20 on and bad below 15.
    pub snr_db: f32,
    /// What was understood.
    pub outcome: Outcome,
}

/// What the ear did.
#[derive(Clone, Debug, PartialEq)]
pub enum EarEvent {
    /// Its state, whenever it changes; [`EarState::Loading`] first of all.
    State(EarState),
    /// A sound was listened to. Without segments nobody spoke in it.
    Heard {
        /// The sound.
        id: u64,
        /// The speech in it, in order.
        segments: Vec<Segment>,
    },
    /// A sound could not be listened to.
    Failed {
        /// The sound.
        id: u64,
        /// Why, in words for the operator.
        error: String,
    },
}

/// Why a sound is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum HearError {
    /// More sounds wait than can be listened to in time.
    #[error("{SOUNDS_MAX} sounds wait to be listened to already")]
    Busy,
    /// The ear's thread has broken down.
    #[error("the ear has broken down")]
    Gone,
}

/// Sounds that may wait.
pub const SOUNDS_MAX: usize = 8;

/// The ear's thread. Dropping it ends the thread after the segment that is being decoded.
pub struct Ear {
    sounds: Option<Sender<(u64, Sound)>>,
    closed: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Ear {
    /// Starts the thread, which makes the recogniser for the scene.
    pub fn start(scene: &Scene, options: EarOptions) -> (Self, Receiver<EarEvent>) {
        let gate = Gate::new(scene, options.gate_threshold);
        let (scene, recogniser) = (scene.clone(), options.recogniser);
        let open = move || recogniser.open(&scene).map_err(|error| error.to_string());
        Self::with(open, gate, options.segmenter, options.longest_s)
    }

    fn with(
        open: impl FnOnce() -> Opened + Send + 'static,
        gate: Gate,
        segmenter: SegmenterOptions,
        longest_s: f64,
    ) -> (Self, Receiver<EarEvent>) {
        let (sounds, taken) = bounded(SOUNDS_MAX);
        let (events, happened) = unbounded();
        let closed = Arc::new(AtomicBool::new(false));
        let listener_closed = Arc::clone(&closed);
        let thread = thread::spawn(move || {
            // Without a taker for its events the ear has no more to do.
            let _ = events.send(EarEvent::State(EarState::Loading));
            let (recogniser, state) = match open() {
                Ok((recogniser, unpronounceable)) => {
                    (Ok(recogniser), EarState::Ready { unpronounceable })
                }
                Err(reason) => (Err(reason.clone()), EarState::Off { reason }),
            };
            let _ = events.send(EarEvent::State(state));
            let closed = listener_closed;
            Listener { recogniser, gate, segmenter, longest_s, closed }.run(&taken, &events);
        });
        (Self { sounds: Some(sounds), closed, thread: Some(thread) }, happened)
    }

    /// Listens to a sound after those that wait. `id` names it in the events.
    ///
    /// # Errors
    /// If [`SOUNDS_MAX`] sounds wait already, or the thread is gone.
    pub fn hear(&self, id: u64, sound: Sound) -> Result<(), HearError> {
        let sounds = self.sounds.as_ref().ok_or(HearError::Gone)?;
        sounds.try_send((id, sound)).map_err(|error| match error {
            TrySendError::Full(_) => HearError::Busy,
            TrySendError::Disconnected(_) => HearError::Gone,
        })
    }
}

impl Drop for Ear {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::SeqCst);
        self.sounds = None;
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so already.
            let _ = thread.join();
        }
    }
}

/// A recogniser and the words that it cannot know, or why there is none.
type Opened = Result<(Box<dyn Recogniser>, Vec<String>), String>;

/// The thread's side.
struct Listener {
    recogniser: Result<Box<dyn Recogniser>, String>,
    gate: Gate,
    segmenter: SegmenterOptions,
    longest_s: f64,
    closed: Arc<AtomicBool>,
}

impl Listener {
    fn run(mut self, sounds: &Receiver<(u64, Sound)>, events: &Sender<EarEvent>) {
        for (id, sound) in sounds {
            if self.closed.load(Ordering::SeqCst) {
                return;
            }
            let event = match self.listen(sound) {
                Ok(segments) => EarEvent::Heard { id, segments },
                Err(error) => EarEvent::Failed { id, error },
            };
            if events.send(event).is_err() {
                return;
            }
        }
    }

    fn listen(&mut self, sound: Sound) -> Result<Vec<Segment>, String> {
        let recogniser = match &mut self.recogniser {
            Ok(recogniser) => recogniser.as_mut(),
            Err(reason) => return Err(format!("speech recognition is off: {reason}")),
        };
        let samples = match sound {
            Sound::File(path) => read_wav(&path, self.longest_s).map_err(|e| e.to_string())?,
            Sound::Samples(samples) => samples,
            Sound::Speech(Cut { samples, speech, .. }) => {
                let whole = 0..samples.len();
                let segment = segment(recogniser, &self.gate, &samples, whole, &speech);
                return Ok(vec![segment.map_err(|e| e.to_string())?]);
            }
        };
        let mut segmenter = Segmenter::new(self.segmenter.clone());
        let mut events = segmenter.push(&samples);
        events.extend(segmenter.finish());
        let mut segments = Vec::new();
        for event in events {
            let SegmentEvent::End { range, speech } = event else { continue };
            if self.closed.load(Ordering::SeqCst) {
                break;
            }
            let segment = segment(recogniser, &self.gate, &samples, range, &speech);
            segments.push(segment.map_err(|e| e.to_string())?);
        }
        Ok(segments)
    }
}

fn segment(
    recogniser: &mut dyn Recogniser,
    gate: &Gate,
    samples: &[i16],
    range: Range<usize>,
    speech: &Range<usize>,
) -> Result<Segment, RecogniseError> {
    let snr_db = snr_db(samples, &range, speech);
    let voice = speech.start - range.start..speech.end - range.start;
    let hypotheses = recogniser.recognise(&samples[range], voice)?;
    let (onset_s, end_s) = (seconds(speech.start), seconds(speech.end));
    Ok(Segment { onset_s, end_s, snr_db, outcome: gate.judge(hypotheses) })
}

/// Power of the speech over that of what lies around it in the segment. The detector's edges are
/// some 50 ms wide; what is as near to the speech counts as neither.
fn snr_db(samples: &[i16], range: &Range<usize>, speech: &Range<usize>) -> f32 {
    const EDGE: usize = 1_600;
    const MOST_DB: f64 = 60.0;
    let power = |parts: [&[i16]; 2]| {
        let len = parts.iter().map(|part| part.len()).sum::<usize>().max(1) as f64;
        let squares = parts.into_iter().flatten().map(|&s| f64::from(s) * f64::from(s));
        squares.sum::<f64>() / len
    };
    let before = range.start..speech.start.saturating_sub(EDGE).max(range.start);
    let behind = (speech.end + EDGE).min(range.end)..range.end;
    // Half a step of the samples' scale: digital silence.
    let noise = power([&samples[before], &samples[behind]]).max(0.25);
    let signal = (power([&samples[speech.clone()], &[]]) - noise).max(noise);
    (10.0 * (signal / noise).log10()).min(MOST_DB) as f32
}

#[cfg(test)]
mod tests;
