//! Speech recognition on a thread of its own: from audio to segments of speech with hypotheses.
//!
//! Invariant: every accepted input yields exactly one result; those of live utterances come in
//! order, and so do those of files. Utterances do not wait for a file. The thread accepts input at
//! once; the recogniser follows when it has loaded. Interim results and early decoding delay no
//! result, and a second opinion none longer than the open pause.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use config::Settings;
use crossbeam_channel::{Receiver, Sender, bounded, unbounded};
use messages::EarState;
use speech_engines::recogniser::{Recogniser, RecogniserUnavailable, SecondOpinion, interim};
use speech_engines::stream::SpeechSegment;
use speech_engines::vad::SegmenterOptions;
use speech_engines::worker_thread::{QueueError, WorkerThread, in_background};

use crate::hearing::{Ensemble, Gate};
use crate::{Device, In, RecognitionInput, options};
use early::EarlyResults;
use worker::{Channels, Worker};

mod doubt;
mod early;
mod worker;

/// Live utterances that may wait, and files.
pub(crate) const WAITING_MAX: usize = 8;
/// Interval at which a recogniser is opened again that had no room on the disk.
const AGAIN_EVERY: Duration = Duration::from_millis(500);
/// Possible ends of utterances that may wait for early decoding.
const HINTS_MAX: usize = 4;

/// Limits of utterances and the work on them.
#[derive(Clone, Debug)]
struct Limits {
    segmenter: SegmenterOptions,
    /// Longest file, seconds.
    longest_s: f64,
    /// How long after the voice a second opinion is waited for.
    patience: Duration,
}

impl Limits {
    /// Returns the limits of the configuration. A doubtful result waits as long as an open pause.
    fn of(speech: &config::Speech) -> Self {
        Self {
            segmenter: options::segmenter(speech),
            longest_s: speech.recording_max.as_secs_f64(),
            patience: speech.open_pause.max(speech.closing_pause),
        }
    }
}

/// The worker's thread. Dropping it ends the thread after the segment that is being decoded.
pub(crate) struct AsrWorker {
    hints: Sender<(u64, SpeechSegment)>,
    blocks: Sender<(u64, Vec<i16>)>,
    files: Sender<(u64, PathBuf)>,
    closed: Arc<AtomicBool>,
    /// Declared last: it ends once the channels above are closed.
    thread: WorkerThread<(u64, SpeechSegment)>,
}

impl AsrWorker {
    /// Starts the thread, which opens the recogniser of the configuration with work files in
    /// `work`. Its events are the state of the recogniser, interim results and results.
    pub(crate) fn start(settings: &Settings, work: &Path) -> (Self, Receiver<In<'static>>) {
        let (scene, speech) = (settings.scene.clone(), &settings.speech);
        let score_min = speech.accept_score_min as f32;
        let backend = options::backend(speech, work);
        let model = speech.whisper_model.clone();
        let mut limits = Limits::of(speech);
        limits.patience += backend.server_limit();
        let open = move |closed: &AtomicBool, events: &Sender<In<'static>>| {
            let gate = in_background(|| Gate::new(&scene, score_min));
            let (first, unpronounceable) = with_room(closed, || backend.open(&scene))?;
            let events = events.clone();
            let report = move |note| drop(events.send(In::Server { of: Device::Recogniser, note }));
            let server = backend.server(&scene, &*first, Box::new(report));
            let second = server.or_else(|| model.map(|model| SecondOpinion::start(model, scene)));
            Ok(Opened { first, second, unpronounceable, gate })
        };
        Self::with(open, limits)
    }

    fn with(
        open: impl FnOnce(&AtomicBool, &Sender<In<'static>>) -> Result<Opened, String> + Send + 'static,
        limits: Limits,
    ) -> (Self, Receiver<In<'static>>) {
        let (hints, hinted) = bounded(HINTS_MAX);
        let (blocks, spoken) = bounded(interim::BLOCKS_MAX);
        let (files, recorded) = bounded(WAITING_MAX);
        let (events, happened) = unbounded();
        let closed = Arc::new(AtomicBool::new(false));
        let worker_closed = Arc::clone(&closed);
        let thread = WorkerThread::start(WAITING_MAX, move |inputs| {
            // Without a receiver of its events the worker has no more to do.
            let publish = |state| drop(events.send(In::RecogniserState(state)));
            publish(EarState::Loading);
            let recognisers =
                open(&worker_closed, &events).map(Opened::ready).inspect_err(|reason| {
                    tracing::warn!(reason, "speech cannot be recognised; typed text works");
                });
            publish(if recognisers.is_ok() { EarState::Ready } else { EarState::Off });
            let opener = recognisers.as_ref().ok().and_then(Ensemble::interim_decoder);
            let results = events.clone();
            let publish =
                move |sound, text| results.send(In::InterimResult { sound, text }).is_ok();
            let interim =
                opener.map(|open| thread::spawn(move || interim::run(open, &spoken, publish)));
            let (closed, early) = (worker_closed, EarlyResults::default());
            let worker = Worker { recognisers, limits, closed, events, early, doubt: None };
            worker.run(&Channels { live: inputs, hints: &hinted, files: &recorded });
            // A panic of the thread has been logged.
            let _ = interim.map(JoinHandle::join);
        });
        (Self { hints, blocks, files, closed, thread }, happened)
    }

    /// Offers a possible end of utterance `sound`. A quick recogniser decodes it while it is idle,
    /// and [`Self::submit`] of the same samples then needs no decoding.
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
        match input {
            RecognitionInput::Speech(segment) => self.thread.offer((sound, segment)),
            RecognitionInput::File(path) => Ok(self.files.try_send((sound, path.into()))?),
        }
    }
}

impl Drop for AsrWorker {
    fn drop(&mut self) {
        self.closed.store(true, Ordering::SeqCst);
    }
}

/// Opens a recogniser, again until the disk has room for its files. Utterances wait meanwhile.
fn with_room<T>(
    closed: &AtomicBool,
    mut open: impl FnMut() -> Result<T, RecogniserUnavailable>,
) -> Result<T, String> {
    let mut has_warned = false;
    loop {
        match open() {
            Err(RecogniserUnavailable::Short(reason)) if !closed.load(Ordering::SeqCst) => {
                if !std::mem::replace(&mut has_warned, true) {
                    tracing::warn!(reason, "speech recognition waits for room on the disk");
                }
                thread::sleep(AGAIN_EVERY);
            }
            opened => return opened.map_err(|error| error.to_string()),
        }
    }
}

/// The recognisers, and the words that the first one cannot recognise.
struct Opened {
    first: Box<dyn Recogniser>,
    second: Option<SecondOpinion>,
    unpronounceable: Vec<String>,
    gate: Gate,
}

impl Opened {
    /// Returns the recognisers after a warning about missing ones.
    fn ready(self) -> Ensemble {
        let Self { first, second, unpronounceable, gate } = self;
        if !unpronounceable.is_empty() {
            tracing::warn!(?unpronounceable, "words of the scene that cannot be recognised");
        }
        Ensemble::new(first, second, gate)
    }
}

#[cfg(test)]
mod tests;
