use scene::ObjectId;
use vocabulary::Params;

use super::*;
use crate::testing::{bowls, everyone, heard, scene};

const P_L: f64 = 0.9;
const EPSILON: f64 = 0.1;
const ALPHA: f64 = 0.5;

fn model(scene: &scene::Scene) -> Model {
    Model::new(scene, Params { p_l: P_L, epsilon: EPSILON, alpha: ALPHA, ..Params::default() })
}

/// Three objects: a red one with a lid, a blue one without, a green one that has no such thing.
fn pots() -> scene::Scene {
    scene(
        r#"{"objects":[
            {"name":"a","attributes":{"color":"red","lid":"lidded"}},
            {"name":"b","attributes":{"color":"blue","lid":"open"}},
            {"name":"c","attributes":{"color":"green"}}],
            "values":{"color":["red","blue","green"],"lid":["lidded","open"]}}"#,
    )
}

fn assert_likelihood(question: Question, words: &[&str], response: Response, expected: [f64; 3]) {
    let scene = pots();
    let got = log_likelihood(&model(&scene), question, &heard(&scene, words, response));
    for (i, (got, expected)) in got.iter().zip(expected).enumerate() {
        let got = got.exp();
        assert!((got - expected).abs() < 1e-14, "object {i}: {got} not {expected}");
    }
}

const COLOR: AttributeId = AttributeId(0);
const LID: AttributeId = AttributeId(1);
const RED: ValueId = ValueId(0);

/// P(w|D) by hand: |V| = 5, so the denominators are 2 + 2.5, 2 + 2.5 and 1 + 2.5.
#[test]
fn base_words_by_hand() {
    let third = 1.0 / 3.0;
    assert_likelihood(Question::None, &[], Response::None, [0.1 * third; 3]);
    let red = [1.5 / 4.5, 0.5 / 4.5, 0.5 / 3.5];
    assert_likelihood(Question::None, &["red"], Response::None, red.map(|p| P_L * p * third));
    let twice = red.map(|p| P_L * p * p * third);
    assert_likelihood(Question::None, &["red", "red"], Response::Yes, twice);
}

#[test]
fn answers_by_hand() {
    let (right, wrong) = (P_L * (1.0 - EPSILON), P_L * EPSILON);
    let silent = 1.0 - P_L;
    let base = 1.0 - P_L;
    let point = Question::Point(ObjectId(1));
    let red = Question::Attribute(COLOR, RED);
    let lidded = Question::Attribute(LID, ValueId(0));
    let times = |p: [f64; 3]| p.map(|p| base * p);
    assert_likelihood(point, &[], Response::Yes, times([wrong, right, wrong]));
    assert_likelihood(point, &[], Response::No, times([right, wrong, right]));
    assert_likelihood(point, &[], Response::None, times([silent; 3]));
    assert_likelihood(red, &[], Response::Yes, times([right, wrong, wrong]));
    assert_likelihood(lidded, &[], Response::No, times([wrong, right, right]));
}

#[test]
fn the_value_answers_an_open_question() {
    let third = 1.0 / 3.0;
    let other = EPSILON / 2.0;
    let which = Question::Which(COLOR);
    let answer = [1.0 - EPSILON, other, other].map(|p| P_L * p * third);
    assert_likelihood(which, &["red"], Response::None, answer);
    assert_likelihood(which, &["red", "red"], Response::None, answer);
    assert_likelihood(which, &["red"], Response::Yes, answer);
    assert_likelihood(which, &[], Response::No, [(1.0 - P_L) * third; 3]);
    // A word of another attribute keeps its own factor next to the answer.
    let lidded = [1.5 / 4.5, 0.5 / 4.5, 0.5 / 3.5];
    let both = [0, 1, 2].map(|i| answer[i] * lidded[i]);
    assert_likelihood(which, &["lidded", "red"], Response::None, both);
    // Two values are not an answer; their words count as any others.
    let red = [1.5 / 4.5, 0.5 / 4.5, 0.5 / 3.5];
    let blue = [0.5 / 4.5, 1.5 / 4.5, 0.5 / 3.5];
    let neither = [0, 1, 2].map(|i| P_L * third * red[i] * blue[i]);
    assert_likelihood(which, &["red", "blue"], Response::None, neither);
}

/// "Red or blue?": "neither" for the green one; "lidded or open?": neither for the green one.
#[test]
fn options_and_neither_answer_a_choice() {
    let third = 1.0 / 3.0;
    let (own, other) = (1.0 - EPSILON, EPSILON / 2.0);
    let options = Options::new(&[0, 1].map(ValueId)).unwrap();
    for k in [COLOR, LID] {
        let choice = Question::Choice(k, options);
        let word = if k == COLOR { "blue" } else { "open" };
        let second = [other, own, other].map(|p| P_L * p);
        let said = second.map(|p| p * third);
        assert_likelihood(choice, &[word], Response::None, said);
        // The named value counts, not the yes or no next to it.
        assert_likelihood(choice, &[word], Response::Yes, said);
        assert_likelihood(choice, &[word], Response::No, second.map(|p| P_L * p));
        let neither = [other, other, own].map(|p| (1.0 - P_L) * P_L * p);
        assert_likelihood(choice, &[], Response::No, neither);
        assert_likelihood(choice, &[], Response::Yes, [(1.0 - P_L) * third; 3]);
    }
    // A value that was not offered counts by its word, and with a "no" twice.
    let green = [0.5 / 4.5, 0.5 / 4.5, 1.5 / 3.5].map(|p| P_L * p);
    let choice = Question::Choice(COLOR, options);
    assert_likelihood(choice, &["green"], Response::None, green.map(|p| p * third));
    let no = [0, 1, 2].map(|i| green[i] * P_L * [other, other, own][i]);
    assert_likelihood(choice, &["green"], Response::No, no);
    // If every object has an option, "none of them" is not an answer.
    let all = Question::Choice(COLOR, Options::new(&[0, 1, 2].map(ValueId)).unwrap());
    assert_likelihood(all, &[], Response::No, [(1.0 - P_L) * P_L; 3]);
}

#[test]
fn an_object_without_the_attribute_may_be_called_anything() {
    let third = 1.0 / 3.0;
    let answer = [1.0 - EPSILON, EPSILON, 0.5].map(|p| P_L * p * third);
    assert_likelihood(Question::Which(LID), &["lidded"], Response::None, answer);
}

/// The answers to an open question and silence exhaust the possibilities.
#[test]
fn open_answers_are_a_distribution() {
    let scene = pots();
    let model = model(&scene);
    for k in [COLOR, LID] {
        let open = Naming::of(&model, Question::Which(k)).unwrap();
        for i in everyone(3) {
            let sum: f64 = (0..model.values(k))
                .map(|v| open.answer(&model, Some(ValueId::from(v)), model.column(k)[i.index()]))
                .sum();
            assert!((sum - 1.0).abs() < 1e-15, "{k:?} {i:?}: {sum}");
        }
    }
}

#[test]
fn a_single_value_cannot_be_confused() {
    let scene = scene(
        r#"{"objects":[{"name":"a","attributes":{"shape":"round"}},{"name":"b","attributes":{}}],
            "values":{"shape":["round"]}}"#,
    );
    let open = Naming::of(&model(&scene), Question::Which(AttributeId(0))).unwrap();
    assert_eq!((open.own, open.lacking), (1.0, 1.0));
    let round = heard(&scene, &["round"], Response::None);
    let log = log_likelihood(&model(&scene), Question::Which(AttributeId(0)), &round);
    assert_eq!(log[0], log[1]);
}

#[test]
fn exclusion_rules_out_what_has_every_word_of_a_group() {
    let scene = bowls();
    let model = model(&scene);
    let word = |name: &str| scene.word_named(name).unwrap();
    let plain = heard(&scene, &[], Response::None);
    let mut reading = plain.clone();
    reading.excluded = vec![vec![word("small"), word("white")], vec![]];
    let (without, with) = (
        log_likelihood(&model, Question::None, &plain),
        log_likelihood(&model, Question::None, &reading),
    );
    for i in everyone(6) {
        let small_white = model.has_word(i, word("small")) && model.has_word(i, word("white"));
        let factor = (with[i.index()] - without[i.index()]).exp();
        let expected = if small_white { EPSILON } else { 1.0 - EPSILON };
        assert!((factor - expected).abs() < 1e-14, "{i:?}");
    }
}

#[test]
#[should_panic(expected = "not about this scene")]
fn a_question_of_another_scene_is_refused() {
    let scene = pots();
    let _ = log_likelihood(&model(&scene), Question::Point(ObjectId(3)), &Reading::default());
}

/// A certain word's odds are `(1 + α) : α` with the `α` of certain words, and the paper's without
/// another one.
#[test]
fn certain_words_have_their_own_smoothing() {
    let scene = bowls();
    let paper = Model::new(&scene, Params::default());
    let same = paper.clone().with_certain_words(paper.params().alpha);
    let model = paper.clone().with_certain_words(0.001);
    for (word, absent) in (0..scene.words().len()).flat_map(|w| [(w, false), (w, true)]) {
        let with = |model: &Model| if absent { model.clone().with_absent() } else { model.clone() };
        let base = vec![WordId::from(word)];
        let likelihood = |model: &Model, doubt: Vec<f64>| {
            let doubt = scene::Doubt { base: doubt, ..scene::Doubt::default() };
            let reading = Reading { base: base.clone(), doubt, ..Reading::default() };
            log_likelihood(&with(model), Question::None, &reading)
        };
        assert_eq!(likelihood(&paper, vec![]), likelihood(&same, vec![]));
        assert_eq!(likelihood(&paper, vec![0.1]), likelihood(&model, vec![0.1]));
        let certain = likelihood(&model, vec![]);
        let has = |i: usize| model.has_word(i.into(), base[0]);
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
            if has(i) && !has(j) {
                let odds = certain[i] - certain[j];
                assert!((odds - 1001_f64.ln()).abs() < 1e-9, "{word} {i} {j}: {odds}");
            }
        }
    }
}

/// Every word and every answer weighs an object by the mixture over its possible values.
#[test]
fn values_in_doubt_are_mixtures() {
    let file = pots();
    let perceived = |number, class: &str, colors: &[(&str, f64)]| scene::Perceived {
        number: ObjectId(number),
        name: format!("{class}-{number}"),
        classes: vec![(class.to_owned(), 1.0)],
        attributes: vec![("color".to_owned(), named(colors))],
        xyz: [0.0; 3],
        yaw: 0.0,
        seen_by: Vec::new(),
        taken: false,
    };
    fn named(colors: &[(&str, f64)]) -> Vec<(String, f64)> {
        colors.iter().map(|(name, p)| ((*name).to_owned(), *p)).collect()
    }
    let table = file.with_objects(&[
        perceived(9, "a", &[("red", 0.7), ("blue", 0.3)]),
        perceived(10, "b", &[("blue", 1.0)]),
    ]);
    let model = model(&file).with_objects(&table);
    let told = |question, words: &[&str], response| {
        let log = log_likelihood(&model, question, &heard(&table, words, response));
        log.into_iter().map(f64::exp).collect::<Vec<_>>()
    };
    let close = |got: Vec<f64>, expected: [f64; 2]| {
        let off = got.iter().zip(expected).any(|(got, expected)| (got - expected).abs() > 1e-14);
        assert!(!off, "{got:?} not {expected:?}");
    };
    let (third, silent, total) = (1.0 / 3.0, 1.0 - P_L, 2.0 + 5.0 * ALPHA);
    let word = |p: f64| P_L * third * (p + ALPHA) / total;
    close(told(Question::None, &["red"], Response::None), [word(0.7), word(0.0)]);
    close(told(Question::None, &["blue"], Response::None), [word(0.3), word(1.0)]);
    let yes = |p: f64| silent * P_L * (p * (1.0 - EPSILON) + (1.0 - p) * EPSILON);
    let red = Question::Attribute(COLOR, RED);
    close(told(red, &[], Response::Yes), [yes(0.7), yes(0.0)]);
    close(told(red, &[], Response::No), [yes(0.3), yes(1.0)]);
    let named = |p: f64| P_L * third * (p * (1.0 - EPSILON) + (1.0 - p) * EPSILON / 2.0);
    close(told(Question::Which(COLOR), &["red"], Response::None), [named(0.7), named(0.0)]);
    let mut not_red = heard(&table, &[], Response::None);
    not_red.excluded = vec![vec![table.word_named("red").unwrap()]];
    let log = log_likelihood(&model, Question::None, &not_red);
    let excluded = |p: f64| silent * third * (p * EPSILON + (1.0 - p) * (1.0 - EPSILON));
    close(log.into_iter().map(f64::exp).collect(), [excluded(0.7), excluded(0.0)]);
}
