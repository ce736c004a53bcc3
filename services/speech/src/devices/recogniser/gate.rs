//! Whether what was heard is meant for the robot.

use std::collections::BTreeSet;

use language::{Language, Reader};
use scene::{Intent, ObjectId, Question, Reading, Response, Scene, WordId};

use super::Hypothesis;
use crate::devices::language_model::scene_sentences;

/// What became of one stretch of speech.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// Meant for the robot; best hypothesis first.
    Accepted(Vec<Hypothesis>),
    /// Heard, but not acted on; to be shown, never dropped in silence.
    Rejected {
        /// What it sounded like; empty if nothing was made out.
        text: String,
        /// Why it does not count.
        reason: RejectReason,
    },
}

/// Why speech does not count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RejectReason {
    /// No word was made out.
    NothingRecognised,
    /// It sounds like talk about other things.
    NotForTheRobot {
        /// How much it is about the scene ([`Gate::score`]).
        score: f32,
    },
}

/// Share of a meaning in the scene's words alone from which it is taken whatever else was heard.
const PLAIN: f32 = 0.5;
/// A yes or no says something only where something was asked.
const ANY_QUESTION: Question = Question::Point(ObjectId(0));

/// Turns away speech that is not about the scene.
///
/// The language model knows the scene's sentences and common words of other talk; what is said
/// about other things comes out as a mixture of both, of which the recogniser is unsure.
pub struct Gate {
    words: BTreeSet<String>,
    reader: Reader,
    threshold: f32,
}

impl Gate {
    /// The default; `docs/speech.md` tells what it lets in and what it turns away.
    pub const THRESHOLD: f32 = 0.25;

    /// A gate for the scene; `threshold` from 0 (let everything in) to 1.
    pub fn new(scene: &Scene, threshold: f32) -> Self {
        let sentences = scene_sentences(scene);
        let words = sentences.iter().flat_map(|s| s.split(' ')).map(str::to_owned).collect();
        Self { words, reader: Reader::new(scene, Language::Careful), threshold }
    }

    /// Judges the hypotheses of one utterance, all of them together.
    pub fn judge(&self, hypotheses: Vec<Hypothesis>) -> Outcome {
        let Some(best) = hypotheses.first() else {
            let reason = RejectReason::NothingRecognised;
            return Outcome::Rejected { text: String::new(), reason };
        };
        let score = self.score(&hypotheses);
        if score >= self.threshold || self.plain_content(&hypotheses) >= PLAIN {
            return Outcome::Accepted(hypotheses);
        }
        let reason = RejectReason::NotForTheRobot { score };
        Outcome::Rejected { text: best.text.clone(), reason }
    }

    /// How much the hypotheses are about the scene, 0 to 1: the mean share of the scene's words in
    /// them, to the sixth power, times the weight of the weightiest meaning; both by the
    /// hypotheses' weights. (Of the products of powers of shares, weights and words' probabilities
    /// that were compared, this one keeps most of what is meant for the robot at 1 % of other talk,
    /// in quiet and in noise.)
    pub fn score(&self, hypotheses: &[Hypothesis]) -> f32 {
        let total: f32 = hypotheses.iter().map(|h| h.confidence).sum();
        let shares = hypotheses.iter().map(|h| h.confidence * self.share(h)).sum::<f32>();
        let share = shares / total.max(f32::MIN_POSITIVE);
        share.powi(6) * self.weightiest_meaning(hypotheses) / total.max(f32::MIN_POSITIVE)
    }

    /// The scene's words of all words.
    fn share(&self, hypothesis: &Hypothesis) -> f32 {
        let (mut of_scene, mut all) = (0.0, 0.0_f32);
        for word in hypothesis.text.split_whitespace() {
            all += 1.0;
            of_scene += f32::from(u8::from(self.words.contains(word)));
        }
        of_scene / all.max(1.0)
    }

    /// The share of the weightiest meaning with content that is said in the scene's words alone. A
    /// short answer is plain even where what it might have been instead is other talk: "yes", or
    /// else "years".
    fn plain_content(&self, hypotheses: &[Hypothesis]) -> f32 {
        let total: f32 = hypotheses.iter().map(|h| h.confidence).sum();
        let plain = hypotheses.iter().filter(|hypothesis| self.share(hypothesis) >= 1.0);
        let with_content =
            self.meanings(plain, ANY_QUESTION).into_iter().filter(|(m, _)| m.has_content());
        with_content.map(|(_, weight)| weight).fold(0.0, f32::max) / total.max(f32::MIN_POSITIVE)
    }

    /// The largest sum of the weights of hypotheses that mean the same.
    fn weightiest_meaning(&self, hypotheses: &[Hypothesis]) -> f32 {
        let meanings = self.meanings(hypotheses.iter(), Question::None);
        meanings.iter().map(|(_, weight)| *weight).fold(0.0, f32::max)
    }

    /// What the hypotheses mean as answers to `question`, with the sum of weights for each meaning.
    fn meanings<'h>(
        &self,
        hypotheses: impl Iterator<Item = &'h Hypothesis>,
        question: Question,
    ) -> Vec<(Meaning, f32)> {
        let mut meanings: Vec<(Meaning, f32)> = Vec::new();
        for hypothesis in hypotheses {
            let meaning = Meaning::of(self.reader.read(&hypothesis.text, question));
            match meanings.iter_mut().find(|(known, _)| *known == meaning) {
                Some((_, weight)) => *weight += hypothesis.confidence,
                None => meanings.push((meaning, hypothesis.confidence)),
            }
        }
        meanings
    }
}

/// What a reading says, in whatever order.
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

    /// Whether it says something about an object, or answers.
    fn has_content(&self) -> bool {
        self.intent == Intent::Inform
            && (!self.base.is_empty()
                || !self.excluded.is_empty()
                || self.response != Response::None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::bowls;

    fn heard(weighed: &[(&str, f32)]) -> Vec<Hypothesis> {
        let hypothesis = |(text, confidence): &(&str, f32)| Hypothesis {
            text: (*text).to_owned(),
            confidence: *confidence,
            words: Vec::new(),
        };
        weighed.iter().map(hypothesis).collect()
    }

    #[test]
    fn what_is_about_the_scene_passes() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let outcome = gate.judge(heard(&[("yes the white one", 0.9), ("yes", 0.1)]));
        assert!(matches!(outcome, Outcome::Accepted(h) if h[0].text == "yes the white one"));
    }

    #[test]
    fn other_words_do_not_pass_but_are_told() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        match gate.judge(heard(&[("the weather today", 0.9), ("the white one", 0.1)])) {
            Outcome::Rejected { text, reason: RejectReason::NotForTheRobot { score } } => {
                assert_eq!(text, "the weather today");
                assert!(score < Gate::THRESHOLD);
            }
            outcome => panic!("{outcome:?}"),
        }
    }

    #[test]
    fn hypotheses_that_mean_the_same_vouch_for_each_other() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let same = gate.score(&heard(&[("the white one", 0.5), ("a white bowl", 0.5)]));
        let other = gate.score(&heard(&[("the white one", 0.5), ("the clear one", 0.5)]));
        assert!((same - 1.0).abs() < 1e-6 && (other - 0.5).abs() < 1e-6, "{same} {other}");
    }

    #[test]
    fn a_short_answer_passes_though_it_sounds_like_other_talk() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let answer = heard(&[("yes", 0.7), ("years", 0.3)]);
        assert!(gate.score(&answer) < Gate::THRESHOLD);
        assert!(matches!(gate.judge(answer), Outcome::Accepted(_)));
        let other = heard(&[("years", 0.6), ("yes", 0.4)]);
        assert!(matches!(gate.judge(other), Outcome::Rejected { .. }));
    }

    #[test]
    fn nothing_recognised_is_rejected_even_by_an_open_gate() {
        let outcome = Gate::new(&bowls(), 0.0).judge(Vec::new());
        let reason = RejectReason::NothingRecognised;
        assert_eq!(outcome, Outcome::Rejected { text: String::new(), reason });
    }
}
