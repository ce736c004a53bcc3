//! Possible meanings of an utterance: each hypothesis as an answer to each question, equal ones
//! together.

use crate::Config;
use messages::{AskedQuestion, Hypothesis, Interpretation, READINGS_MAX, WireError};
use scene::{Doubt, Question, Reading, Role, UnknownWord};

/// The readings of an utterance in case it answers one question, or none.
pub(crate) struct Slot {
    /// The question's place among those that the utterance may answer; none for none.
    pub(crate) place: Option<usize>,
    /// The question; none also where it is of another scene.
    pub(crate) question: Question,
    /// The readings, likeliest first; their weights sum to 1.
    pub(crate) readings: Vec<(f64, Reading)>,
}

impl Slot {
    /// Readings for this question as a message has them.
    pub(crate) fn interpretations(
        &self,
        readings: Vec<(f64, Reading)>,
    ) -> impl Iterator<Item = Interpretation> + use<> {
        let answers = self.place;
        readings.into_iter().map(move |(weight, reading)| Interpretation {
            weight,
            answers,
            reading,
        })
    }
}

/// Most readings for one of so many questions, none counted as one.
pub(crate) fn at_most(slots: usize) -> usize {
    READINGS_MAX / slots
}

/// The readings for each of the questions asked and for none.
pub(crate) fn slots(
    config: &Config,
    heard: &[Hypothesis],
    asked: &[AskedQuestion],
) -> Result<Vec<Slot>, WireError> {
    let at_most = at_most(asked.len() + 1);
    let slot = |place: Option<usize>| {
        let question = place.map_or(Ok(Question::None), |at| question(config, &asked[at]))?;
        Ok(Slot { place, question, readings: readings(config, heard, question, at_most) })
    };
    (0..asked.len()).map(Some).chain([None]).map(slot).collect()
}

/// The question in this scene; in another scene its numbers mean something else. Objects from perception
/// have numbers that the scene file does not have.
fn question(config: &Config, asked: &AskedQuestion) -> Result<Question, WireError> {
    let question = Question::try_from(asked.question)?;
    let has_words = matches!(question, Question::Point(_)) || config.scene.contains(question);
    let is_known = asked.scene == config.scene.key() && has_words;
    Ok(if is_known { question } else { Question::None })
}

/// Returns the likeliest readings if the utterance answers `question`; their weights sum to 1.
fn readings(
    config: &Config,
    heard: &[Hypothesis],
    question: Question,
    at_most: usize,
) -> Vec<(f64, Reading)> {
    let mut together: Vec<(f64, Reading)> = Vec::new();
    for hypothesis in heard {
        let Hypothesis { text, weight: heard, word_confidence } = hypothesis;
        for (share, reading) in config.reader.readings(text, word_confidence, question) {
            let share = share * heard;
            match together.iter_mut().find(|(_, known)| says_the_same(known, &reading)) {
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

/// Equal but for how doubtful they are.
fn says_the_same(a: &Reading, b: &Reading) -> bool {
    let certain = |reading: &Reading| Reading { doubt: Doubt::default(), ..reading.clone() };
    certain(a) == certain(b)
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

/// A word of the best hypothesis that the scene does not have, for the robot's reply: a kind of thing
/// rather than a quality.
pub(crate) fn unknown(config: &Config, best: &Hypothesis) -> Option<UnknownWord> {
    let mut words = config.reader.unknown_words(&best.text);
    let kind = words.iter().position(|word| word.role == Role::Kind);
    (!words.is_empty()).then(|| words.swap_remove(kind.unwrap_or(0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use language::{Language, Reader};
    use scene::{Response, Scene};

    fn config() -> Config {
        let bowls = include_str!("../../../config/scenes/bowls.toml");
        let scene = Scene::from_toml("bowls", bowls).unwrap();
        let reader = Reader::new(&scene, Language::Careful);
        Config { scene, reader, model: None }
    }

    fn heard(text: &str, weight: f64, confidence: &[f32]) -> Hypothesis {
        Hypothesis { weight, word_confidence: confidence.to_vec(), ..Hypothesis::certain(text) }
    }

    #[test]
    fn grounding_merges_hypotheses_with_one_meaning() {
        let config = config();
        let hypotheses = [
            heard("the white bowl", 0.6, &[1.0, 0.5, 1.0]),
            heard("a white ball", 0.3, &[1.0, 0.2, 1.0]),
            heard("white or clear", 0.1, &[]),
        ];
        let meant = readings(&config, &hypotheses, Question::None, 8);
        assert_eq!(meant.len(), 3);
        let (weight, best) = &meant[0];
        assert!((weight - (0.9 + 0.1 / 3.0)).abs() < 1e-12);
        let doubt = (0.6 * 0.5 + 0.3 * 0.8) / (0.9 + 0.1 / 3.0);
        assert!((best.doubt.of_word(0) - doubt).abs() < 1e-6, "{best:?}");
        assert!((meant.iter().map(|(weight, _)| weight).sum::<f64>() - 1.0).abs() < 1e-12);
        assert_eq!(readings(&config, &hypotheses, Question::None, 2).len(), 2);
    }

    #[test]
    fn grounding_reads_answers_about_objects_from_perception() {
        let (config, asked) = (config(), Question::Point(scene::ObjectId(9)));
        for (text, response) in
            [("no", Response::No), ("yes", Response::Yes), ("the white one", Response::None)]
        {
            let (_, reading) = readings(&config, &[heard(text, 1.0, &[])], asked, 8).remove(0);
            assert_eq!(reading.response, response, "{text}");
        }
    }

    #[test]
    fn grounding_doubts_a_hedged_answer() {
        let (config, asked) = (config(), Question::Point(scene::ObjectId(0)));
        let doubt = |text| {
            let (_, reading) = readings(&config, &[heard(text, 1.0, &[])], asked, 8).remove(0);
            assert_eq!(reading.response, Response::Yes);
            reading.doubt.response
        };
        assert!(doubt("yes") == 0.0 && doubt("I think so") > 0.0);
    }
}
