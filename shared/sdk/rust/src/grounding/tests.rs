use super::observation::check;
use super::*;
use crate::Time;
use messages::{NO_QUESTION, WireGesture};
use scene::{Response, WordId};
use std::iter;

fn scene() -> Scene {
    let bowls = include_str!("../../../../../config/scenes/bowls.toml");
    Scene::from_toml("bowls", bowls).unwrap()
}

/// Spots words of the scene.
struct Spotter;

impl Grounder for Spotter {
    fn read(&mut self, heard: &Hypothesis, _: Question, scene: &Scene) -> Vec<(f64, Reading)> {
        let said =
            heard.text.split(' ').zip(heard.word_confidence.iter().chain(iter::repeat(&1.0)));
        let known =
            said.filter_map(|(word, sure)| Some((scene.word_named(word)?, 1.0 - f64::from(*sure))));
        let (base, doubts) = known.unzip();
        let doubt = Doubt { base: doubts, ..Doubt::default() };
        certain(Reading { base, doubt, ..Reading::default() })
    }
}

fn utterance(hypotheses: &[Hypothesis], asked: &[AskedQuestion]) -> Utterance {
    let mut utterance = Utterance { seq: 7, accepted_ns: 5, ..Utterance::default() };
    utterance.set_hypotheses(hypotheses).unwrap();
    utterance.set_asked(asked);
    utterance
}

fn weighed(text: &str, weight: f64) -> Hypothesis {
    Hypothesis { weight, ..Hypothesis::certain(text) }
}

#[test]
fn each_wording_is_read_for_each_question_and_for_none() {
    let scene = scene();
    let asked = AskedQuestion { scene: scene.key(), ..AskedQuestion::default() };
    let hypotheses =
        [weighed("the white bowl", 0.5), weighed("white ball", 0.3), weighed("clear", 0.2)];
    let utterance = utterance(&hypotheses, &[asked]);
    let observation = observation(&mut Spotter, &scene, &utterance, Time(9)).unwrap();
    assert_eq!((observation.seq, observation.accepted_ns, observation.grounded_ns), (7, 5, 9));
    assert_eq!(observation.scene_key, scene.key());
    let readings = &observation.readings[..usize::from(observation.reading_count)];
    let found: Vec<_> = readings.iter().map(|one| (one.question, one.weight)).collect();
    assert_eq!(found.len(), 4, "equal meanings are together: {found:?}");
    for (place, of_place) in [(0, &found[..2]), (NO_QUESTION, &found[2..])] {
        assert!(of_place.iter().all(|(question, _)| *question == place), "{found:?}");
        assert!((of_place[0].1 - 0.8).abs() < 1e-12 && (of_place[1].1 - 0.2).abs() < 1e-12);
    }
}

#[test]
fn equal_meanings_have_the_doubt_of_both() {
    let sure = |text: &str, weight, word_confidence: &[f32]| Hypothesis {
        word_confidence: word_confidence.to_vec(),
        ..weighed(text, weight)
    };
    let hypotheses = vec![
        sure("the white bowl", 0.6, &[1.0, 0.5, 1.0]),
        sure("a white ball", 0.4, &[1.0, 0.2, 1.0]),
    ];
    let heard =
        Heard { seq: 1, hypotheses, questions: vec![], gesture_m: None, source: Source::Text };
    let found = Spotter.ground(&heard, &scene()).interpretations;
    let [only] = &found[..] else { panic!("{found:?}") };
    assert!((only.reading.doubt.of_word(0) - (0.6 * 0.5 + 0.4 * 0.8)).abs() < 1e-6, "{only:?}");
}

#[test]
fn gesture_without_words_is_one_reading_for_no_question() {
    let gesture: WireGesture = Some([0.5, 0.1, 0.2]).into();
    let utterance = Utterance { gesture, ..utterance(&[], &[]) };
    let observation = observation(&mut Spotter, &scene(), &utterance, Time(9)).unwrap();
    assert_eq!(observation.interpretations(9).unwrap().len(), 1);
}

#[test]
fn questions_about_another_scene_are_none() {
    let asked = |kind| {
        let question = messages::WireQuestion { kind, ..Default::default() };
        AskedQuestion { question, scene: 1, ..AskedQuestion::default() }
    };
    let heard = Heard::new(&utterance(&[weighed("yes", 1.0)], &[asked(1)]), &scene()).unwrap();
    assert_eq!(heard.questions, [Question::None]);
    assert!(Heard::new(&utterance(&[weighed("yes", 1.0)], &[asked(9)]), &scene()).is_err());
}

#[test]
fn answers_that_the_policy_would_refuse_are_found() {
    let scene = scene();
    let heard = Heard::new(&utterance(&[weighed("yes", 1.0)], &[]), &scene).unwrap();
    let with = |weight, reading, answers| Interpretation { weight, answers, reading };
    let grounded = |interpretations| Grounded { interpretations, unknown: None };
    let yes = Reading { response: Response::Yes, ..Reading::default() };
    let unknown_word = Reading { base: vec![WordId(999)], ..Reading::default() };
    let cases = [
        (vec![], "reading"),
        (vec![with(1.0, unknown_word, None)], "word"),
        (vec![with(0.4, yes.clone(), None)], "sum to 1, found 0.4"),
        (vec![with(2.0, yes.clone(), None)], "weight"),
        (vec![with(f64::NAN, yes.clone(), None)], "weight"),
        (vec![with(1.0, yes.clone(), Some(0))], "question"),
    ];
    for (interpretations, reason) in cases {
        let error = check(&grounded(interpretations), &heard, &scene).unwrap_err();
        assert!(error.contains(reason), "{reason}: {error}");
    }
    assert_eq!(check(&grounded(vec![with(1.0, yes, None)]), &heard, &scene), Ok(()));
}
