//! The service's own way from samples to hypotheses: detector of speech, recognisers, gate.

use super::corpus::Clip;
use crate::arm::thread_s;
use ::speech::Hypothesis;
use ::speech::hearing::{Ensemble, Gate, SecondView, is_voice};
use ::speech_engines::audio::RATE_HZ;
use ::speech_engines::recogniser::{
    Opinion, PocketSphinx, PocketSphinxOptions, RecogniserUnavailable, SecondOpinion,
};
use ::speech_engines::vad::{Segmenter, SegmenterOptions, VadEvent};
use crossbeam_channel::{Receiver, Select};
use scene::Scene;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A stretch of a clip that was taken for speech.
pub(super) struct Heard {
    /// Range of the voice by the detector, samples.
    pub(super) speech: Range<usize>,
    /// Provisional ends of the voice, at which decoding began, samples.
    pub(super) decoded_at: usize,
    /// Best first, as the gate lets them pass or not.
    pub(super) hypotheses: Vec<Hypothesis>,
    /// Whether the gate lets them pass at each of [`THRESHOLDS`].
    pub(super) accepted: [bool; THRESHOLDS.len()],
    /// Seconds from there to the hypotheses, by the clock and of processor; the latter without the
    /// second recogniser's.
    pub(super) took_s: (f64, f64),
    /// Whether the second recogniser was asked, and whether it was late.
    pub(super) asked: bool,
    pub(super) late: bool,
}

/// Thresholds of the gate that are compared; the first is the one in use.
pub(super) const THRESHOLDS: [f32; 7] = [Gate::THRESHOLD, 0.15, 0.25, 0.35, 0.45, 0.55, 0.7];

/// One robot's ears.
pub(super) struct Listener {
    recognisers: Ensemble,
    gates: [Gate; THRESHOLDS.len()],
    /// How long a second opinion is waited for.
    pub(super) patience: Duration,
    /// Seconds from nothing to a recogniser that is ready.
    pub(super) start_s: f64,
}

impl Listener {
    /// Opens the first recogniser with files in `work`, and the second one of a model.
    pub(super) fn new(
        scene: &Scene,
        work: &Path,
        model: Option<PathBuf>,
    ) -> Result<Self, RecogniserUnavailable> {
        let started = Instant::now();
        let first = PocketSphinx::open(scene, &PocketSphinxOptions::debian(work))?;
        let start_s = started.elapsed().as_secs_f64();
        let second = model.map(|model| SecondOpinion::start(model, scene.clone()));
        let gate = Gate::new(scene, Gate::THRESHOLD);
        let recognisers = Ensemble::new(Box::new(first), second, gate);
        let gates = THRESHOLDS.map(|threshold| Gate::new(scene, threshold));
        Ok(Self { recognisers, gates, patience: Duration::MAX, start_s })
    }

    /// Returns what is heard from half a second before the voice on.
    pub(super) fn hear(&mut self, clip: &Clip) -> Vec<Heard> {
        let from = clip.speech.start.saturating_sub(RATE_HZ as usize / 2);
        self.hear_from(&clip.samples, from)
    }

    /// Returns what is heard.
    pub(super) fn hear_samples(&mut self, samples: &[i16]) -> Vec<Heard> {
        self.hear_from(samples, 0)
    }

    fn hear_from(&mut self, samples: &[i16], from: usize) -> Vec<Heard> {
        let mut segmenter = Segmenter::new(SegmenterOptions::default());
        let mut events = segmenter.push(samples);
        events.extend(segmenter.finish());
        let ends = events.into_iter().filter_map(|event| match event {
            VadEvent::End { range, speech } if speech.end >= from => Some((range, speech)),
            VadEvent::End { .. } | VadEvent::Onset { .. } | VadEvent::Pause { .. } => None,
        });
        ends.filter_map(|(range, speech)| self.decode(samples, range, speech)).collect()
    }

    /// Returns what is heard; nothing where the library fails.
    fn decode(
        &mut self,
        samples: &[i16],
        range: Range<usize>,
        speech: Range<usize>,
    ) -> Option<Heard> {
        let (started, cpu_s) = (Instant::now(), thread_s());
        let decoded_at = range.end;
        let voice = speech.start - range.start..speech.end - range.start;
        let pcm = &samples[range];
        let patience = self.patience;
        let patiently = |opinion: &Receiver<Opinion>, until: Instant| {
            let mut select = Select::new();
            select.recv(opinion);
            let until = started.checked_add(patience).map_or(until, |limit| limit.min(until));
            select.ready_deadline(until).is_ok()
        };
        let heard = self.recognisers.recognise(pcm, voice.clone(), patiently).ok()?;
        let _ = self.recognisers.judge(&heard, pcm, &voice);
        let took_s = (started.elapsed().as_secs_f64(), thread_s() - cpu_s);
        let hypotheses = heard.hypotheses();
        let is_voice = is_voice(&heard.first, pcm, &voice);
        let accepted = self.gates.each_ref().map(|gate| gate.judge(&heard, || is_voice).is_ok());
        let asked = heard.second != SecondView::NotAsked;
        let late = heard.second == SecondView::Late;
        Some(Heard { speech, decoded_at, hypotheses, accepted, took_s, asked, late })
    }
}
