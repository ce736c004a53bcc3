use scene::{AttributeId, ObjectId, Question, Scene, ValueId};
use vocabulary::{Actions, Announce, Costs, Durations, Mode, Params, Reliability, Rng};

use super::*;
use crate::testing::{bowls, perceived, random_durations, random_scene, scene, uniform};
use crate::{Answer, Belief, DecisionProblem, Model};

mod announced;
mod bounds;
mod choices;

const REMOTE: Actions = Actions { mode: Mode::Remote, attribute: true, which: true, choice: false };
const PRESENT: Actions =
    Actions { mode: Mode::Present, attribute: true, which: true, choice: false };
const CHOOSING: Actions =
    Actions { mode: Mode::Remote, attribute: true, which: false, choice: true };
const POINTING: Actions =
    Actions { mode: Mode::Present, attribute: false, which: false, choice: false };

fn problem(model: &Model, actions: Actions, costs: Costs) -> DecisionProblem<'_> {
    DecisionProblem::new(model, costs, actions)
}

fn random_belief(rng: &mut Rng, objects: usize) -> Belief {
    // Cubed, so that some beliefs are nearly certain.
    let weights: Vec<f64> = (0..objects).map(|_| rng.uniform().powi(3) + 1e-6).collect();
    Belief::from_probabilities(&weights).unwrap()
}

/// Problems with identical objects, lacking attributes, values that no object has, values in doubt,
/// a possibly absent object, and a cost of its own for every question.
fn for_many_problems(seed: u64, check: impl Fn(&DecisionProblem<'_>, &Belief, &Reduced, &str)) {
    let check = |problem: &DecisionProblem<'_>, belief: &Belief, label: &str| {
        check(problem, belief, &Reduced::new(problem, belief), label);
    };
    let mut rng = Rng::new(seed);
    let mut scenes: Vec<Scene> = vec![bowls()];
    for lacking in [0, 3, 3] {
        scenes.push(random_scene(&mut rng, 7, &[4, 2, 3, 1], lacking));
    }
    for lacking in [0, 3] {
        let scene = random_scene(&mut rng, 5, &[3, 2, 3, 1], lacking);
        scenes.push(perceived(&mut rng, &scene));
    }
    for (n, scene) in scenes.iter().enumerate() {
        let model =
            Model::new(scene, Params { p_l: 0.9, epsilon: 0.05, alpha: 0.2, ..Params::default() });
        let model = if n % 2 == 1 { model.with_absent() } else { model };
        let own = Reliability { p_l: 0.85, epsilon: 0.08 };
        let model = if n % 3 == 1 {
            model.with_params(Params { choice: Some(own), ..model.params() })
        } else {
            model
        };
        let plain = Actions { which: false, ..REMOTE };
        for actions in
            [REMOTE, plain, PRESENT, POINTING, CHOOSING, Actions { choice: true, ..PRESENT }]
        {
            for (name, costs) in Costs::PRESETS {
                for draw in 0..6 {
                    let belief = random_belief(&mut rng, model.hypotheses());
                    let label = format!("seed {seed} scene {n} draw {draw} {name} {actions:?}");
                    let plain = problem(&model, actions, costs);
                    check(&plain, &belief, &label);
                    let own = random_durations(&mut rng, &model, costs);
                    let own = DecisionProblem { durations: Some(&own), ..plain };
                    check(&own, &belief, &format!("{label} own costs"));
                }
            }
        }
    }
}

#[test]
fn doubles_among_the_questions_about_bowls_are_dropped() {
    let model = Model::new(&bowls(), Params::default());
    let belief = Belief::uniform(6);
    let count = |actions| {
        let reduced = Reduced::new(&problem(&model, actions, Costs::SECONDS), &belief);
        (reduced.queries.len(), reduced.pointed.len())
    };
    // Metal is metallic, big is not small, every bowl is round: 7 of 11 yes/no questions are
    // left, and colour and location to ask openly. The clear bowl and the one in the dishwasher
    // are pointed at by a cheaper question.
    assert_eq!(count(REMOTE), (9, 0));
    assert_eq!(count(Actions { which: false, ..REMOTE }), (7, 0));
    assert_eq!(count(PRESENT), (9, 4));
    assert_eq!(count(POINTING), (0, 6));
}

#[test]
fn objects_that_nothing_tells_apart_are_one_class() {
    let scene = scene(
        r#"{"objects":[
            {"name":"a","attributes":{"color":"red"}},{"name":"b","attributes":{"color":"red"}},
            {"name":"c","attributes":{"color":"blue"}},{"name":"d","attributes":{"color":"red"}}]}"#,
    );
    let model = Model::new(&scene, Params::default());
    let belief = Belief::from_probabilities(&[0.1, 0.4, 0.3, 0.2]).unwrap();
    let reduced = Reduced::new(&problem(&model, REMOTE, Costs::SECONDS), &belief);
    assert_eq!(reduced.best, [ObjectId(1), ObjectId(2)]);
    assert!((reduced.mass[0] - 0.7).abs() < 1e-15 && (reduced.share[0] - 4.0 / 7.0).abs() < 1e-15);
    let present = Reduced::new(&problem(&model, PRESENT, Costs::SECONDS), &belief);
    assert_eq!(present.best, [ObjectId(1), ObjectId(3), ObjectId(0), ObjectId(2)]);
    assert_eq!(present.interchangeable.len(), 1);
    assert_eq!(present.interchangeable[0], 0..3);
}

/// Equally probable objects that no question distinguishes are picked by the seconds of the pick,
/// and may be permuted only if pointing at them costs the same.
#[test]
fn objects_that_differ_in_seconds_alone() {
    let scene = scene(
        r#"{"objects":[
            {"name":"a","attributes":{"color":"red"}},{"name":"b","attributes":{"color":"red"}},
            {"name":"c","attributes":{"color":"red"}},{"name":"d","attributes":{"color":"blue"}}]}"#,
    );
    let model = Model::new(&scene, Params::default());
    let belief = Belief::uniform(4);
    let mut own = uniform(&model, Costs::SECONDS);
    own.pick = vec![9.0, 7.0, 8.0, 1.0];
    let remote = problem(&model, REMOTE, Costs::SECONDS);
    let remote = DecisionProblem { durations: Some(&own), ..remote };
    assert_eq!(Reduced::new(&remote, &belief).best, [ObjectId(1), ObjectId(3)]);
    own.point = vec![5.0, 5.0, 6.0, 5.0];
    let present = problem(&model, PRESENT, Costs::SECONDS);
    let present = DecisionProblem { durations: Some(&own), ..present };
    let reduced = Reduced::new(&present, &belief);
    assert_eq!(reduced.best, [ObjectId(1), ObjectId(0), ObjectId(2), ObjectId(3)]);
    assert_eq!((reduced.interchangeable.len(), &reduced.interchangeable[0]), (1, &(0..2)));
    assert!(reduced.interchange(0, 1, &reduced.mass) && !reduced.interchange(1, 2, &reduced.mass));
}

/// Of two questions with the same answers the cheaper one is asked, whichever comes first.
#[test]
fn the_cheapest_of_equal_questions_is_kept() {
    let model = Model::new(&bowls(), Params::default());
    let mut own = uniform(&model, Costs::SECONDS);
    let plain = problem(&model, Actions { which: false, ..REMOTE }, Costs::SECONDS);
    let asked = |own: Option<&Durations>| -> Vec<Question> {
        let problem = DecisionProblem { durations: own, ..plain };
        let reduced = Reduced::new(&problem, &Belief::uniform(6));
        reduced.queries.iter().map(|query| reduced.question(*query)).collect()
    };
    let before = asked(None);
    assert_eq!(asked(Some(&own)), before);
    // "Is it small?" is as informative as "Is it big?".
    let pairs = |k: usize| [0, 1].map(|v| Question::Attribute(k.into(), v.into()));
    let size = (0..5).find(|k| model.values((*k).into()) == 2 && before.contains(&pairs(*k)[0]));
    let [first, second] = pairs(size.unwrap());
    assert!(before.contains(&first) && !before.contains(&second));
    own.attribute[size.unwrap()][1] = 3.0;
    let after = asked(Some(&own));
    assert!(!after.contains(&first) && after.contains(&second), "{after:?}");
    assert_eq!(after.len(), before.len());
}

#[test]
fn negligible_objects_are_left_out() {
    let model = Model::new(&bowls(), Params::default());
    let belief = Belief::from_probabilities(&[0.5, 0.0, 0.5, 1e-12, 1e-12, 0.0]).unwrap();
    let reduced = Reduced::new(&problem(&model, PRESENT, Costs::SECONDS), &belief);
    assert_eq!(reduced.best, [ObjectId(0), ObjectId(2)]);
    assert!((reduced.mass.iter().sum::<f64>() - 1.0).abs() < 1e-15);
}

/// Value of stopping at a belief over all objects.
fn stop_value(problem: &DecisionProblem<'_>, belief: &Belief) -> f64 {
    let pick = problem.costs.pick_value(belief.probability(belief.most_likely()));
    pick.max(problem.costs.wait_value())
}

/// The value of asking until something is heard and then stopping, from the observation model and
/// the belief update alone.
fn ask_once(problem: &DecisionProblem<'_>, belief: &Belief, question: Question) -> f64 {
    let model = problem.model;
    let (mut after, mut unheard) = (0.0, 0.0);
    for answer in Answer::possible(model, question) {
        let probability: f64 = (belief.probabilities().iter().enumerate())
            .map(|(i, p)| p * answer.probability(model, question, i.into()))
            .sum();
        let mut posterior = belief.clone();
        posterior.update(model, question, &answer.reading(model));
        let moved = (belief.probabilities().iter().zip(posterior.probabilities()))
            .any(|(a, b)| (a - b).abs() > 1e-12);
        if moved {
            after += probability * stop_value(problem, &posterior);
        } else {
            unheard += probability;
        }
    }
    let cost = problem.cost(vocabulary::Action::Ask(question));
    let discount = problem.costs.discount;
    (discount * after - cost) / (1.0 - discount * unheard)
}

/// The one-step lookahead works on sums over blocks of merged objects; this works on objects.
#[test]
fn one_step_lookahead_agrees_with_the_observation_model() {
    for_many_problems(71, |problem, belief, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let one_step = OneStepEvaluator::new(reduced, &bound).look_ahead(&reduced.mass);
        assert!((one_step.stop - stop_value(problem, belief)).abs() < 1e-6, "{label}");
        for choice in &one_step.choices {
            let question = reduced.question(choice.query);
            let expected = ask_once(problem, belief, question);
            let got = choice.value.lower;
            assert!((got - expected).abs() < 1e-6, "{label} {question:?}: {got} {expected}");
        }
    });
}

/// Questions that were dropped as doubles or as telling nothing are not better than those kept.
#[test]
fn nothing_better_is_dropped() {
    for_many_problems(72, |problem, belief, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        let one_step = OneStepEvaluator::new(reduced, &bound).look_ahead(&reduced.mass);
        let kept = one_step.choices.iter().map(|choice| choice.value.lower);
        let best = kept.fold(one_step.stop, f64::max);
        for question in problem.model.questions(problem.actions) {
            let model = problem.model;
            let is_held = |k: AttributeId, v: &ValueId| {
                (0..model.objects()).any(|i| model.chance(i.into(), k, *v) > 0.0)
            };
            // A value that no object has is not offered, although it may show an absent object.
            if let Question::Choice(k, options) = question
                && !options.values().iter().all(|v| is_held(k, v))
            {
                continue;
            }
            let value = ask_once(problem, belief, question);
            // An uninformative question is asked for ever here, which is never worth it.
            assert!(value <= best + 1e-6, "{label} {question:?}: {value} above {best}");
        }
    });
}

#[test]
fn outcomes_agree_with_the_one_step_lookahead() {
    for_many_problems(73, |problem, _, reduced, label| {
        let bound = Bound::new(reduced, &problem.costs);
        for choice in OneStepEvaluator::new(reduced, &bound).look_ahead(&reduced.mass).choices {
            let mut total = 0.0;
            let mut left = 0.0;
            for (probability, mass) in outcomes(reduced, choice.query, &reduced.mass) {
                assert!((mass.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{label}");
                total += probability;
                left += probability * entropy(&mass);
            }
            assert!((total - 1.0).abs() < 1e-12, "{label} {:?}: {total}", choice.query);
            let information = (entropy(&reduced.mass) - left).max(0.0);
            assert!((choice.information - information).abs() < 1e-9, "{label} {:?}", choice.query);
        }
    });
}

fn entropy(mass: &[f64]) -> f64 {
    mass.iter().filter(|m| **m > 0.0).map(|m| -m * m.ln()).sum()
}

fn upper(reduced: &Reduced, bound: &Bound, mass: &[f64]) -> f64 {
    OneStepEvaluator::new(reduced, bound).look_ahead(mass).value.upper
}

/// A belief of a reduced problem; the higher the power, the nearer to certainty.
fn random_mass(rng: &mut Rng, reduced: &Reduced, power: i32) -> Vec<f64> {
    let mut mass: Vec<f64> =
        reduced.mass.iter().map(|_| rng.uniform().powi(power) + 1e-15).collect();
    let sum: f64 = mass.iter().sum();
    mass.iter_mut().for_each(|m| *m /= sum);
    mass
}

fn expect_no_better_question(
    reduced: &Reduced,
    bound: &Bound,
    mass: &[f64],
    here: f64,
    label: &str,
) {
    for query in reduced.all_queries() {
        let after: f64 = (outcomes(reduced, query, mass).iter())
            .map(|(p, mass)| p * upper(reduced, bound, mass))
            .sum();
        let asked = reduced.channel(query).price.pay(after);
        assert!(asked <= here + 1e-6, "{label} {query:?}: {asked} above {here}");
    }
}
