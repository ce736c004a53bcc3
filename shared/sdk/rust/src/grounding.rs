//! Grounding: the meaning of an utterance in the scene.
//!
//! Which of the robot's questions an utterance answers is not known yet: the policy attributes it afterwards. So a
//! grounder reads each wording that was heard as an answer to each question that it may answer, and to none.

mod observation;
mod process;
mod worker;

pub use observation::{message, observation, put_readings};
pub use process::{run, run_with};

use messages::{AskedQuestion, Hypothesis, READINGS_MAX, Source, Utterance, WireError};
use scene::{Doubt, Question, Reading, Scene, UnknownWord};

use crate::Interpretation;

/// Interprets utterances. Implement [`read`](Self::read) for one wording, or [`ground`](Self::ground) where the
/// utterance is to be seen as a whole.
///
/// It must need no state after a restart: it may be killed at any moment, and utterances without an observation are
/// sent again.
pub trait Grounder {
    /// Returns what the wording says if it answers `question`, each reading with its probability; these sum to 1.
    /// The words of a reading are those of the scene, by number ([`Scene::word_named`]).
    fn read(
        &mut self,
        heard: &Hypothesis,
        question: Question,
        scene: &Scene,
    ) -> Vec<(f64, Reading)>;

    /// Returns a word of the likeliest wording that the scene does not have, about which the robot says so.
    /// `question` is the newest one that it may answer.
    fn unknown(
        &mut self,
        _best: &Hypothesis,
        _question: Question,
        _scene: &Scene,
    ) -> Option<UnknownWord> {
        None
    }

    /// Returns the meaning of the whole utterance: by default, that of each wording as an answer to each question
    /// and to none, equal meanings together.
    fn ground(&mut self, heard: &Heard, scene: &Scene) -> Grounded {
        if heard.hypotheses.is_empty() && heard.gesture_m.is_some() {
            // A pointing gesture without words: one reading, without a word.
            let said = Interpretation { weight: 1.0, answers: None, reading: Reading::default() };
            return Grounded { interpretations: vec![said], unknown: None };
        }
        let at_most = READINGS_MAX / (heard.questions.len() + 1);
        let mut interpretations = Vec::new();
        for place in (0..heard.questions.len()).map(Some).chain([None]) {
            let question = place.map_or(Question::None, |at| heard.questions[at]);
            let read =
                heard.hypotheses.iter().map(|one| (one.weight, self.read(one, question, scene)));
            let readings = together(read, at_most).into_iter();
            interpretations.extend(readings.map(|(weight, reading)| Interpretation {
                weight,
                answers: place,
                reading,
            }));
        }
        let best = heard.hypotheses.first();
        let newest = heard.questions.first().copied().unwrap_or(Question::None);
        let unknown = best.and_then(|best| self.unknown(best, newest, scene));
        Grounded { interpretations, unknown }
    }
}

/// An utterance as a grounder gets it.
#[derive(Clone, Debug, PartialEq)]
pub struct Heard {
    /// Its number.
    pub seq: u64,
    /// Wordings with their weights, likeliest first; none for a gesture without words.
    pub hypotheses: Vec<Hypothesis>,
    /// Questions that it may answer, newest first. One about another scene is [`Question::None`].
    pub questions: Vec<Question>,
    /// The point that the user pointed at, metres, frame `base`.
    pub gesture_m: Option<[f64; 3]>,
    /// Its origin.
    pub source: Source,
}

/// The meaning of an utterance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grounded {
    /// Readings with their weights; those for the same question sum to 1. At most [`READINGS_MAX`].
    pub interpretations: Vec<Interpretation>,
    /// A word that the scene does not have, about which the robot says so.
    pub unknown: Option<UnknownWord>,
}

impl Heard {
    /// Decodes an utterance.
    ///
    /// # Errors
    /// Counts, spans, weights or codes that make no sense.
    pub fn new(utterance: &Utterance, scene: &Scene) -> Result<Self, WireError> {
        let questions = utterance.asked()?.iter().map(|asked| question(asked, scene));
        Ok(Self {
            seq: utterance.seq,
            hypotheses: utterance.hypotheses()?,
            questions: questions.collect::<Result<_, _>>()?,
            gesture_m: utterance.gesture.target_m()?,
            source: utterance.source.get(),
        })
    }
}

/// The question in this scene; in another scene its numbers mean something else. Objects from perception
/// have numbers that the scene file does not have.
fn question(asked: &AskedQuestion, scene: &Scene) -> Result<Question, WireError> {
    let question = Question::try_from(asked.question)?;
    let has_words = matches!(question, Question::Point(_)) || scene.contains(question);
    let is_known = asked.scene == scene.key() && has_words;
    Ok(if is_known { question } else { Question::None })
}

/// Returns the only reading of a wording.
pub fn certain(reading: Reading) -> Vec<(f64, Reading)> {
    vec![(1.0, reading)]
}

/// Returns the likeliest of the readings of several wordings, each with its weight, equal ones together; their
/// weights sum to 1.
fn together(
    read: impl Iterator<Item = (f64, Vec<(f64, Reading)>)>,
    at_most: usize,
) -> Vec<(f64, Reading)> {
    let mut together: Vec<(f64, Reading)> = Vec::new();
    for (heard, readings) in read {
        for (share, reading) in readings {
            let share = share * heard;
            match together.iter_mut().find(|(_, known)| known.says_the_same(&reading)) {
                Some((weight, known)) => {
                    let part = share / (*weight + share);
                    known.doubt = blend(&known.doubt, &reading.doubt, part);
                    *weight += share;
                }
                None => together.push((share, reading)),
            }
        }
    }
    together.sort_by(|a, b| b.0.total_cmp(&a.0));
    together.truncate(at_most);
    let total: f64 = together.iter().map(|(weight, _)| weight).sum();
    together.iter_mut().for_each(|(weight, _)| *weight /= total);
    together
}

/// The mean of two doubts; `part` is the share of the second.
fn blend(a: &Doubt, b: &Doubt, part: f64) -> Doubt {
    let mean = |a: f64, b: f64| a + part * (b - a);
    let entries = |a: &[f64], b: &[f64]| -> Vec<f64> {
        let entry = |list: &[f64], at: usize| list.get(at).copied().unwrap_or(0.0);
        (0..a.len().max(b.len())).map(|at| mean(entry(a, at), entry(b, at))).collect()
    };
    Doubt {
        base: entries(&a.base, &b.base),
        excluded: entries(&a.excluded, &b.excluded),
        response: mean(a.response, b.response),
    }
}

#[cfg(test)]
mod tests;
