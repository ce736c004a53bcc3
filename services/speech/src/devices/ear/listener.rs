//! The ear's thread: sounds are decoded in order, and what may be an utterance's end before that is
//! certain.
//!
//! Invariant: what was decoded early is the result only of the very samples that were decoded.

use std::collections::VecDeque;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crossbeam_channel::{Receiver, Sender, TryRecvError, select};

use super::{EarEvent, Segment, Sound};
use crate::devices::audio::{read_wav, seconds};
use crate::devices::recogniser::{Gate, Outcome, RecogniseError, Recogniser};
use crate::devices::stream::Cut;
use crate::devices::vad::{SegmentEvent, Segmenter, SegmenterOptions};

/// Results of early decoding that are kept: one for each who speaks, and one that turned out to have
/// been too early.
const KEPT_MAX: usize = 4;

/// The thread's side.
pub(super) struct Listener {
    pub(super) recogniser: Result<Box<dyn Recogniser>, String>,
    pub(super) gate: Gate,
    pub(super) segmenter: SegmenterOptions,
    pub(super) longest_s: f64,
    pub(super) closed: Arc<AtomicBool>,
    pub(super) early: Early,
}

/// What was decoded before it was certain.
#[derive(Default)]
pub(super) struct Early {
    kept: VecDeque<(Cut, Segment)>,
    /// The sounds that were answered last: hints about them come too late.
    answered: VecDeque<u64>,
}

impl Early {
    fn take(&mut self, cut: &Cut) -> Option<Segment> {
        let is_same =
            |(kept, _): &(Cut, Segment)| kept.speech == cut.speech && kept.samples == cut.samples;
        let at = self.kept.iter().position(is_same)?;
        self.kept.remove(at).map(|(_, segment)| segment)
    }

    fn keep(&mut self, cut: Cut, segment: Segment) {
        push(&mut self.kept, (cut, segment));
    }
}

fn push<T>(queue: &mut VecDeque<T>, item: T) {
    if queue.len() >= KEPT_MAX {
        queue.pop_front();
    }
    queue.push_back(item);
}

impl Listener {
    pub(super) fn run(
        mut self,
        sounds: &Receiver<(u64, Sound)>,
        hints: &Receiver<(u64, Cut)>,
        events: &Sender<EarEvent>,
    ) {
        loop {
            // What is certain comes first.
            let asked = match sounds.try_recv() {
                Err(TryRecvError::Disconnected) => return,
                Ok(asked) => asked,
                Err(TryRecvError::Empty) => select! {
                    recv(sounds) -> asked => match asked {
                        Ok(asked) => asked,
                        Err(_) => return,
                    },
                    recv(hints) -> hint => {
                        // Of several the newest is the likeliest to be true.
                        let newest = hints.try_iter().last().or(hint.ok());
                        let Some((id, cut)) = newest else { return };
                        self.decode_early(id, cut, events);
                        continue;
                    }
                },
            };
            if self.closed.load(Ordering::SeqCst) || !self.answer(asked, events) {
                return;
            }
        }
    }

    /// Returns whether somebody takes the answer.
    fn answer(&mut self, (id, sound): (u64, Sound), events: &Sender<EarEvent>) -> bool {
        let event = match self.listen(sound) {
            Ok(segments) => EarEvent::Heard { id, segments },
            Err(error) => EarEvent::Failed { id, error },
        };
        push(&mut self.early.answered, id);
        events.send(event).is_ok()
    }

    fn decode_early(&mut self, id: u64, cut: Cut, events: &Sender<EarEvent>) {
        let Ok(recogniser) = &mut self.recogniser else { return };
        if !recogniser.is_quick() || self.early.answered.contains(&id) {
            return;
        }
        // What fails is tried again when it is certain, and told then.
        let Ok(segment) = spoken(recogniser.as_mut(), &self.gate, &cut) else { return };
        let text = match &segment.outcome {
            Outcome::Accepted(hypotheses) => hypotheses.first().map(|best| best.text.clone()),
            Outcome::Rejected { text, .. } => Some(text.clone()),
        };
        self.early.keep(cut, segment);
        // Without a taker for its events the ear ends with the next sound.
        let _ = text.map(|text| events.send(EarEvent::SoFar { id, text }));
    }

    fn listen(&mut self, sound: Sound) -> Result<Vec<Segment>, String> {
        let recogniser = match &mut self.recogniser {
            Ok(recogniser) => recogniser.as_mut(),
            Err(reason) => return Err(format!("speech recognition is off: {reason}")),
        };
        let samples = match sound {
            Sound::File(path) => read_wav(&path, self.longest_s).map_err(|e| e.to_string())?,
            Sound::Samples(samples) => samples,
            Sound::Speech(cut) => {
                let segment = match self.early.take(&cut) {
                    Some(segment) => Ok(segment),
                    None => spoken(recogniser, &self.gate, &cut),
                };
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

/// One utterance that was cut out of a stream.
fn spoken(
    recogniser: &mut dyn Recogniser,
    gate: &Gate,
    Cut { samples, speech, .. }: &Cut,
) -> Result<Segment, RecogniseError> {
    segment(recogniser, gate, samples, 0..samples.len(), speech)
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
pub(super) fn snr_db(samples: &[i16], range: &Range<usize>, speech: &Range<usize>) -> f32 {
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
