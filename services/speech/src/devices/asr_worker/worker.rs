//! The worker's thread: decodes inputs in order, and possible ends of utterances while it is idle.
//!
//! Invariant: an early result is used only for the very samples that were decoded.

use std::collections::VecDeque;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, TryRecvError, select};

use crate::devices::audio::{read_wav, seconds, snr_db};
use crate::devices::recogniser::{Gate, RecogniseError, Recogniser};
use crate::devices::stream::SpeechSegment;
use crate::devices::vad::{Segmenter, SegmenterOptions, VadEvent};
use crate::{In, Recognised, RecognisedSegment, RecognitionInput};

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

impl Worker {
    pub(super) fn run(
        mut self,
        inputs: &Receiver<(u64, RecognitionInput)>,
        hints: &Receiver<(u64, SpeechSegment)>,
        events: &Sender<In>,
    ) {
        loop {
            // Inputs have priority over hints.
            let (sound, input) = match inputs.try_recv() {
                Err(TryRecvError::Disconnected) => return,
                Ok(next) => next,
                Err(TryRecvError::Empty) => select! {
                    recv(inputs) -> next => match next {
                        Ok(next) => next,
                        Err(_) => return,
                    },
                    recv(hints) -> hint => {
                        // The newest hint is the most likely one.
                        let newest = hints.try_iter().last().or(hint.ok());
                        let Some((sound, segment)) = newest else { return };
                        self.decode_early(sound, segment, events);
                        continue;
                    }
                },
            };
            if self.closed.load(Ordering::SeqCst) {
                return;
            }
            let segments = self.recognise(input);
            for snr_db in segments.iter().flatten().map(|segment| segment.snr_db) {
                if snr_db < SNR_MIN_DB {
                    tracing::warn!(snr_db, "loud background noise; help: speak closer, or type");
                }
            }
            push(&mut self.early.answered, sound);
            if events.send(In::Recognised(Recognised { sound, segments })).is_err() {
                return;
            }
        }
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

    fn recognise(&mut self, input: RecognitionInput) -> Result<Vec<RecognisedSegment>, String> {
        let recogniser = match &mut self.recogniser {
            Ok(recogniser) => recogniser.as_mut(),
            Err(reason) => return Err(format!("speech recognition is off: {reason}")),
        };
        match input {
            RecognitionInput::File(path) => self.recognise_file(Path::new(&path)),
            RecognitionInput::Speech(segment) => match self.early.take(&segment) {
                Some(result) => Ok(vec![result]),
                None => recognise_segment(recogniser, &self.gate, &segment)
                    .map(|result| vec![result])
                    .map_err(|error| error.to_string()),
            },
        }
    }

    fn recognise_file(&mut self, path: &Path) -> Result<Vec<RecognisedSegment>, String> {
        let samples = read_wav(path, self.longest_s).map_err(|error| error.to_string())?;
        let mut segmenter = Segmenter::new(self.segmenter.clone());
        let mut events = segmenter.push(&samples);
        events.extend(segmenter.finish());
        let mut segments = Vec::new();
        let Ok(recogniser) = &mut self.recogniser else { return Ok(segments) };
        for event in events {
            let VadEvent::End { range, speech } = event else { continue };
            if self.closed.load(Ordering::SeqCst) {
                break;
            }
            let segment =
                recognise_range(recogniser.as_mut(), &self.gate, &samples, range, &speech);
            segments.push(segment.map_err(|error| error.to_string())?);
        }
        Ok(segments)
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
