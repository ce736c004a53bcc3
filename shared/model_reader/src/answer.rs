//! The model's answer, read strictly: answers outside the scene or the agreed form are refused.

use scene::{Intent, Measure, Reading, Reference, Relation, Response, Scene, WordId};
use serde::Deserialize;

/// Most readings of an answer.
const READINGS_MAX: usize = 32;
/// Most values of a description.
const WORDS_MAX: usize = 32;
/// Most excluded groups.
const EXCLUDED_MAX: usize = 8;
/// Most further objects.
const FURTHER_MAX: usize = 4;
/// Most values of a group.
const GROUP_MAX: usize = 6;

/// One reading of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelReading {
    /// Number of the question that the reading answers; `None` for none.
    pub question: Option<usize>,
    /// Weight among the readings for the same question, above 0; not normalised.
    pub weight: f64,
    /// Content of the reading, without doubts.
    pub reading: Reading,
}

/// An answer that is refused, with the reason.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct AnswerError(String);

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Answer {
    readings: Vec<Entry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    question: Option<usize>,
    weight: f64,
    base: Vec<String>,
    excluded: Vec<Vec<String>>,
    response: Response,
    intent: Intent,
    #[serde(default)]
    refers: Reference,
    #[serde(default)]
    further: Vec<Vec<String>>,
}

/// Reads the content of an answer about `scene`. `asked` holds the numbers of the questions that
/// were in the request.
///
/// # Errors
/// The first fault: other text than one JSON object, an unknown or missing key, a value that the
/// scene does not have, an unasked question, a weight of 0 or less, or no readings.
pub fn parse(
    scene: &Scene,
    asked: &[usize],
    content: &str,
) -> Result<Vec<ModelReading>, AnswerError> {
    let answer: Answer = serde_json::from_str(content.trim())
        .map_err(|error| AnswerError(format!("not the agreed JSON: {error}")))?;
    let count = answer.readings.len();
    if !(1..=READINGS_MAX).contains(&count) {
        let what = format!("expected 1 to {READINGS_MAX} readings, found {count}");
        return Err(AnswerError(what));
    }
    answer.readings.into_iter().map(|entry| reading(scene, asked, entry)).collect()
}

fn reading(scene: &Scene, asked: &[usize], entry: Entry) -> Result<ModelReading, AnswerError> {
    let Entry { question, weight, base, excluded, response, intent, refers, further } = entry;
    if let Some(number) = question.filter(|number| !asked.contains(number)) {
        return Err(AnswerError(format!("question {number} was not asked")));
    }
    if !weight.is_finite() || weight <= 0.0 {
        return Err(AnswerError(format!("weight {weight}: expected a number above 0")));
    }
    let reading = Reading {
        base: words(scene, "base", &base, 0..=WORDS_MAX)?,
        response,
        excluded: groups(scene, "excluded", &excluded, EXCLUDED_MAX)?,
        intent,
        refers: related(refers),
        further: groups(scene, "further", &further, FURTHER_MAX)?,
        ..Reading::default()
    };
    Ok(ModelReading { question, weight, reading })
}

/// "the smaller one" as a relation, which is evidence of how objects compare.
fn related(refers: Reference) -> Reference {
    match refers {
        Reference::Smaller => Reference::Relation(Relation::More(Measure::Small)),
        Reference::Larger => Reference::Relation(Relation::More(Measure::Big)),
        Reference::Smallest => Reference::Relation(Relation::Nth(Measure::Small, 1)),
        Reference::Largest => Reference::Relation(Relation::Nth(Measure::Big, 1)),
        refers => refers,
    }
}

fn groups(
    scene: &Scene,
    key: &str,
    groups: &[Vec<String>],
    at_most: usize,
) -> Result<Vec<Vec<WordId>>, AnswerError> {
    if groups.len() > at_most {
        let what = format!("{key}: expected at most {at_most} groups, found {}", groups.len());
        return Err(AnswerError(what));
    }
    groups.iter().map(|group| words(scene, key, group, 1..=GROUP_MAX)).collect()
}

fn words(
    scene: &Scene,
    key: &str,
    words: &[String],
    count: std::ops::RangeInclusive<usize>,
) -> Result<Vec<WordId>, AnswerError> {
    if !count.contains(&words.len()) {
        let (least, most) = (count.start(), count.end());
        let what = format!("{key}: expected {least} to {most} values, found {}", words.len());
        return Err(AnswerError(what));
    }
    let word = |word: &String| {
        scene.word_named(word).ok_or_else(|| {
            let kind = match scene.object_named(word) {
                Some(_) => "an object, expected values",
                None => "not a value of the scene",
            };
            AnswerError(format!("{key}: `{}` is {kind}", word.escape_debug()))
        })
    };
    words.iter().map(word).collect()
}
