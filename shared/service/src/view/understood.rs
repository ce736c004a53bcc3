//! The meaning of an utterance in words, weighted by the policy's attribution.

use messages::{Observation, UtteranceSeq};
use scene::Scene;
use serde::{Deserialize, Serialize};
use vocabulary::Attributed;

use crate::journal_record::InterpretationRecord;

/// Most meanings and questions that are shown.
const SHOWN_MAX: usize = 4;
/// Less probable ones are not shown.
const WEIGHT_MIN: f64 = 0.01;

/// The readings of an utterance before its attribution is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    /// The utterance.
    pub seq: UtteranceSeq,
    readings: Vec<WeightedReading>,
}

#[derive(Clone, Debug, PartialEq)]
struct WeightedReading {
    text: String,
    /// Probability among the readings that answer the same question.
    weight: f64,
    /// Prompt and presentation of the question.
    answers: Option<(u64, u32)>,
}

/// The displayed view of an utterance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Understood {
    /// Possible meanings, most likely first.
    pub meanings: Vec<Meaning>,
    /// The questions that it answers, most probable first.
    pub answers: Vec<Answered>,
}

/// One way to understand an utterance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meaning {
    /// Meaning in words: `yes · small · not white`.
    pub text: String,
    /// Its probability.
    pub weight: f64,
}

/// A question that an utterance answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Answered {
    /// Words of the question.
    pub question: String,
    /// Probability that the utterance answers the question.
    pub share: f64,
}

impl Readings {
    /// Reads an observation; `None` if it is of another scene or invalid.
    pub fn of_observation(scene: &Scene, observation: &Observation) -> Option<Self> {
        if observation.scene_key != scene.key() {
            return None;
        }
        let interpretations = observation.interpretations(scene.words().len()).ok()?;
        let asked = observation.asked().ok()?;
        let readings = interpretations.iter().map(|interpretation| WeightedReading {
            text: interpretation.reading.text(scene),
            weight: interpretation.weight,
            answers: (interpretation.answers)
                .and_then(|at| asked.get(at))
                .map(|asked| (asked.prompt, asked.presentation)),
        });
        let seq = UtteranceSeq(observation.seq);
        Some(Self { seq, readings: readings.collect() })
    }

    /// The readings of an utterance in the policy's journal.
    pub fn of_records(utterance: u64, interpretations: &[InterpretationRecord]) -> Self {
        let readings = interpretations.iter().map(|one| WeightedReading {
            text: one.text.clone(),
            weight: one.weight,
            answers: one.answers.map(|answered| (answered.prompt, answered.presentation)),
        });
        Self { seq: UtteranceSeq(utterance), readings: readings.collect() }
    }

    /// Weights the readings by the shares of the questions that they answer, as the belief does.
    /// `line` returns the words of a presentation of a question.
    pub fn attribute(
        &self,
        attributed: &Attributed,
        line: impl Fn(u64, u32) -> Option<String>,
    ) -> Understood {
        let share = |answers: Option<(u64, u32)>| match answers {
            None => attributed.none,
            Some(key) => (attributed.questions.iter())
                .find(|question| (question.prompt.0, question.presentation) == key)
                .map_or(0.0, |question| question.share),
        };
        let mut meanings: Vec<Meaning> = Vec::new();
        for reading in &self.readings {
            let weight = reading.weight * share(reading.answers);
            match meanings.iter_mut().find(|known| known.text == reading.text) {
                Some(known) => known.weight += weight,
                None => meanings.push(Meaning { text: reading.text.clone(), weight }),
            }
        }
        meanings.sort_by(|a, b| b.weight.total_cmp(&a.weight));
        meanings.retain(|meaning| meaning.weight >= WEIGHT_MIN);
        meanings.truncate(SHOWN_MAX);
        meanings.iter_mut().for_each(|meaning| meaning.weight = rounded(meaning.weight));
        let mut shares = attributed.questions.clone();
        shares.sort_by(|a, b| b.share.total_cmp(&a.share));
        let answers = shares.iter().filter(|question| question.share >= WEIGHT_MIN);
        let answers = answers.filter_map(|question| {
            let text = line(question.prompt.0, question.presentation)?;
            Some(Answered { question: text, share: rounded(question.share) })
        });
        Understood { meanings, answers: answers.take(SHOWN_MAX).collect() }
    }
}

fn rounded(weight: f64) -> f64 {
    (weight * 1e3).round() / 1e3
}
