//! The ear: from sound to segments of speech, each with what was understood, on a thread of its
//! own.
//!
//! Invariant: every sound that is taken yields exactly one `Heard` or `Failed`, in order; the
//! thread is there at once, the recogniser follows when it has loaded. What is said of an utterance
//! while it lasts, and what is decoded before its end is certain, delays none of them.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded, unbounded};
use scene::Scene;

use crate::devices::recogniser::{Backend, Gate, Outcome, PocketSphinxOptions, Recogniser};
use crate::devices::stream::Cut;
use crate::devices::vad::SegmenterOptions;
use listener::{Early, Listener};

mod listener;
mod preview;

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
    /// The words of an utterance that is being spoken, as far as it has come. There may be one after
    /// the result.
    SoFar {
        /// The sound.
        id: u64,
        /// The words.
        text: String,
    },
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
/// Pauses that may wait to be taken for ends.
const HINTS_MAX: usize = 4;

/// The ear's thread. Dropping it ends the thread after the segment that is being decoded.
pub struct Ear {
    sounds: Option<Sender<(u64, Sound)>>,
    hints: Option<Sender<(u64, Cut)>>,
    pieces: Option<Sender<(u64, Vec<i16>)>>,
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
        let (hints, hinted) = bounded(HINTS_MAX);
        let (pieces, overheard) = bounded(preview::PIECES_MAX);
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
            let preview = recogniser.as_ref().ok().and_then(|recogniser| recogniser.preview());
            let told = events.clone();
            let preview =
                preview.map(|open| thread::spawn(move || preview::run(open, &overheard, &told)));
            let (closed, early) = (listener_closed, Early::default());
            let listener = Listener { recogniser, gate, segmenter, longest_s, closed, early };
            listener.run(&taken, &hinted, &events);
            // A thread that panicked has told so already.
            let _ = preview.map(JoinHandle::join);
        });
        let (sounds, hints, pieces) = (Some(sounds), Some(hints), Some(pieces));
        (Self { sounds, hints, pieces, closed, thread: Some(thread) }, happened)
    }

    /// Who speaks has paused: perhaps this is all of sound `id`. A recogniser that is quick decodes it
    /// now where it has nothing else to do, and answers without decoding where [`Self::hear`] hands
    /// over the same samples.
    pub fn expect(&self, id: u64, cut: Cut) {
        // One for which there is no room is decoded when it is certain.
        let _ = self.hints.as_ref().map(|hints| hints.try_send((id, cut)));
    }

    /// Who speaks has come so far with sound `id`: its next samples.
    pub fn overhear(&self, id: u64, samples: Vec<i16>) {
        // What there is no room for is missing from what is told meanwhile, and not from the result.
        let _ = self.pieces.as_ref().map(|pieces| pieces.try_send((id, samples)));
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
        (self.sounds, self.hints, self.pieces) = (None, None, None);
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has told so already.
            let _ = thread.join();
        }
    }
}

/// A recogniser and the words that it cannot know, or why there is none.
type Opened = Result<(Box<dyn Recogniser>, Vec<String>), String>;

#[cfg(test)]
mod tests;
