//! The worker's thread: decodes utterances in order, possible ends of them while idle, and files in
//! between. If the first recogniser is in doubt, it asks the second one, and continues meanwhile.
//!
//! Invariant: utterances wait for no file, and for the second recogniser at most the open pause.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use crossbeam_channel::{Receiver, Select, Sender, TryRecvError};
use speech_engines::audio::{RATE_HZ, read_wav, seconds, snr_db};
use speech_engines::recogniser::{FirstView, Opinion};
use speech_engines::stream::SpeechSegment;
use speech_engines::vad::{Segmenter, VadEvent};

use super::Limits;
use super::doubt::{Doubt, Listening};
use super::early::EarlyResults;
use crate::hearing::{Ensemble, Heard, SecondView};
use crate::{In, Recognised, RecognisedSegment};

/// Samples of a file that are searched for speech at a time: one second.
const PIECE: usize = RATE_HZ as usize;

/// The thread's side.
pub(super) struct Worker {
    /// Dropped first, so that the second recogniser stops.
    pub(super) doubt: Option<Doubt>,
    pub(super) recognisers: Result<Ensemble, String>,
    pub(super) limits: Limits,
    pub(super) closed: Arc<AtomicBool>,
    pub(super) events: Sender<In<'static>>,
    pub(super) early: EarlyResults,
}

/// The ends of the worker's channels.
pub(super) struct Channels<'a> {
    /// Segments of live utterances.
    pub(super) live: &'a Receiver<(u64, SpeechSegment)>,
    /// Possible ends of the current utterance.
    pub(super) hints: &'a Receiver<(u64, SpeechSegment)>,
    pub(super) files: &'a Receiver<(u64, PathBuf)>,
}

impl Worker {
    pub(super) fn run(mut self, channels: &Channels<'_>) {
        while self.serve(channels) {
            let (opinion, until) = Doubt::awaited(self.doubt.as_ref());
            let mut select = Select::new();
            let file = select.recv(channels.files);
            select.recv(channels.live);
            select.recv(channels.hints);
            select.recv(&opinion);
            let ready = match until {
                None => Ok(select.ready()),
                Some(until) => select.ready_deadline(until),
            };
            if ready == Ok(file)
                && let Ok((sound, path)) = channels.files.try_recv()
            {
                let segments = self.recognise_file(&path, channels);
                self.answer(sound, segments);
            }
        }
    }

    /// Decodes utterances, settles requests to the second recogniser, and decodes possible ends of
    /// the current utterance while nothing else waits. Returns whether more may come.
    fn serve(&mut self, channels: &Channels<'_>) -> bool {
        while !self.closed.load(Ordering::SeqCst) {
            match channels.live.try_recv() {
                Ok((sound, segment)) => {
                    self.on_live(sound, segment);
                    continue;
                }
                Err(TryRecvError::Disconnected) => return false,
                Err(TryRecvError::Empty) => {}
            }
            if let Some(opinion) = self.doubt.as_ref().and_then(Doubt::outcome) {
                self.settle(opinion);
            }
            // The newest hint is the most likely one.
            match channels.hints.try_iter().last() {
                Some((sound, segment)) => self.on_hint(sound, segment),
                None => return true,
            }
        }
        false
    }

    fn on_live(&mut self, sound: u64, segment: SpeechSegment) {
        if let Some(doubt) = &mut self.doubt
            && doubt.is_about(sound, &segment)
            && !doubt.is_owed
        {
            return doubt.owe();
        }
        // Results keep their order.
        self.settle(None);
        self.on_speech(sound, segment);
    }

    fn on_speech(&mut self, sound: u64, segment: SpeechSegment) {
        let early = self.early.take(&segment);
        if let Some(result) = early.as_ref().filter(|result| self.is_final(&result.heard.first)) {
            return self.answer(sound, Ok(vec![result.clone()]));
        }
        let listening = self.second_listens(sound, &segment);
        let first = early.map_or_else(|| self.ask_first(&segment), |result| Ok(result.heard.first));
        match first {
            Err(reason) => self.answer(sound, Err(reason)),
            Ok(first) => match self.doubted(listening, &first) {
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
        // If the user speaks on, the opinion is about half an utterance.
        let is_other = |doubt: &mut Doubt| !doubt.is_owed && !doubt.is_about(sound, &segment);
        self.doubt.take_if(is_other);
        // One that decides hears whole utterances only: a server would work on each piece.
        let is_asked =
            self.doubt.is_none() && !self.recognisers.as_ref().is_ok_and(Ensemble::second_decides);
        let listening = is_asked.then(|| self.second_listens(sound, &segment)).flatten();
        // A failure is retried when the end is certain, and reported then.
        let first = self.ask_first(&segment).ok();
        let Some(first) = first else { return self.publish_early(sound, &segment, None) };
        let result = Heard { first: first.clone(), second: SecondView::NotAsked };
        match &mut self.doubt {
            Some(doubt) if doubt.is_owed => {}
            Some(doubt) => doubt.update(segment.clone(), first),
            None => self.doubt = self.doubted(listening, &first),
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
        let Doubt { sound, segment, first, is_owed, .. } = doubt;
        let recognisers = self.recognisers.as_ref().map_err(Clone::clone);
        let heard = recognisers.map(|recognisers| recognisers.heard(first, opinion));
        let result = heard.and_then(|heard| self.result(&segment, heard, false));
        if is_owed {
            return self.answer(sound, result.map(|result| vec![result]));
        }
        if let Ok(result) = result {
            self.publish_early(sound, &segment, Some(result.clone()));
            self.early.keep(segment, result);
        }
    }

    /// Returns whether no second recogniser decides about an utterance that was decoded early.
    fn is_final(&self, first: &FirstView) -> bool {
        let is_open = |it: &Ensemble| it.second_decides() && it.is_in_doubt(&first.hypotheses);
        !self.recognisers.as_ref().is_ok_and(is_open)
    }

    /// Has the second recogniser listen while the first one decodes.
    fn second_listens(&self, sound: u64, segment: &SpeechSegment) -> Option<Listening> {
        let recognisers = self.recognisers.as_ref().ok()?;
        Listening::begin(recognisers, sound, segment, self.limits.patience)
    }

    /// Asks the second recogniser, which listens already, if the first one is in doubt.
    fn doubted(&self, listening: Option<Listening>, first: &FirstView) -> Option<Doubt> {
        let recognisers = self.recognisers.as_ref().ok()?;
        let listening = listening.filter(|_| recognisers.is_in_doubt(&first.hypotheses))?;
        Some(listening.doubted(first.clone(), self.limits.segmenter.post_roll_s))
    }

    fn ask_first(&mut self, segment: &SpeechSegment) -> Result<FirstView, String> {
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

    /// Decodes a file piece by piece. Utterances come first meanwhile: one may be a stop.
    fn recognise_file(
        &mut self,
        path: &Path,
        channels: &Channels<'_>,
    ) -> Result<Vec<RecognisedSegment>, String> {
        available(&mut self.recognisers)?;
        let samples = read_wav(path, self.limits.longest_s).map_err(|error| error.to_string())?;
        let mut segmenter = Segmenter::new(self.limits.segmenter.clone());
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
                segments.push(self.recognise_range(&samples, &range, &speech, channels)?);
            }
        }
        Ok(segments)
    }

    /// Decodes one utterance of a file. The second recogniser is not awaited while someone speaks,
    /// nor while an utterance waits for it.
    fn recognise_range(
        &mut self,
        samples: &[i16],
        range: &Range<usize>,
        speech: &Range<usize>,
        channels: &Channels<'_>,
    ) -> Result<RecognisedSegment, String> {
        let is_awaited = self.doubt.is_some();
        let recognisers = available(&mut self.recognisers)?;
        let (pcm, voice) = (&samples[range.clone()], voice_of(range, speech));
        let heard = recognisers.recognise(pcm, voice, |opinion, until| {
            if is_awaited {
                return false;
            }
            let mut select = Select::new();
            let answered = select.recv(opinion);
            select.recv(channels.live);
            select.recv(channels.hints);
            select.ready_deadline(until) == Ok(answered)
        });
        let heard = heard.map_err(|error| error.to_string())?;
        Ok(judged(recognisers, samples, range, speech, heard))
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
        // Without a receiver of its events no more work arrives.
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
    let rejected = segment.hypotheses.as_ref().err();
    // A stop is obeyed, whatever the score.
    if let Some(rejected) = rejected.filter(|rejected| !language::is_stop(&rejected.text)) {
        let (text, score, reason) = (&rejected.text, rejected.score, rejected.reason);
        tracing::info!(text, score, ?reason, "speech rejected: not meant for the robot");
    }
}

/// Returns the range of the voice within the samples of `range`.
fn voice_of(range: &Range<usize>, speech: &Range<usize>) -> Range<usize> {
    speech.start - range.start..speech.end - range.start
}

/// Returns the result for the samples of `range`, in which `speech` are those of the voice.
fn judged(
    recognisers: &Ensemble,
    samples: &[i16],
    range: &Range<usize>,
    speech: &Range<usize>,
    heard: Heard,
) -> RecognisedSegment {
    let voice = voice_of(range, speech);
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
