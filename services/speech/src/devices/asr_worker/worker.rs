//! The worker's thread: decodes what is said in order, possible ends of it while it is idle, and files
//! beside that.
//!
//! Invariant: an early result is used only for the very samples that were decoded.

use std::collections::VecDeque;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crossbeam_channel::{Receiver, Select, Sender, TryRecvError};

use crate::devices::audio::{RATE_HZ, read_wav, seconds, snr_db};
use crate::devices::recogniser::{Gate, RecogniseError, Recogniser};
use crate::devices::stream::SpeechSegment;
use crate::devices::vad::{Segmenter, SegmenterOptions, VadEvent};
use crate::{In, Recognised, RecognisedSegment};

/// Samples of a file that are searched for speech at a time: one second.
const PIECE: usize = RATE_HZ as usize;
/// Early results that are kept: one for each speaker, and one that turned out to be too early.
const EARLY_MAX: usize = 4;

/// The thread's side.
pub(super) struct Worker {
    pub(super) recogniser: Result<Box<dyn Recogniser>, String>,
    pub(super) gate: Gate,
    pub(super) segmenter: SegmenterOptions,
    pub(super) longest_s: f64,
    pub(super) closed: Arc<AtomicBool>,
    pub(super) early: EarlyResults,
}

/// Results of segments that were decoded before their end was certain.
#[derive(Default)]
pub(super) struct EarlyResults {
    results: VecDeque<(SpeechSegment, RecognisedSegment)>,
    /// The inputs that were answered last: hints about them come too late.
    answered: VecDeque<u64>,
}

impl EarlyResults {
    fn take(&mut self, segment: &SpeechSegment) -> Option<RecognisedSegment> {
        let is_same = |(known, _): &(SpeechSegment, _)| {
            known.speech == segment.speech && known.samples == segment.samples
        };
        let at = self.results.iter().position(is_same)?;
        self.results.remove(at).map(|(_, result)| result)
    }
}

fn push<T>(queue: &mut VecDeque<T>, item: T) {
    if queue.len() >= EARLY_MAX {
        queue.pop_front();
    }
    queue.push_back(item);
}

/// The ends of the worker's channels.
pub(super) struct Channels<'a> {
    /// What is said.
    pub(super) live: &'a Receiver<(u64, SpeechSegment)>,
    /// Possible ends of what is being said.
    pub(super) hints: &'a Receiver<(u64, SpeechSegment)>,
    pub(super) files: &'a Receiver<(u64, PathBuf)>,
    pub(super) events: &'a Sender<In>,
}

impl Worker {
    pub(super) fn run(mut self, channels: &Channels<'_>) {
        while self.serve(channels) {
            let mut select = Select::new();
            let file = select.recv(channels.files);
            select.recv(channels.live);
            select.recv(channels.hints);
            if select.ready() == file
                && let Ok((sound, path)) = channels.files.try_recv()
            {
                let segments = self.recognise_file(&path, channels);
                self.answer(sound, segments, channels.events);
            }
        }
    }

    /// Decodes what is said, and its possible ends while nothing else waits. Returns whether more may
    /// come.
    fn serve(&mut self, channels: &Channels<'_>) -> bool {
        while !self.closed.load(Ordering::SeqCst) {
            match channels.live.try_recv() {
                Ok((sound, segment)) => {
                    let segments = self.recognise(&segment);
                    self.answer(sound, segments, channels.events);
                    continue;
                }
                Err(TryRecvError::Disconnected) => return false,
                Err(TryRecvError::Empty) => {}
            }
            // The newest hint is the most likely one.
            match channels.hints.try_iter().last() {
                Some((sound, segment)) => self.decode_early(sound, segment, channels.events),
                None => return true,
            }
        }
        false
    }

    fn answer(
        &mut self,
        sound: u64,
        segments: Result<Vec<RecognisedSegment>, String>,
        events: &Sender<In>,
    ) {
        for snr_db in segments.iter().flatten().map(|segment| segment.snr_db) {
            if snr_db < SNR_MIN_DB {
                tracing::warn!(snr_db, "loud background noise; help: speak closer, or type");
            }
        }
        push(&mut self.early.answered, sound);
        // Without a receiver of its events the worker ends when it is closed.
        let _ = events.send(In::Recognised(Recognised { sound, segments }));
    }

    fn decode_early(&mut self, sound: u64, segment: SpeechSegment, events: &Sender<In>) {
        let Ok(recogniser) = &mut self.recogniser else { return };
        if !recogniser.is_quick() || self.early.answered.contains(&sound) {
            return;
        }
        // A failure is retried when the end is certain, and reported then.
        let result = recognise_segment(recogniser.as_mut(), &self.gate, &segment).ok();
        let at = segment.closing(Duration::ZERO);
        if let Some(result) = &result {
            push(&mut self.early.results, (segment, result.clone()));
        }
        // Without a receiver of its events the worker ends with the next input.
        let _ = events.send(In::EarlyResult { sound, at, result });
    }

    fn recognise(&mut self, segment: &SpeechSegment) -> Result<Vec<RecognisedSegment>, String> {
        if let Some(result) = self.early.take(segment) {
            return Ok(vec![result]);
        }
        let result = recognise_segment(available(&mut self.recogniser)?, &self.gate, segment);
        result.map(|result| vec![result]).map_err(|error| error.to_string())
    }

    /// Decodes a file piece by piece. What is said meanwhile comes first: it may be a stop.
    fn recognise_file(
        &mut self,
        path: &Path,
        channels: &Channels<'_>,
    ) -> Result<Vec<RecognisedSegment>, String> {
        available(&mut self.recogniser)?;
        let samples = read_wav(path, self.longest_s).map_err(|error| error.to_string())?;
        let mut segmenter = Segmenter::new(self.segmenter.clone());
        let mut segments = Vec::new();
        for piece in samples.chunks(PIECE).map(Some).chain([None]) {
            if !self.serve(channels) {
                break;
            }
            let events = match piece {
                Some(piece) => segmenter.push(piece),
                None => segmenter.finish().into_iter().collect(),
            };
            for event in events {
                let VadEvent::End { range, speech } = event else { continue };
                let recogniser = available(&mut self.recogniser)?;
                let segment = recognise_range(recogniser, &self.gate, &samples, range, &speech);
                segments.push(segment.map_err(|error| error.to_string())?);
            }
        }
        Ok(segments)
    }
}

/// Returns the recogniser, or why there is none, for users.
fn available(
    recogniser: &mut Result<Box<dyn Recogniser>, String>,
) -> Result<&mut dyn Recogniser, String> {
    match recogniser {
        Ok(recogniser) => Ok(recogniser.as_mut()),
        Err(reason) => Err(format!("speech recognition is off: {reason}")),
    }
}

fn recognise_segment(
    recogniser: &mut dyn Recogniser,
    gate: &Gate,
    SpeechSegment { samples, speech, .. }: &SpeechSegment,
) -> Result<RecognisedSegment, RecogniseError> {
    recognise_range(recogniser, gate, samples, 0..samples.len(), speech)
}

/// Signal-to-noise ratio, decibels, below which hardly half of the speech is understood.
const SNR_MIN_DB: f32 = 15.0;
/// Smallest weight of a hypothesis that is handed on.
const WEIGHT_MIN: f64 = 1e-3;

fn recognise_range(
    recogniser: &mut dyn Recogniser,
    gate: &Gate,
    samples: &[i16],
    range: Range<usize>,
    speech: &Range<usize>,
) -> Result<RecognisedSegment, RecogniseError> {
    let snr_db = snr_db(samples, &range, speech);
    let voice = speech.start - range.start..speech.end - range.start;
    let hypotheses = gate.judge(recogniser.recognise(&samples[range], voice)?);
    let hypotheses = match hypotheses {
        Ok(mut hypotheses) => {
            hypotheses.iter_mut().for_each(|h| h.weight = h.weight.max(WEIGHT_MIN));
            Ok(hypotheses)
        }
        Err(rejected) => {
            let (text, score) = (rejected.text, rejected.score);
            tracing::info!(text, score, "speech rejected: not meant for the robot");
            Err(text)
        }
    };
    Ok(RecognisedSegment {
        span_s: (seconds(speech.start), seconds(speech.end)),
        snr_db,
        hypotheses,
    })
}
