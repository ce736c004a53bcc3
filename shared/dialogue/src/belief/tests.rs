use scene::{AttributeId, Question, Response, ValueId, WordId};
use vocabulary::{Params, Rng};

use super::*;
use crate::log_likelihood;
use crate::testing::{bowls, heard, random_scene, scene_of};

/// A random question and reading of the scene; contradictions welcome.
fn random_turn(rng: &mut Rng, model: &Model, words: usize) -> (Question, Reading) {
    let k = AttributeId::from(rng.below(model.attributes()));
    let question = match rng.below(4) {
        0 => Question::None,
        1 => Question::Point(ObjectId::from(rng.below(model.objects()))),
        2 => Question::Attribute(k, ValueId::from(rng.below(model.values(k)))),
        _ => Question::Which(k),
    };
    let response = [Response::Yes, Response::No, Response::None][rng.below(3)];
    let mut draw = |most: usize| -> Vec<WordId> {
        let count = rng.below(most + 1);
        (0..count).map(|_| WordId::from(rng.below(words))).collect()
    };
    let base = draw(3);
    let excluded = vec![draw(2)];
    (question, Reading { base, response, excluded, ..Reading::default() })
}

fn assert_normalised(belief: &Belief) {
    let sum: f64 = belief.probabilities().iter().sum();
    assert!((sum - 1.0).abs() < 1e-11, "sums to {sum}");
    assert!(belief.log_weights().iter().all(|l| l.is_finite() && *l <= 0.0));
}

/// Thousands of contradicting utterances over hundreds of objects.
#[test]
fn nothing_under_or_overflows() {
    let mut rng = Rng::new(41);
    let scene = random_scene(&mut rng, 500, &[4, 3, 2], 7);
    let model = Model::new(&scene, Params::default());
    let turns: Vec<_> =
        (0..40).map(|_| random_turn(&mut rng, &model, scene.words().len())).collect();
    let mut belief = Belief::uniform(500);
    for n in 0..10_000 {
        let (question, reading) = &turns[n % turns.len()];
        belief.update(&model, *question, reading);
        if n % 997 == 0 {
            assert_normalised(&belief);
        }
    }
    assert_normalised(&belief);
    // The weakest object is far below the smallest f64, and still comes back when requested.
    let weakest = (belief.log_weights().iter().enumerate())
        .min_by(|a, b| a.1.total_cmp(b.1))
        .map(|(i, _)| ObjectId::from(i))
        .unwrap();
    assert!(belief.log_weights()[weakest.index()] < -800.0, "{:?}", belief.log_weights());
    let yes = Reading { response: Response::Yes, ..Reading::default() };
    for _ in 0..30_000 {
        belief.update(&model, Question::Point(weakest), &yes);
        if belief.most_likely() == weakest {
            break;
        }
    }
    assert_eq!(belief.most_likely(), weakest);
    assert_normalised(&belief);
}

#[test]
fn the_order_of_utterances_does_not_matter() {
    let mut rng = Rng::new(42);
    let scene = random_scene(&mut rng, 30, &[4, 3, 2], 5);
    let model = Model::new(&scene, Params::default());
    for _ in 0..20 {
        let mut turns: Vec<_> =
            (0..12).map(|_| random_turn(&mut rng, &model, scene.words().len())).collect();
        let fold = |turns: &[(Question, Reading)]| {
            let mut belief = Belief::uniform(30);
            turns.iter().for_each(|(question, reading)| belief.update(&model, *question, reading));
            belief.probabilities()
        };
        let forwards = fold(&turns);
        turns.reverse();
        for (a, b) in forwards.iter().zip(fold(&turns)) {
            assert!((a - b).abs() < 1e-9);
        }
    }
}

/// Renaming the objects renames the belief and changes nothing else.
#[test]
fn the_belief_is_permutation_equivariant() {
    let mut rng = Rng::new(43);
    let scene = random_scene(&mut rng, 9, &[3, 2, 2], 6);
    let mut json = scene.to_json();
    json["objects"].as_array_mut().unwrap().reverse();
    let reversed = scene_of(&json);
    let (model, mirror) =
        (Model::new(&scene, Params::default()), Model::new(&reversed, Params::default()));
    for _ in 0..50 {
        let (question, reading) = random_turn(&mut rng, &model, scene.words().len());
        let mirrored = match question {
            Question::Point(i) => Question::Point(ObjectId::from(8 - i.index())),
            other => other,
        };
        let (mut belief, mut other) = (Belief::uniform(9), Belief::uniform(9));
        belief.update(&model, question, &reading);
        other.update(&mirror, mirrored, &reading);
        for (a, b) in belief.probabilities().iter().zip(other.probabilities().iter().rev()) {
            assert!((a - b).abs() < 1e-14);
        }
    }
}

#[test]
fn repeated_evidence_only_strengthens() {
    let scene = bowls();
    let model = Model::new(&scene, Params::default());
    let size = scene.attribute_named("size").unwrap();
    let big = scene.value_named(size, "big").unwrap();
    let evidence = [
        (Question::None, heard(&scene, &["big"], Response::None)),
        (Question::Attribute(size, big), heard(&scene, &[], Response::Yes)),
        (Question::Which(size), heard(&scene, &["big"], Response::None)),
    ];
    for (question, reading) in evidence {
        let mut belief = Belief::uniform(6);
        let mass = |belief: &Belief| -> f64 {
            (0..6)
                .map(ObjectId::from)
                .filter(|i| scene.has(*i, size, big))
                .map(|i| belief.probability(i))
                .sum()
        };
        for _ in 0..8 {
            let before = mass(&belief);
            belief.update(&model, question, &reading);
            assert!(mass(&belief) > before, "{question:?}");
        }
    }
}

#[test]
fn what_says_nothing_changes_no_bit() {
    let mut rng = Rng::new(44);
    let scene = random_scene(&mut rng, 40, &[5, 3], 4);
    let model = Model::new(&scene, Params::default());
    let prior: Vec<f64> = (0..40).map(|_| rng.uniform()).collect();
    let belief = Belief::from_probabilities(&prior).unwrap();
    let questions = [
        Question::None,
        Question::Point(ObjectId(3)),
        Question::Attribute(AttributeId(0), ValueId(1)),
        Question::Which(AttributeId(1)),
    ];
    for question in questions {
        let mut after = belief.clone();
        after.update(&model, question, &Reading::default());
        assert_eq!(after, belief, "silence after {question:?}");
        after.update_mixture(
            &model,
            &[(0.3, question, Reading::default()), (0.2, Question::None, Reading::default())],
        );
        assert_eq!(after, belief, "silence after {question:?} or nothing");
    }
    for question in [Question::None, Question::Which(AttributeId(1))] {
        let mut after = belief.clone();
        after.update(&model, question, &heard(&scene, &[], Response::Yes));
        assert_eq!(after, belief, "a yes that answers nothing");
    }
}

#[test]
fn a_restored_belief_goes_on_bit_for_bit() {
    let mut rng = Rng::new(45);
    let scene = random_scene(&mut rng, 60, &[5, 3, 2], 4);
    let model = Model::new(&scene, Params::default());
    let mut belief = Belief::uniform(60);
    for _ in 0..200 {
        let (question, reading) = random_turn(&mut rng, &model, scene.words().len());
        let mut restored = Belief::from_log(belief.log_weights().to_vec()).unwrap();
        belief.update(&model, question, &reading);
        restored.update(&model, question, &reading);
        let bits = |b: &Belief| b.log_weights().iter().map(|l| l.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&belief), bits(&restored));
    }
    let text = serde_json::to_string(&belief).unwrap();
    assert_eq!(serde_json::from_str::<Belief>(&text).unwrap(), belief);
}

#[test]
fn a_mixture_is_the_sum_of_its_hypotheses() {
    let mut rng = Rng::new(46);
    let scene = random_scene(&mut rng, 12, &[4, 3], 5);
    let model = Model::new(&scene, Params::default());
    for _ in 0..50 {
        let heard: Vec<_> = (0..3)
            .map(|_| {
                let (question, reading) = random_turn(&mut rng, &model, scene.words().len());
                (rng.uniform(), question, reading)
            })
            .collect();
        let mut expected = vec![0.0; 12];
        for (weight, question, reading) in &heard {
            let likelihood = log_likelihood(&model, *question, reading);
            // Without an answer it is a third of the factor of the words.
            let words = Reading { response: Response::None, ..reading.clone() };
            let open = matches!(question, Question::Which(_));
            let asked = if open { *question } else { Question::None };
            let words = log_likelihood(&model, asked, &words);
            let mean = words.iter().map(|log| log.exp()).sum::<f64>() / 12.0;
            for (sum, log) in expected.iter_mut().zip(likelihood) {
                *sum += weight * log.exp() / mean;
            }
        }
        let expected = Belief::from_probabilities(&expected).unwrap();
        let mut belief = Belief::uniform(12);
        belief.update_mixture(&model, &heard);
        for (a, b) in belief.probabilities().iter().zip(expected.probabilities()) {
            assert!((a - b).abs() < 1e-12);
        }
    }
}

#[test]
fn a_mixture_of_one_is_an_update_and_of_none_is_nothing() {
    let scene = bowls();
    let model = Model::new(&scene, Params::default());
    let reading = heard(&scene, &["white", "counter"], Response::Yes);
    let question = Question::Point(ObjectId(2));
    let (mut one, mut plain) = (Belief::uniform(6), Belief::uniform(6));
    plain.update(&model, question, &reading);
    one.update_mixture(
        &model,
        &[(0.0, Question::None, reading.clone()), (0.4, question, reading.clone())],
    );
    assert_eq!(one, plain);
    one.update_mixture(&model, &[]);
    one.update_mixture(&model, &[(0.0, question, reading)]);
    assert_eq!(one, plain);
}

#[test]
#[should_panic(expected = "is not a weight")]
fn a_mixture_with_one_hypothesis_that_counts_has_its_other_weights_checked() {
    let model = Model::new(&bowls(), Params::default());
    let yes = |weight| (weight, Question::Point(ObjectId(2)), Reading::default());
    Belief::uniform(6).update_mixture(&model, &[yes(0.4), yes(-0.1)]);
}

#[test]
fn zero_stays_zero_and_the_rest_goes_on() {
    let scene = bowls();
    let model = Model::new(&scene, Params::default());
    let mut belief = Belief::from_probabilities(&[0.0, 1.0, 3.0, 0.0, 0.0, 0.0]).unwrap();
    belief.update(&model, Question::Point(ObjectId(0)), &heard(&scene, &["white"], Response::Yes));
    let p = belief.probabilities();
    assert_eq!(p[0], 0.0);
    assert!((p[1] - 0.25).abs() < 1e-15 && (p[2] - 0.75).abs() < 1e-15);
    let restored = Belief::from_log(belief.log_weights().to_vec()).unwrap();
    assert_eq!(restored, belief);
}

#[test]
fn what_is_no_belief_is_refused() {
    use BeliefError::{AllZero, Empty, NotAProbability};
    let from = Belief::from_probabilities;
    assert_eq!(from(&[]), Err(Empty));
    assert_eq!(from(&[0.0, 0.0]), Err(AllZero));
    assert_eq!(from(&[0.5, -0.1]), Err(NotAProbability { index: 1, value: -0.1 }));
    assert!(matches!(from(&[f64::NAN]), Err(NotAProbability { index: 0, .. })));
    assert!(matches!(from(&[1.0, f64::INFINITY]), Err(NotAProbability { index: 1, .. })));
    assert_eq!(Belief::from_log(vec![]), Err(Empty));
    assert!(matches!(Belief::from_log(vec![f64::NAN]), Err(NotAProbability { .. })));
    let never = f64::NEG_INFINITY;
    assert_eq!(Belief::from_log(vec![never, never]), Err(AllZero));
    assert!(serde_json::from_str::<Belief>("[]").is_err());
}

#[test]
fn summaries_of_a_belief() {
    let belief = Belief::uniform(8);
    assert_eq!(belief.most_likely(), ObjectId(0), "the first of equals");
    assert_eq!(belief.len(), 8);
    let sure = Belief::from_probabilities(&[0.0, 7.0]).unwrap();
    assert_eq!(sure.most_likely(), ObjectId(1));
    assert_eq!(sure.probability(ObjectId(1)), 1.0);
}

#[test]
fn beliefs_that_differ_by_rounding_have_one_key() {
    let belief = Belief::from_probabilities(&[0.1, 0.2, 0.7]).unwrap();
    let other = Belief::from_probabilities(&[0.1 + 1e-15, 0.2, 0.7 - 1e-15]).unwrap();
    let third = Belief::from_probabilities(&[0.1 + 1e-9, 0.2, 0.7]).unwrap();
    assert_eq!(belief.key(), other.key());
    assert_ne!(belief.key(), third.key());
    let stands_for = Belief::from_key(&belief.key()).unwrap();
    assert_eq!(stands_for.key(), belief.key());
    assert_eq!(Belief::from_key(&[0, 0]), Err(BeliefError::AllZero));
}
