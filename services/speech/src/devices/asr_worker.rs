//! Speech recognition on a thread of its own: from audio to segments of speech with hypotheses.
//!
//! Invariant: every accepted input yields exactly one result, in order. The thread accepts input at
//! once; the recogniser follows when it has loaded. Interim results and early decoding delay no
//! result.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};

use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use scene::Scene;

use crate::devices::recogniser::{Backend, Gate, Recogniser};
use crate::devices::stream::SpeechSegment;
use crate::devices::vad::SegmenterOptions;
use crate::devices::worker_thread::{QueueError, WorkerThread};
use crate::{Recognised, RecognitionInput};
use worker::{EarlyResults, Worker};

mod interim;
mod worker;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct AsrOptions {
    pub recogniser: Backend,
    /// Segmentation of recordings.
    pub segmenter: SegmenterOptions,
    /// Threshold of the [`Gate`], 0 to 1.
    pub gate_threshold: f32,
    /// Longest recording, seconds.
    pub longest_s: f64,
}

impl AsrOptions {
    /// Returns the options of the configuration, with work files in `work`.
    pub(crate) fn of(speech: &config::Speech, work: &Path) -> Self {
        Self {
            recogniser: Backend::of(speech, work),
            segmenter: SegmenterOptions::of(speech),
            gate_threshold: speech.accept_score_min as f32,
            longest_s: speech.recording_max.as_secs_f64(),
        }
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum AsrState {
    /// Loading; input waits for it.
    Loading,
    Ready {
        /// Words of the scene that cannot be recognised because their pronunciation is unknown.
        unpronounceable: Vec<String>,
    },
    /// Unavailable; every input fails with this reason.
    Off { reason: String },
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum AsrEvent {
    /// A change of state; [`AsrState::Loading`] first.
    State(AsrState),
    /// Words of an utterance in progress. One may follow the result.
    InterimResult { sound: u64, text: String },
    /// The result of an input.
    Recognised(Recognised),
}

/// Inputs that may wait.
pub(crate) const WAITING_MAX: usize = 8;
/// Possible ends of utterances that may wait for early decoding.
const HINTS_MAX: usize = 4;

/// The worker's thread. Dropping it ends the thread after the segment that is being decoded.
pub(crate) struct AsrWorker {
    hints: Sender<(u64, SpeechSegment)>,
    blocks: Sender<(u64, Vec<i16>)>,
    closed: Arc<AtomicBool>,
    /// Declared last: it ends once the channels above are closed.
    thread: WorkerThread<(u64, RecognitionInput)>,
}

impl AsrWorker {
    /// Starts the thread, which opens the recogniser for the scene.
    pub(crate) fn start(scene: &Scene, options: AsrOptions) -> (Self, Receiver<AsrEvent>) {
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
    ) -> (Self, Receiver<AsrEvent>) {
        let (hints, hinted) = bounded(HINTS_MAX);
        let (blocks, spoken) = bounded(interim::BLOCKS_MAX);
        let (events, happened) = unbounded();
        let closed = Arc::new(AtomicBool::new(false));
        let worker_closed = Arc::clone(&closed);
        let thread = WorkerThread::start(WAITING_MAX, move |inputs| {
            // Without a receiver of its events the worker has no more to do.
            let _ = events.send(AsrEvent::State(AsrState::Loading));
            let (recogniser, state) = match open() {
                Ok((recogniser, unpronounceable)) => {
                    (Ok(recogniser), AsrState::Ready { unpronounceable })
                }
                Err(reason) => (Err(reason.clone()), AsrState::Off { reason }),
            };
            let _ = events.send(AsrEvent::State(state));
            let opener = recogniser.as_ref().ok().and_then(|it| it.interim_decoder());
            let results = events.clone();
            let interim =
                opener.map(|open| thread::spawn(move || interim::run(open, &spoken, &results)));
            let (closed, early) = (worker_closed, EarlyResults::default());
            let worker = Worker { recogniser, gate, segmenter, longest_s, closed, early };
            worker.run(inputs, &hinted, &events);
            // A panic of the thread has been logged.
            let _ = interim.map(JoinHandle::join);
        });
        (Self { hints, blocks, closed, thread }, happened)
    }

    /// Offers a possible end of utterance `sound`. A quick recogniser decodes it while it is idle, and
    /// [`Self::submit`] of the same samples then needs no decoding.
    pub(crate) fn decode_early(&self, sound: u64, segment: SpeechSegment) {
        // Without room it is decoded when the end is certain.
        let _ = self.hints.try_send((sound, segment));
    }

    /// Offers the next samples of utterance `sound` for interim results.
    pub(crate) fn interim_samples(&self, sound: u64, samples: Vec<i16>) {
        // Without room they are missing from the interim results, not from the result.
        let _ = self.blocks.try_send((sound, samples));
    }

    /// Queues input. `sound` identifies it in the events.
    pub(crate) fn submit(&self, sound: u64, input: RecognitionInput) -> Result<(), QueueError> {
        self.thread.offer((sound, input))
    }
}

impl Drop for AsrWorker {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::SeqCst);
    }
}

/// A recogniser and the words that it cannot recognise, or why it is unavailable.
type Opened = Result<(Box<dyn Recogniser>, Vec<String>), String>;

#[cfg(test)]
mod tests;
