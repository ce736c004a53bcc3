//! Rejection of speech that is not meant for the robot.

use std::collections::BTreeSet;

use language::Reader;
use messages::{GateVerdict, Hypothesis};
use scene::{Intent, ObjectId, Question, Reading, Response, Scene, WordId};
use speech_engines::language_model::scene_sentences;
use vocabulary::Language;

use super::heard::{Heard, SecondView};

/// Speech that is shown as heard but not acted on.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Rejected {
    /// The best hypothesis; empty if nothing was recognised.
    pub text: String,
    /// Reason for ignoring the utterance.
    pub reason: GateVerdict,
    /// [`Gate::score`] of the speech, 0 to 1.
    pub score: f64,
}

/// Share of a meaning in the scene's words alone from which it is accepted whatever else was heard.
const PLAIN: f64 = 0.5;
/// Share of a clear meaning, which second opinions do not change (docs/speech.md).
const CLEAR: f64 = 0.9;
/// A yes or no has a meaning only as an answer.
const ANY_QUESTION: Question = Question::Point(ObjectId(0));

/// Rejects speech that is not about the scene.
///
/// The language model knows the scene's sentences and common words of other talk; speech about
/// other things is recognised as a mixture of both, with low confidence.
pub struct Gate {
    words: BTreeSet<String>,
    reader: Reader,
    threshold: f64,
}

impl Gate {
    /// Default threshold; `docs/speech.md` lists accepted and rejected talk.
    pub const THRESHOLD: f32 = 0.45;

    /// Returns a gate for the scene; `threshold` from 0 (accept everything) to 1.
    pub fn new(scene: &Scene, threshold: f32) -> Self {
        let sentences = scene_sentences(scene);
        let words = sentences.iter().flat_map(|s| s.split(' ')).map(str::to_owned).collect();
        let reader = Reader::new(scene, Language::Careful);
        Self { words, reader, threshold: threshold.into() }
    }

    /// Accepts or rejects all hypotheses of one utterance together; returns them, best first.
    /// `is_voice` judges whether the sound is a voice's, and is asked last.
    ///
    /// # Errors
    /// If the sound has no speech, or none for the robot.
    pub fn judge(
        &self,
        heard: &Heard,
        is_voice: impl FnOnce() -> bool,
    ) -> Result<Vec<Hypothesis>, Rejected> {
        let hypotheses = heard.hypotheses();
        let rejected = |reason, score| {
            let text = hypotheses.first().map_or("", |best| best.text.as_str()).to_owned();
            Err(Rejected { text, reason, score })
        };
        if hypotheses.is_empty() {
            return rejected(GateVerdict::NoWords, 0.0);
        }
        let score = self.score(&hypotheses);
        if let SecondView::Heard(opinion) = &heard.second
            && opinion.is_silence()
        {
            return rejected(GateVerdict::NoSpeech, score);
        }
        if score < self.threshold && self.plain_content(&hypotheses) < PLAIN {
            return rejected(GateVerdict::OtherTalk, score);
        }
        if !is_voice() {
            return rejected(GateVerdict::NoSpeech, score);
        }
        Ok(hypotheses)
    }

    /// Returns how much the hypotheses are about the scene, 0 to 1: the mean share of the scene's
    /// words in them, to the sixth power, times the weight of the heaviest meaning; both by the
    /// hypotheses' weights. (Of the products of powers of shares, weights and word probabilities
    /// that were compared, this one keeps most utterances to the robot at 1 % of other talk, in
    /// quiet and in noise.)
    pub fn score(&self, hypotheses: &[Hypothesis]) -> f64 {
        let total = total_weight(hypotheses);
        let share = hypotheses.iter().map(|h| h.weight * self.share(h)).sum::<f64>() / total;
        let meanings = self.meanings(hypotheses.iter(), Question::None);
        share.powi(6) * meanings.iter().map(|(_, weight)| *weight).fold(0.0, f64::max) / total
    }

    /// Returns whether the hypotheses are so certain that another opinion would hardly matter.
    pub fn is_clear(&self, hypotheses: &[Hypothesis]) -> bool {
        self.score(hypotheses).max(self.plain_content(hypotheses)) >= CLEAR
    }

    /// Returns the share of the scene's words among all words.
    fn share(&self, hypothesis: &Hypothesis) -> f64 {
        let (mut of_scene, mut all) = (0.0, 0.0_f64);
        for word in hypothesis.text.split_whitespace() {
            all += 1.0;
            of_scene += f64::from(u8::from(self.words.contains(word)));
        }
        of_scene / all.max(1.0)
    }

    /// Returns the share of the heaviest meaning with content in the scene's words alone. A short
    /// answer is plain even if the alternative is other talk: "yes" or "years".
    fn plain_content(&self, hypotheses: &[Hypothesis]) -> f64 {
        let plain = hypotheses.iter().filter(|hypothesis| self.share(hypothesis) >= 1.0);
        let meanings = self.meanings(plain, ANY_QUESTION);
        let with_content = meanings.iter().filter(|(meaning, _)| meaning.has_content());
        with_content.map(|(_, weight)| *weight).fold(0.0, f64::max) / total_weight(hypotheses)
    }

    /// Returns the meanings of the hypotheses as answers to `question`, with their weights.
    fn meanings<'h>(
        &self,
        hypotheses: impl Iterator<Item = &'h Hypothesis>,
        question: Question,
    ) -> Vec<(Meaning, f64)> {
        let mut meanings: Vec<(Meaning, f64)> = Vec::new();
        for hypothesis in hypotheses {
            let meaning = Meaning::of(self.reader.read(&hypothesis.text, question));
            match meanings.iter_mut().find(|(known, _)| *known == meaning) {
                Some((_, weight)) => *weight += hypothesis.weight,
                None => meanings.push((meaning, hypothesis.weight)),
            }
        }
        meanings
    }
}

fn total_weight(hypotheses: &[Hypothesis]) -> f64 {
    hypotheses.iter().map(|h| h.weight).sum::<f64>().max(f64::MIN_POSITIVE)
}

/// Meaning of a reading without the order of words.
#[derive(PartialEq)]
struct Meaning {
    base: BTreeSet<WordId>,
    excluded: BTreeSet<BTreeSet<WordId>>,
    response: Response,
    intent: Intent,
}

impl Meaning {
    fn of(reading: Reading) -> Self {
        Self {
            base: reading.base.into_iter().collect(),
            excluded: reading.excluded.into_iter().map(|g| g.into_iter().collect()).collect(),
            response: reading.response,
            intent: reading.intent,
        }
    }

    /// Returns whether it describes an object or answers a question.
    fn has_content(&self) -> bool {
        matches!(self.intent, Intent::Inform | Intent::GoOn)
            && (!self.base.is_empty()
                || !self.excluded.is_empty()
                || self.response != Response::None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use speech_engines::recogniser::Opinion;
    use speech_engines::testing::bowls;

    fn hypotheses(weighed: &[(&str, f64)]) -> Vec<Hypothesis> {
        let hypothesis = |(text, weight): &(&str, f64)| Hypothesis {
            weight: *weight,
            ..Hypothesis::certain(*text)
        };
        weighed.iter().map(hypothesis).collect()
    }

    fn heard(weighed: &[(&str, f64)]) -> Heard {
        Heard { first: hypotheses(weighed).into(), second: SecondView::NotAsked }
    }

    #[test]
    fn gate_accepts_speech_about_the_scene_and_short_answers_only() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let judge = |weighed: &[(&str, f64)]| gate.judge(&heard(weighed), || true);
        assert_eq!(judge(&[("yes the white one", 0.9), ("yes", 0.1)]).unwrap().len(), 2);
        let rejected = judge(&[("the weather today", 0.9), ("the white one", 0.1)]).unwrap_err();
        assert_eq!(rejected.text, "the weather today");
        assert!(rejected.score < gate.threshold);
        assert_eq!(rejected.reason, GateVerdict::OtherTalk);
        let answer = [("yes", 0.7), ("years", 0.3)];
        assert!(gate.score(&hypotheses(&answer)) < gate.threshold);
        assert!(judge(&answer).is_ok(), "plain content");
        assert!(judge(&[("years", 0.6), ("yes", 0.4)]).is_err());
        let nothing = Gate::new(&bowls(), 0.0).judge(&heard(&[]), || true).unwrap_err();
        assert_eq!((nothing.text.as_str(), nothing.reason), ("", GateVerdict::NoWords));
    }

    #[test]
    fn gate_rejects_what_is_no_voice_or_silence_to_the_second_recogniser() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let second = |no_speech| {
            let (text, ln_own) = ("yes".to_owned(), -1.0);
            SecondView::Heard(Opinion { text, ln_own, ln_likelihood: vec![-1.0], no_speech })
        };
        let judge = |no_speech, is_voice| {
            let heard = Heard { second: second(no_speech), ..heard(&[("yes", 1.0)]) };
            gate.judge(&heard, || is_voice)
        };
        assert!(judge(0.2, true).is_ok());
        for (no_speech, is_voice) in [(0.7, true), (0.2, false)] {
            assert_eq!(judge(no_speech, is_voice).unwrap_err().reason, GateVerdict::NoSpeech);
        }
    }

    #[test]
    fn gate_adds_the_weights_of_hypotheses_with_the_same_meaning() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        for (second, expected) in [("a white bowl", 1.0), ("the clear one", 0.5)] {
            let score = gate.score(&hypotheses(&[("the white one", 0.5), (second, 0.5)]));
            assert!((score - expected).abs() < 1e-6, "{second}: {score}");
        }
    }
}
