//! The worker's thread: decodes inputs in order, and possible ends of utterances while it is idle. Where
//! the first recogniser is in doubt it asks the second one, and goes on meanwhile.
//!
//! Invariant: no result waits for the second recogniser longer than the closing pause, nor does the
//! next input.

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, Sender, TryRecvError, after, never, select};

use super::doubt::Doubt;
use super::early::EarlyResults;
use crate::devices::audio::{read_wav, seconds, snr_db};
use crate::devices::recogniser::{Ensemble, Heard, Opinion, SecondView};
use crate::devices::stream::SpeechSegment;
use crate::devices::vad::{Segmenter, SegmenterOptions, VadEvent};
use crate::{Hypothesis, In, Recognised, RecognisedSegment, RecognitionInput};

/// The thread's side.
pub(super) struct Worker {
    pub(super) recognisers: Result<Ensemble, String>,
    pub(super) segmenter: SegmenterOptions,
    pub(super) longest_s: f64,
    pub(super) closed: Arc<AtomicBool>,
    pub(super) events: Sender<In>,
    pub(super) early: EarlyResults,
    pub(super) doubt: Option<Doubt>,
}

/// What the thread does next.
enum Next {
    Input(u64, RecognitionInput),
    Hint(u64, SpeechSegment),
    /// The second recogniser's opinion, or that it is late.
    Opinion(Option<Opinion>),
    Closed,
}

impl Worker {
    pub(super) fn run(
        mut self,
        inputs: &Receiver<(u64, RecognitionInput)>,
        hints: &Receiver<(u64, SpeechSegment)>,
    ) {
        loop {
            match self.next(inputs, hints) {
                Next::Input(..) if self.closed.load(Ordering::SeqCst) => return,
                Next::Input(sound, input) => self.on_input(sound, input),
                Next::Hint(sound, segment) => self.on_hint(sound, segment),
                Next::Opinion(opinion) => self.settle(opinion),
                Next::Closed => return,
            }
        }
    }

    fn next(
        &self,
        inputs: &Receiver<(u64, RecognitionInput)>,
        hints: &Receiver<(u64, SpeechSegment)>,
    ) -> Next {
        // Inputs have priority over hints.
        match inputs.try_recv() {
            Ok((sound, input)) => return Next::Input(sound, input),
            Err(TryRecvError::Disconnected) => return Next::Closed,
            Err(TryRecvError::Empty) => {}
        }
        let (opinion, until) = Doubt::awaited(self.doubt.as_ref());
        let late = until
            .map_or_else(never, |until| after(until.saturating_duration_since(Instant::now())));
        select! {
            recv(inputs) -> next => {
                next.map_or(Next::Closed, |(sound, input)| Next::Input(sound, input))
            }
            recv(hints) -> hint => {
                // The newest hint is the most likely one.
                let newest = hints.try_iter().last().or(hint.ok());
                newest.map_or(Next::Closed, |(sound, segment)| Next::Hint(sound, segment))
            }
            recv(opinion) -> opinion => Next::Opinion(opinion.ok()),
            recv(late) -> _ => Next::Opinion(None),
        }
    }

    fn on_input(&mut self, sound: u64, input: RecognitionInput) {
        if let (RecognitionInput::Speech(segment), Some(doubt)) = (&input, &mut self.doubt)
            && doubt.is_about(sound, segment)
            && !doubt.is_owed
        {
            return doubt.owe();
        }
        // Results keep their order.
        self.settle(None);
        match input {
            RecognitionInput::File(path) => {
                let segments = self.recognise_file(Path::new(&path));
                self.answer(sound, segments);
            }
            RecognitionInput::Speech(segment) => self.on_speech(sound, segment),
        }
    }

    fn on_speech(&mut self, sound: u64, segment: SpeechSegment) {
        if let Some(result) = self.early.take(&segment) {
            return self.answer(sound, Ok(vec![result]));
        }
        match self.ask_first(&segment) {
            Err(reason) => self.answer(sound, Err(reason)),
            Ok(first) => match self.doubted(sound, &segment, &first) {
                Some(mut doubt) => {
                    doubt.owe();
                    self.doubt = Some(doubt);
                }
                None => {
                    let heard = Heard { first, second: SecondView::NotAsked };
                    let result = self.result(&segment, heard, false);
                    self.answer(sound, result.map(|result| vec![result]));
                }
            },
        }
    }

    fn on_hint(&mut self, sound: u64, segment: SpeechSegment) {
        let is_quick = self.recognisers.as_ref().is_ok_and(Ensemble::is_quick);
        if !is_quick || self.early.is_answered(sound) {
            return;
        }
        // Whoever speaks on makes the question pointless.
        let is_other = |doubt: &mut Doubt| !doubt.is_owed && !doubt.is_about(sound, &segment);
        self.doubt.take_if(is_other);
        // A failure is retried when the end is certain, and reported then.
        let first = self.ask_first(&segment).ok();
        let Some(first) = first else { return self.publish_early(sound, &segment, None) };
        let result = Heard { first: first.clone(), second: SecondView::NotAsked };
        match &mut self.doubt {
            Some(doubt) if doubt.is_owed => {}
            Some(doubt) => doubt.update(segment.clone(), first),
            None => self.doubt = self.doubted(sound, &segment, &first),
        }
        let awaits_second =
            self.doubt.as_ref().is_some_and(|doubt| doubt.is_about(sound, &segment));
        let result = self.result(&segment, result, awaits_second).ok();
        self.publish_early(sound, &segment, result.clone());
        if let Some(result) = result.filter(|_| !awaits_second) {
            self.early.keep(segment, result);
        }
    }

    /// Ends the question to the second recogniser, if one is asked, with its opinion or without.
    fn settle(&mut self, opinion: Option<Opinion>) {
        let Some(doubt) = self.doubt.take() else { return };
        let (sound, segment, heard, is_owed) = doubt.settled(opinion);
        let result = self.result(&segment, heard, false);
        if is_owed {
            return self.answer(sound, result.map(|result| vec![result]));
        }
        if let Ok(result) = result {
            self.publish_early(sound, &segment, Some(result.clone()));
            self.early.keep(segment, result);
        }
    }

    /// Asks the second recogniser where the first one is in doubt.
    fn doubted(&self, sound: u64, segment: &SpeechSegment, first: &[Hypothesis]) -> Option<Doubt> {
        let recognisers = self.recognisers.as_ref().ok().filter(|it| it.is_in_doubt(first))?;
        Doubt::raise(recognisers, sound, segment.clone(), first.to_vec(), &self.segmenter)
    }

    fn ask_first(&mut self, segment: &SpeechSegment) -> Result<Vec<Hypothesis>, String> {
        let recognisers = available(&mut self.recognisers)?;
        let first = recognisers.ask_first(&segment.samples, segment.speech.clone());
        first.map_err(|error| error.to_string())
    }

    fn result(
        &self,
        segment: &SpeechSegment,
        heard: Heard,
        awaits_second: bool,
    ) -> Result<RecognisedSegment, String> {
        let recognisers = self.recognisers.as_ref().map_err(Clone::clone)?;
        let SpeechSegment { samples, speech, .. } = segment;
        let result = judged(recognisers, samples, &(0..samples.len()), speech, heard);
        Ok(RecognisedSegment { awaits_second, ..result })
    }

    fn recognise_file(&mut self, path: &Path) -> Result<Vec<RecognisedSegment>, String> {
        let recognisers = available(&mut self.recognisers)?;
        let samples = read_wav(path, self.longest_s).map_err(|error| error.to_string())?;
        let mut segmenter = Segmenter::new(self.segmenter.clone());
        let mut events = segmenter.push(&samples);
        events.extend(segmenter.finish());
        let mut segments = Vec::new();
        for event in events {
            let VadEvent::End { range, speech } = event else { continue };
            if self.closed.load(Ordering::SeqCst) {
                break;
            }
            let voice = speech.start - range.start..speech.end - range.start;
            let heard = recognisers.recognise(&samples[range.clone()], voice);
            let heard = heard.map_err(|error| error.to_string())?;
            segments.push(judged(recognisers, &samples, &range, &speech, heard));
        }
        Ok(segments)
    }

    fn publish_early(
        &self,
        sound: u64,
        segment: &SpeechSegment,
        result: Option<RecognisedSegment>,
    ) {
        let at = segment.closing(Duration::ZERO);
        // Without a receiver of its events the worker ends with the next input.
        let _ = self.events.send(In::EarlyResult { sound, at, result: result.map(Box::new) });
    }

    fn answer(&mut self, sound: u64, segments: Result<Vec<RecognisedSegment>, String>) {
        for segment in segments.iter().flatten() {
            report(segment);
        }
        self.early.answered(sound);
        // Without a receiver of its events nobody gives it more to do.
        let _ = self.events.send(In::Recognised(Recognised { sound, segments }));
    }
}

/// Returns the recognisers, or why there are none.
fn available(recognisers: &mut Result<Ensemble, String>) -> Result<&mut Ensemble, String> {
    recognisers.as_mut().map_err(|reason| format!("speech recognition is off: {reason}"))
}

/// Signal-to-noise ratio, decibels, below which hardly half of the speech is understood.
const SNR_MIN_DB: f32 = 15.0;
/// Smallest weight of a hypothesis that is handed on.
const WEIGHT_MIN: f64 = 1e-3;

fn report(segment: &RecognisedSegment) {
    let snr_db = segment.snr_db;
    if snr_db < SNR_MIN_DB {
        tracing::warn!(snr_db, "loud background noise; help: speak closer, or type");
    }
    if let Err(rejected) = &segment.hypotheses {
        let (text, score, reason) = (&rejected.text, rejected.score, rejected.reason);
        tracing::info!(text, score, ?reason, "speech rejected: not meant for the robot");
    }
}

/// Returns the result for the samples of `range`, in which `speech` are those of the voice.
fn judged(
    recognisers: &Ensemble,
    samples: &[i16],
    range: &Range<usize>,
    speech: &Range<usize>,
    heard: Heard,
) -> RecognisedSegment {
    let voice = speech.start - range.start..speech.end - range.start;
    let mut hypotheses = recognisers.judge(&heard, &samples[range.clone()], &voice);
    for hypothesis in hypotheses.iter_mut().flatten() {
        hypothesis.weight = hypothesis.weight.max(WEIGHT_MIN);
    }
    RecognisedSegment {
        span_s: (seconds(speech.start), seconds(speech.end)),
        snr_db: snr_db(samples, range, speech),
        hypotheses,
        heard,
        awaits_second: false,
    }
}
