//! What an utterance may mean: each hypothesis as an answer to each question, equal ones together.

use crate::Config;
use protocol::{AskedQuestion, Hypothesis, Interpretation, READINGS_MAX, WireError};
use scene::{Question, Reading};

/// The interpretations for each of the questions asked and for none, most likely first. Each
/// question's weights sum to 1.
pub(crate) fn interpretations(
    config: &Config,
    heard: &[Hypothesis<'_>],
    asked: &[AskedQuestion],
) -> Result<Vec<Interpretation>, WireError> {
    let at_most = READINGS_MAX / (asked.len() + 1);
    let mut meant = Vec::new();
    for place in (0..asked.len()).map(Some).chain([None]) {
        let question = place.map_or(Ok(Question::None), |at| question(config, &asked[at]))?;
        let readings = readings(config, heard, question, at_most).into_iter();
        meant.extend(readings.map(|(weight, reading)| Interpretation {
            weight,
            question: place,
            reading,
        }));
    }
    Ok(meant)
}

/// The question in this scene; in another scene its numbers mean something else.
fn question(config: &Config, asked: &AskedQuestion) -> Result<Question, WireError> {
    let question = Question::try_from(asked.question)?;
    let is_known = asked.scene == config.scene.key() && config.scene.contains(question);
    Ok(if is_known { question } else { Question::None })
}

/// What was said if it answers `question`: the likeliest readings, whose weights sum to 1.
fn readings(
    config: &Config,
    heard: &[Hypothesis<'_>],
    question: Question,
    at_most: usize,
) -> Vec<(f64, Reading)> {
    let mut together: Vec<(f64, Reading)> = Vec::new();
    for hypothesis in heard {
        let reading = config.reader.read(hypothesis.text, question).reading;
        match together.iter_mut().find(|(_, known)| *known == reading) {
            Some((weight, _)) => *weight += hypothesis.weight,
            None => together.push((hypothesis.weight, reading)),
        }
    }
    together.sort_by(|a, b| b.0.total_cmp(&a.0));
    together.truncate(at_most);
    let total: f64 = together.iter().map(|(weight, _)| weight).sum();
    together.iter_mut().for_each(|(weight, _)| *weight /= total);
    together
}

/// A word of the best hypothesis that the scene does not have, for the robot's reply.
pub(crate) fn unknown(config: &Config, best: &Hypothesis<'_>) -> Option<String> {
    config.reader.read(best.text, Question::None).unknown.into_iter().next()
}
