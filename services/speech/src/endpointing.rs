//! The end of an utterance by its meaning: length of the pause that ends the words so far.

use std::ops::Deref;
use std::sync::LazyLock;
use std::time::Duration;

use language::{Completeness, CompletenessJudge};
use scene::{Question, Scene};
use speech_engines::stream::SpeechSegment;
use speech_engines::vad::Closing;

use crate::{Hypothesis, RecognisedSegment};

/// Pauses that end utterances, depending on the words.
pub struct Endpointing {
    /// Judges the words.
    pub judge: PreparedJudge,
    /// The pause that ends a complete utterance.
    pub complete: Duration,
    /// The pause that ends an utterance of which nothing else is known.
    pub closing: Duration,
    /// The pause that ends an utterance whose last words lead on.
    pub open: Duration,
}

/// A judge of words that is prepared when it is first needed: while a user speaks there is time for
/// the several milliseconds that it takes, during a start there is not.
pub struct PreparedJudge(LazyLock<CompletenessJudge, Prepare>);

type Prepare = Box<dyn FnOnce() -> CompletenessJudge + Send>;

impl PreparedJudge {
    /// The judge of words about a scene.
    pub fn new(scene: &Scene) -> Self {
        let scene = scene.clone();
        Self(LazyLock::new(Box::new(move || CompletenessJudge::new(&scene))))
    }
}

impl Deref for PreparedJudge {
    type Target = CompletenessJudge;

    fn deref(&self) -> &CompletenessJudge {
        &self.0
    }
}

/// Share of a hypothesis from which on it counts.
const SHARE_MIN: f64 = 0.2;
/// Signal-to-noise ratio, decibels, below which words are not judged: the last ones may be missing.
const SNR_MIN_DB: f32 = 15.0;

impl Endpointing {
    /// Returns how complete an utterance is that follows `question`: that of its least complete
    /// hypothesis, and not complete before all recognisers' results. A stop waits for nothing.
    pub fn judge(&self, result: &RecognisedSegment, question: Question) -> Completeness {
        if result.text().is_some_and(language::is_stop) {
            return Completeness::Complete;
        }
        let judged = self.judge_words(result, question);
        if result.awaits_second { judged.max(Completeness::Unclear) } else { judged }
    }

    fn judge_words(&self, result: &RecognisedSegment, question: Question) -> Completeness {
        let judge = |hypothesis: &Hypothesis| self.judge.judge(&hypothesis.text, question);
        match &result.hypotheses {
            _ if result.snr_db < SNR_MIN_DB => Completeness::Unclear,
            Ok(hypotheses) => {
                let total: f64 = hypotheses.iter().map(|hypothesis| hypothesis.weight).sum();
                let best = hypotheses.first().map_or(Completeness::Unclear, judge);
                // Only the best may be waited for longer.
                let counts = |other: &&Hypothesis| other.weight >= SHARE_MIN * total;
                let others = hypotheses.iter().skip(1).filter(counts).map(judge);
                best.max(others.max().unwrap_or(best).min(Completeness::Unclear))
            }
            Err(rejected) => self.judge.judge(&rejected.text, question).max(Completeness::Unclear),
        }
    }

    /// Returns the pause that ends an utterance. A user who can interrupt the robot loses nothing
    /// by an early reply; others get as much time as if nothing was known.
    pub fn pause(&self, judged: Completeness, interrupts: bool) -> Duration {
        let complete = self.complete.min(self.closing);
        match judged {
            Completeness::Complete => complete,
            Completeness::Sufficient if interrupts => (complete + self.closing) / 2,
            Completeness::Sufficient | Completeness::Unclear => self.closing,
            Completeness::Open => self.open.max(self.closing),
        }
    }
}

/// Possible ends of an utterance in progress that are decoded one after the other, so that the next
/// one does not delay the end by the first.
#[derive(Debug, Default, serde::Serialize, serde::Deserialize)]
pub struct EarlyDecoding {
    /// The sound that is being decoded, and the length of its speech.
    current: Option<(u64, usize)>,
    /// A later end of the same speech.
    next: Option<SpeechSegment>,
}

impl EarlyDecoding {
    /// Takes a possible end of a sound. Returns it if it is to be decoded at once.
    pub fn offer(&mut self, sound: u64, segment: SpeechSegment) -> Option<SpeechSegment> {
        let offered = (sound, segment.speech.len());
        if self.current == Some(offered) {
            self.next = Some(segment);
            return None;
        }
        (self.current, self.next) = (Some(offered), None);
        Some(segment)
    }

    /// Records that decoding of a sound has begun.
    pub fn begun(&mut self, sound: u64, at: Closing) {
        (self.current, self.next) = (Some((sound, at.speech)), None);
    }

    /// Records that a possible end was decoded. Returns the next one of the same speech.
    pub fn decoded(&mut self, sound: u64, at: Closing) -> Option<SpeechSegment> {
        self.current.take_if(|current| *current == (sound, at.speech))?;
        self.next.take()
    }
}
