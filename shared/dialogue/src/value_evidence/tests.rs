//! Evidence about values in doubt, compared with sums by hand.

use scene::{ObjectId, Perceived, Scene};
use vocabulary::{Params, Rng};

use super::*;
use crate::testing::{bowls, heard, markers, random_scene, scene, tools};
use crate::{Belief, Posterior};

/// Two objects of which one may be red: asking again reveals no more than a person's error.
#[test]
fn the_same_answer_again_tells_little_more() {
    let file = markers();
    let object = |number: u16, red: f64| Perceived {
        number: ObjectId(number),
        name: format!("it-{number}"),
        classes: vec![("R".to_owned(), 1.0)],
        attributes: vec![(
            "color".to_owned(),
            vec![("red".to_owned(), red), ("blue".to_owned(), 1.0 - red)],
        )],
        xyz: [0.0; 3],
        yaw: 0.0,
        seen_by: Vec::new(),
        taken: false,
    };
    let scene = file.with_objects(&[object(2, 0.8), object(3, 0.2)]);
    let mut model = Model::new(&file, Params::default()).with_objects(&scene);
    let red = Question::Attribute(AttributeId(0), ValueId(0));
    let no = [(1.0, red, heard(&scene, &[], Response::No))];
    let mut belief = Belief::uniform(2);
    let mut said = Vec::new();
    for _ in 0..3 {
        belief.update_mixture(&model, &no);
        model.learn(&no);
        said.push(belief.probability(ObjectId(1)));
    }
    // The joint distribution over object and colour, by hand.
    let epsilon = Params::default().epsilon;
    let exact = |times: i32| {
        let no = |red: f64| red * epsilon.powi(times) + (1.0 - red) * (1.0 - epsilon).powi(times);
        no(0.2) / (no(0.2) + no(0.8))
    };
    for (times, p) in (1..).zip(said) {
        assert!((p - exact(times)).abs() < 1e-12, "{times}: {p} not {}", exact(times));
    }
}

/// Belief after certain words, compared with the sum over all possible perceptions of the user.
#[test]
fn the_belief_is_the_sum_over_what_the_user_perceives() {
    let seed = 11;
    let mut rng = Rng::new(seed);
    for scene in [bowls(), tools(), random_scene(&mut rng, 7, &[3, 2, 4, 1], 5)] {
        let rate = |k: usize| 0.02 + 0.01 * k as f64;
        let rates: Vec<f64> = (0..scene.attributes().len()).map(rate).collect();
        let plain = Model::new(&scene, Params::default());
        let model = plain.clone().with_misperceptions(&rates);
        let mut posterior = Posterior::new(Belief::uniform(model.objects()), None).of_perceived();
        let mut heard = Vec::new();
        for _ in 0..12 {
            let reading = random_reading(&mut rng, &scene, &model);
            posterior.update_mixture(&model, std::slice::from_ref(&reading));
            heard.push(reading);
            let expected = by_hand(&model, &rates, &heard);
            for (i, expected) in expected.into_iter().enumerate() {
                let got = posterior.belief().probability(i.into());
                assert!((got - expected).abs() < 1e-12, "seed {seed}: {i}: {got}, {expected}");
            }
        }
    }
}

/// "Tomato ketchup", if the scene gives the ketchup no flavour: it and the tomato soup stay
/// possible, however often it is said.
#[test]
fn an_object_may_be_described_by_what_its_scene_does_not_state() {
    let scene = scene(
        r#"{"objects":[
            {"name":"soup","attributes":{"kind":"soup","flavour":"tomato"}},
            {"name":"jam","attributes":{"kind":"jam","flavour":"strawberry"}},
            {"name":"ketchup","attributes":{"kind":"ketchup"}}],
            "values":{"kind":["soup","jam","ketchup"],"flavour":["tomato","strawberry"]}}"#,
    );
    let model = Model::new(&scene, Params::default()).with_certain_words(1e-4);
    let model = model.with_misperceptions(&[0.004, 0.004]);
    let mut posterior = Posterior::new(Belief::uniform(3), None).of_perceived();
    let said = [(1.0, Question::None, heard(&scene, &["tomato", "ketchup"], Response::None))];
    for _ in 0..3 {
        posterior.update_mixture(&model, &said);
        let [soup, jam, ketchup] =
            [0, 1, 2].map(|i: usize| posterior.belief().probability(i.into()));
        assert!(soup > 0.01 && ketchup > 0.1 && jam < 0.01, "{soup} {jam} {ketchup}");
    }
}

/// An answer, some with a further word, a request, or a denial.
fn random_reading(rng: &mut Rng, scene: &Scene, model: &Model) -> (f64, Question, Reading) {
    let k = AttributeId::from(rng.below(scene.attributes().len()));
    let v = ValueId::from(rng.below(model.values(k)));
    let word = model.word(k, v);
    let response = [Response::Yes, Response::No, Response::None][rng.below(3)];
    let base = if rng.below(2) == 0 { vec![word] } else { vec![] };
    let excluded = if rng.below(3) == 0 { vec![vec![word]] } else { vec![] };
    let question = [Question::Attribute(k, v), Question::Which(k), Question::None][rng.below(3)];
    (1.0, question, Reading { base, excluded, response, ..Reading::default() })
}

/// `P(D | heard)`, attribute by attribute over all that the user may take the value for. An object
/// of that value alone says how likely a reading is.
fn by_hand(model: &Model, rates: &[f64], heard: &[(f64, Question, Reading)]) -> Vec<f64> {
    let params = model.params();
    let of = |i: usize| -> f64 {
        let object = ObjectId::from(i);
        let words: f64 = (0..model.attributes())
            .filter(|k| model.value(object, (*k).into()).is_some())
            .count() as f64;
        let all: f64 = (0..model.attributes()).map(|k| model.values(k.into()) as f64).sum();
        let one = |k: usize, m: Option<usize>| -> f64 {
            let each = heard.iter().map(|(_, question, reading)| {
                let is = |word: WordId| m.is_some_and(|m| model.word(k.into(), m.into()) == word);
                let about = |word: WordId| model.meanings(word)[0].0.index() == k;
                let mut p = 1.0;
                for &word in reading.base.iter().filter(|word| about(**word)) {
                    p *= if *question == Question::Which(k.into()) {
                        let n = model.values(k.into()) as f64;
                        let wrong = params.epsilon / (n - 1.0).max(1.0);
                        let own = if n < 2.0 { 1.0 } else { 1.0 - params.epsilon };
                        if m.is_none() {
                            1.0 / n
                        } else if is(word) {
                            own
                        } else {
                            wrong
                        }
                    } else {
                        let own = f64::from(u8::from(is(word)));
                        (own + params.alpha) / (words + params.alpha * all)
                    };
                }
                for group in reading.excluded.iter().filter(|group| about(group[0])) {
                    p *= if is(group[0]) { params.epsilon } else { 1.0 - params.epsilon };
                }
                if let Question::Attribute(asked, v) = question
                    && asked.index() == k
                    && reading.response != Response::None
                {
                    let right = (m == Some(v.index())) == (reading.response == Response::Yes);
                    p *= if right { 1.0 - params.epsilon } else { params.epsilon };
                }
                p
            });
            each.product()
        };
        let attribute = |k: usize| -> f64 {
            let n = model.values(k.into());
            let own = model.value(object, k.into()).map(ValueId::index);
            if n < 2 {
                return one(k, own);
            }
            let others = if own.is_some() { n - 1 } else { n };
            let chance = |m: Option<usize>| {
                if m == own { 1.0 - rates[k] } else { rates[k] / others as f64 }
            };
            let lacks = own.map_or_else(|| chance(None) * one(k, None), |_| 0.0);
            (0..n).map(|m| chance(Some(m)) * one(k, Some(m))).sum::<f64>() + lacks
        };
        (0..model.attributes()).map(attribute).product()
    };
    let all: Vec<f64> = (0..model.objects()).map(of).collect();
    let sum: f64 = all.iter().sum();
    all.into_iter().map(|p| p / sum).collect()
}
