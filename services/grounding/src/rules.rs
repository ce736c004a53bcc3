//! The rules of `language` as a grounder.

use language::Reader;
use messages::Hypothesis;
use scene::{Question, Reading, Scene, UnknownWord};
use whichone_sdk::grounding::Grounder;

/// Reads by the rules of this reader.
pub(crate) struct Rules<'a>(pub(crate) &'a Reader);

impl Grounder for Rules<'_> {
    fn read(
        &mut self,
        heard: &Hypothesis,
        question: Question,
        _scene: &Scene,
    ) -> Vec<(f64, Reading)> {
        self.0.readings(&heard.text, &heard.word_confidence, question)
    }

    fn unknown(&mut self, best: &Hypothesis, _scene: &Scene) -> Option<UnknownWord> {
        self.0.unknown_word(&best.text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Source;
    use scene::Response;
    use vocabulary::Language;
    use whichone_sdk::grounding::Heard;

    fn scene() -> Scene {
        let bowls = include_str!("../../../config/scenes/bowls.toml");
        Scene::from_toml("bowls", bowls).unwrap()
    }

    fn heard(text: &str, weight: f64, confidence: &[f32]) -> Hypothesis {
        Hypothesis { weight, word_confidence: confidence.to_vec(), ..Hypothesis::certain(text) }
    }

    /// The readings as an answer to the newest of `questions`, or to none without questions.
    fn readings(hypotheses: &[Hypothesis], questions: Vec<Question>) -> Vec<(f64, Reading)> {
        let scene = scene();
        let reader = Reader::new(&scene, Language::Careful);
        let place = (!questions.is_empty()).then_some(0);
        let (hypotheses, source) = (hypotheses.to_vec(), Source::Text);
        let heard = Heard { seq: 1, hypotheses, questions, gesture_m: None, source };
        let grounded = Rules(&reader).ground(&heard, &scene).interpretations.into_iter();
        let of_place = grounded.filter(|one| one.answers == place);
        of_place.map(|one| (one.weight, one.reading)).collect()
    }

    #[test]
    fn grounding_merges_hypotheses_with_one_meaning() {
        let hypotheses = [
            heard("the white bowl", 0.6, &[1.0, 0.5, 1.0]),
            heard("a white ball", 0.3, &[1.0, 0.2, 1.0]),
            heard("white or clear", 0.1, &[]),
        ];
        let meant = readings(&hypotheses, Vec::new());
        assert_eq!(meant.len(), 3);
        let (weight, best) = &meant[0];
        assert!((weight - (0.9 + 0.1 / 3.0)).abs() < 1e-12);
        let doubt = (0.6 * 0.5 + 0.3 * 0.8) / (0.9 + 0.1 / 3.0);
        assert!((best.doubt.of_word(0) - doubt).abs() < 1e-6, "{best:?}");
        assert!((meant.iter().map(|(weight, _)| weight).sum::<f64>() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn grounding_reads_answers_about_objects_from_perception() {
        let asked = Question::Point(scene::ObjectId(9));
        for (text, response) in
            [("no", Response::No), ("yes", Response::Yes), ("the white one", Response::None)]
        {
            let (_, reading) = readings(&[heard(text, 1.0, &[])], vec![asked]).remove(0);
            assert_eq!(reading.response, response, "{text}");
        }
    }

    #[test]
    fn grounding_doubts_a_hedged_answer() {
        let asked = Question::Point(scene::ObjectId(0));
        let doubt = |text| {
            let (_, reading) = readings(&[heard(text, 1.0, &[])], vec![asked]).remove(0);
            assert_eq!(reading.response, Response::Yes);
            reading.doubt.response
        };
        assert!(doubt("yes") == 0.0 && doubt("I think so") > 0.0);
    }
}
