//! Whether what was heard is meant for the robot.

use std::collections::BTreeSet;

use scene::Scene;

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
        /// Share of the scene's words times their mean posterior.
        score: f32,
    },
}

/// Turns away speech that is not about the scene.
///
/// The language model knows the scene's sentences and common words of other talk; what is said
/// about other things comes out as a mixture of both, of which the recogniser is unsure.
#[derive(Clone, Debug)]
pub struct Gate {
    words: BTreeSet<String>,
    threshold: f32,
}

impl Gate {
    /// The threshold that lets some 1 % of other talk in and costs 2 % of what is meant for the
    /// robot.
    pub const THRESHOLD: f32 = 0.55;

    /// A gate for the scene; `threshold` from 0 (let everything in) to 1.
    pub fn new(scene: &Scene, threshold: f32) -> Self {
        let sentences = scene_sentences(scene);
        let words = sentences.iter().flat_map(|s| s.split(' ')).map(str::to_owned).collect();
        Self { words, threshold }
    }

    /// Judges the hypotheses of one utterance by the best of them.
    pub fn judge(&self, hypotheses: Vec<Hypothesis>) -> Outcome {
        let Some(best) = hypotheses.first() else {
            let reason = RejectReason::NothingRecognised;
            return Outcome::Rejected { text: String::new(), reason };
        };
        let score = self.score(best);
        if score >= self.threshold {
            return Outcome::Accepted(hypotheses);
        }
        let reason = RejectReason::NotForTheRobot { score };
        Outcome::Rejected { text: best.text.clone(), reason }
    }

    /// How much a hypothesis is about the scene, 0 to 1: the share of the scene's words, squared,
    /// times the root of the mean posterior of its words. (Of the products of powers of the two,
    /// this one keeps most of what is meant for the robot at 1 % of other talk.)
    pub fn score(&self, hypothesis: &Hypothesis) -> f32 {
        let n = hypothesis.words.len().max(1) as f32;
        let of_scene = hypothesis.words.iter().filter(|(w, _)| self.words.contains(w)).count();
        let share = of_scene as f32 / n;
        let posterior = hypothesis.words.iter().map(|(_, p)| p).sum::<f32>() / n;
        share * share * posterior.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::bowls;

    fn heard(words: &[(&str, f32)]) -> Vec<Hypothesis> {
        let text = words.iter().map(|(w, _)| *w).collect::<Vec<_>>().join(" ");
        let words = words.iter().map(|(w, p)| ((*w).to_owned(), *p)).collect();
        vec![Hypothesis { text, confidence: 1.0, words }]
    }

    #[test]
    fn sure_words_of_the_scene_pass() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let outcome = gate.judge(heard(&[("yes", 0.9), ("the", 0.7), ("white", 0.8)]));
        assert!(matches!(outcome, Outcome::Accepted(h) if h[0].text == "yes the white"));
    }

    #[test]
    fn other_words_and_unsure_words_do_not_pass_but_are_told() {
        let gate = Gate::new(&bowls(), Gate::THRESHOLD);
        let other = heard(&[("the", 0.9), ("weather", 0.9), ("today", 0.9)]);
        for hypotheses in [other, heard(&[("white", 0.1)])] {
            let text = hypotheses[0].text.clone();
            match gate.judge(hypotheses) {
                Outcome::Rejected {
                    text: told,
                    reason: RejectReason::NotForTheRobot { score },
                } => {
                    assert_eq!(told, text);
                    assert!(score < Gate::THRESHOLD);
                }
                outcome => panic!("{outcome:?}"),
            }
        }
    }

    #[test]
    fn nothing_recognised_is_rejected_even_by_an_open_gate() {
        let outcome = Gate::new(&bowls(), 0.0).judge(Vec::new());
        let reason = RejectReason::NothingRecognised;
        assert_eq!(outcome, Outcome::Rejected { text: String::new(), reason });
    }
}
