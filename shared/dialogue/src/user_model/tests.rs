use scene::{ObjectId, Question, Reading, Response};
use vocabulary::{Action, Actions, Costs, Rng};

use super::*;
use crate::Answer;
use crate::testing::{bowls, drawn};
use crate::{Belief, DecisionProblem, Model, Step, registry};

fn yes_no(response: Response) -> Reading {
    Reading { response, ..Reading::default() }
}

#[test]
fn nobody_known_answers_as_configured() {
    for epsilon in ERROR_RATES {
        let params = Params { epsilon, ..Params::default() };
        let expected = Person::new(params).params(params);
        assert!((expected.p_l - params.p_l).abs() < 1e-12);
        assert!((0.5..4.0).contains(&(expected.epsilon / epsilon)), "{epsilon}: {expected:?}");
    }
}

/// The joint posterior, by enumeration of objects and error rates.
#[test]
fn the_posterior_is_that_of_the_joint_distribution() {
    let model = Model::new(&bowls(), Params::default());
    let mut rng = Rng::new(21);
    for _ in 0..20 {
        let person = Person::new(model.params());
        let rates = person.error_probabilities();
        let mut joint = Joint::new(Belief::uniform(6), person);
        let mut cells = vec![vec![1.0 / 6.0; 6]; rates.len()];
        for _ in 0..5 {
            let question = Question::Point(rng.below(6).into());
            let reading = yes_no([Response::Yes, Response::No][rng.below(2)]);
            joint.update_mixture(&model, &[(1.0, question, reading.clone())]);
            for (cells, epsilon) in cells.iter_mut().zip(ERROR_RATES) {
                let model = model.with_params(Params { epsilon, ..model.params() });
                let log = crate::log_likelihood(&model, question, &reading);
                cells.iter_mut().zip(log).for_each(|(cell, log)| *cell *= log.exp());
            }
        }
        let total: f64 = cells.iter().zip(&rates).map(|(c, r)| r * c.iter().sum::<f64>()).sum();
        for (j, probability) in joint.person().error_probabilities().into_iter().enumerate() {
            let expected = rates[j] * cells[j].iter().sum::<f64>() / total;
            assert!((probability - expected).abs() < 1e-12, "{probability} {expected}");
        }
        for (i, probability) in joint.belief().probabilities().into_iter().enumerate() {
            let expected: f64 = cells.iter().zip(&rates).map(|(c, r)| r * c[i] / total).sum();
            assert!((probability - expected).abs() < 1e-12, "{probability} {expected}");
        }
    }
}

/// Twenty fetches for one person: the answers show the robot only which object was right in the
/// end.
fn acquaintance(params: Params, seed: u64) -> Person {
    let model = Model::new(&bowls(), Params::default());
    let truth = model.with_params(params);
    let mut person = Person::new(model.params());
    let mut rng = Rng::new(seed);
    for interaction in 0..20 {
        let mut draws = Rng::new(seed * 100 + interaction);
        let wanted = draws.below(6).into();
        let mut joint = Joint::new(Belief::uniform(6), person);
        for _ in 0..8 {
            let question = Question::Point(rng.below(6).into());
            let answer = drawn(&mut draws, &truth, question, wanted);
            joint.person_mut().see_answer(answer != Answer::Silence);
            joint.update_mixture(&model, &[(1.0, question, answer.reading(&model))]);
        }
        person = joint.person().clone();
    }
    person
}

#[test]
fn who_errs_and_who_is_silent_is_noticed() {
    let configured = Params::default();
    for seed in 1..4 {
        let known = |params| acquaintance(params, seed).params(configured);
        let careful = known(configured);
        let careless = known(Params { epsilon: 0.2, ..configured });
        let silent = known(Params { p_l: 0.7, ..configured });
        assert!(careful.epsilon < 0.04, "seed {seed}: {careful:?}");
        assert!((0.12..0.3).contains(&careless.epsilon), "seed {seed}: {careless:?}");
        assert!((0.6..0.8).contains(&silent.p_l), "seed {seed}: {silent:?}");
        assert!(careful.p_l > 0.9, "seed {seed}: {careful:?}");
    }
}

/// Dialogues with people who err in one answer of five: share of right picks.
fn success(planner: &str, seed: u64) -> f64 {
    let model = Model::new(&bowls(), Params::default());
    let truth = model.with_params(Params { epsilon: 0.2, ..model.params() });
    let actions = Actions { which: false, ..Actions::default() };
    let problem = DecisionProblem::new(&model, Costs::SECONDS, actions);
    let mut planner = registry::planner(planner).unwrap();
    let mut person = Person::new(model.params());
    let mut right = 0;
    const DIALOGUES: u64 = 120;
    for interaction in 0..DIALOGUES {
        let mut draws = Rng::new(seed + interaction);
        let wanted = draws.below(6).into();
        let mut joint = Joint::new(Belief::uniform(6), person);
        let picked = (0..60).find_map(|step| {
            let step = Step { interaction, step };
            match planner.decide_with(&problem, &joint, step).action {
                Action::Pick(object) => Some(object),
                Action::Wait => Some(ObjectId(99)),
                Action::Ask(question) => {
                    let answer = drawn(&mut draws, &truth, question, wanted);
                    joint.person_mut().see_answer(answer != Answer::Silence);
                    joint.update_mixture(&model, &[(1.0, question, answer.reading(&model))]);
                    None
                }
            }
        });
        right += u64::from(picked == Some(wanted));
        person = joint.person().clone();
    }
    right as f64 / DIALOGUES as f64
}

/// The planner knows the belief about the person as well.
#[test]
fn people_who_err_are_asked_more() {
    let adaptive = success("information-seeking", 7_000);
    assert!(adaptive > 0.93, "{adaptive}");
}
