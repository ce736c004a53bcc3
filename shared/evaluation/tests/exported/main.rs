//! The exported text against the dialogue's own definition of the problem, number by number.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod parser;

use dialogue::{Answer, DecisionProblem, Model};
use evaluation::export::{self, Pomdp};
use scene::{ObjectId, Question, Scene};
use serde_json::json;
use vocabulary::{Action, Actions, Announce, Costs, Mode, Params};

use parser::{Parsed, parse};

fn scene(text: &str) -> Scene {
    let json = serde_json::from_str(text).unwrap();
    Scene::from_json("test", &json).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn bowls() -> Scene {
    scene(include_str!("../../../../tests/fixtures/scenes/bowls.json"))
}

fn tools() -> Scene {
    scene(include_str!("../../../../tests/fixtures/scenes/tools.json"))
}

/// Names that are not identifiers, missing attributes, and a word of two attributes.
fn odd() -> Scene {
    let objects = json!([
        {"name": "T", "attributes": {"uniform": "2 %", "größe": "a b"}},
        {"name": "end", "attributes": {"uniform": "*"}},
        {"name": "1_#:", "attributes": {"größe": "a_b"}},
        {"name": "wanted__T", "attributes": {"uniform": "2 %", "größe": "2 %"}}]);
    let values = json!({"uniform": ["2 %", "*"], "größe": ["a b", "a_b", "2 %"]});
    scene(&json!({"objects": objects, "values": values}).to_string())
}

const ACTIONS: [Actions; 6] = [
    Actions { mode: Mode::Remote, attribute: true, which: true, choice: false },
    Actions { mode: Mode::Remote, attribute: true, which: false, choice: false },
    Actions { mode: Mode::Present, attribute: true, which: true, choice: false },
    Actions { mode: Mode::Present, attribute: false, which: false, choice: false },
    Actions { mode: Mode::Remote, attribute: false, which: false, choice: false },
    Actions { mode: Mode::Remote, attribute: true, which: true, choice: true },
];

fn for_every_problem(check: impl Fn(&Scene, &DecisionProblem<'_>, &Pomdp)) {
    let awkward = Params { p_l: 1.0 / 3.0, epsilon: 1e-17, alpha: 0.2, ..Params::default() };
    let huge = Costs { wait_s: 1e-300, correct: 1e300, wrong: 0.1 + 0.2, ..Costs::SECONDS };
    for scene in [bowls(), tools(), odd()] {
        let models = [Params::default(), awkward].map(|params| Model::new(&scene, params));
        let absent = models[0].clone().with_absent();
        for model in models.into_iter().chain([absent]) {
            for actions in ACTIONS {
                for costs in Costs::PRESETS.map(|(_, costs)| costs).into_iter().chain([huge]) {
                    let problem = DecisionProblem::new(&model, costs, actions);
                    let comment = "a problem\n# of: \u{7} all\n\n";
                    let exported = export::pomdp(&scene, &problem, comment).unwrap();
                    check(&scene, &problem, &exported);
                }
            }
        }
    }
}

#[test]
fn export_is_the_problem_that_planners_solve_bit_for_bit() {
    for_every_problem(|_, problem, exported| {
        let parsed = parse(&exported.text);
        let (model, costs) = (problem.model, problem.costs);
        let questions = model.questions(problem.actions);
        let (objects, end) = (model.objects(), model.hypotheses());
        let sizes = [&parsed.states, &parsed.actions, &parsed.observations].map(Vec::len);
        assert_eq!(sizes, [exported.states, exported.actions, exported.observations]);
        assert_eq!(sizes[..2], [end + 1, 1 + questions.len() + objects]);
        assert_eq!(parsed.discount, costs.discount);
        assert_eq!((parsed.start[0], parsed.start[end]), (1.0 / end as f64, 0.0));
        for state in 0..end {
            assert_eq!(parsed.transition[0][state][state], 1.0);
            assert_eq!(parsed.reward[0][state], -costs.wait_s);
            for (question, action) in questions.iter().zip(1..) {
                assert_eq!(parsed.transition[action][state][state], 1.0);
                check_answers(model, *question, state, &parsed.observation[action]);
                let cost = problem.cost(Action::Ask(*question));
                assert_eq!(parsed.reward[action][state], -cost);
            }
            for (picked, action) in (0..objects).zip(1 + questions.len()..) {
                assert_eq!(parsed.transition[action][state][end], 1.0);
                let worth = if picked == state { costs.correct } else { -costs.wrong };
                assert_eq!(parsed.reward[action][state], worth);
            }
        }
        check_end(&parsed, end);
    });
}

fn check_answers(model: &Model, question: Question, wanted: usize, heard: &[Vec<f64>]) {
    let mut expected: Vec<f64> = Answer::possible(model, question)
        .iter()
        .map(|answer| answer.probability(model, question, ObjectId::from(wanted)))
        .filter(|p| *p != 0.0)
        .collect();
    let mut found: Vec<f64> = heard[wanted].iter().copied().filter(|p| *p != 0.0).collect();
    expected.sort_by(f64::total_cmp);
    found.sort_by(f64::total_cmp);
    assert_eq!(found, expected, "{question:?}");
}

/// Nothing is paid or heard at the end, and nothing leads out of it.
fn check_end(parsed: &Parsed, end: usize) {
    for action in 0..parsed.actions.len() {
        assert_eq!(parsed.transition[action][end][end], 1.0);
        assert_eq!(parsed.observation[action][end][0], 1.0);
        assert_eq!(parsed.reward[action][end], 0.0);
    }
}

/// A pick leads to the end, or is denied and leaves everything as it is.
#[test]
fn denied_picks_are_exported_as_planners_have_them() {
    let announce = Announce { heard: 0.8, cost_s: 7.5 };
    for_every_problem(|scene, problem, before| {
        let problem = DecisionProblem { announce, ..*problem };
        let exported = export::pomdp(scene, &problem, "").unwrap();
        assert_eq!(exported.observations, before.observations + 1);
        let parsed = parse(&exported.text);
        let (model, costs) = (problem.model, problem.costs);
        let (end, denied) = (model.hypotheses(), parsed.observations.len() - 1);
        assert_eq!(parsed.observations[denied], "denied");
        let first = parsed.actions.len() - model.objects();
        let (own, other) = announce.denials(model.params().epsilon);
        for (picked, action) in (0..model.objects()).zip(first..) {
            for state in 0..end {
                let is_wanted = picked == state;
                let d = if is_wanted { own } else { other };
                let reached = &parsed.transition[action][state];
                assert_eq!((reached[end], reached[state]), (1.0 - d, d));
                let worth = if is_wanted { costs.correct } else { -costs.wrong };
                let paid = worth * (1.0 - d) - d * announce.cost_s;
                let off = (parsed.reward[action][state] - paid).abs();
                assert!(off <= 1e-12 * worth.abs().max(1.0), "{paid}");
                assert_eq!(parsed.observation[action][state][denied], 1.0);
            }
        }
        check_end(&parsed, end);
    });
}

#[test]
fn export_names_state_what_they_stand_for() {
    let scene = bowls();
    let model = Model::new(&scene, Params::default());
    let problem = DecisionProblem::new(&model, Costs::SECONDS, ACTIONS[2]);
    let exported = export::pomdp(&scene, &problem, "bowls").unwrap();
    assert!(exported.text.starts_with("# bowls\ndiscount: "), "{}", exported.text);
    let parsed = parse(&exported.text);
    for name in ["wait", "is__color__white", "which__size", "point__clear", "pick__metal2"] {
        assert!(parsed.actions.iter().any(|known| known == name), "{:?}", parsed.actions);
    }
    assert_eq!(parsed.observations[..4], ["silence", "yes", "no", "says__color__white"]);
    assert_eq!((&*parsed.states[0], &*parsed.states[6]), ("wanted__white", "end"));
}

#[test]
fn export_rejects_a_problem_that_is_too_large() {
    let object = |i: usize| json!({"name": i.to_string(), "attributes": {}});
    let objects: Vec<_> = (0..3_000).map(object).collect();
    let text = json!({"objects": objects, "values": {"color": ["red"]}}).to_string();
    let scene = scene(&text);
    let model = Model::new(&scene, Params::default());
    let problem = DecisionProblem::new(&model, Costs::SECONDS, ACTIONS[2]);
    let error = export::pomdp(&scene, &problem, "").unwrap_err();
    assert_eq!(error.states, 3_001);
    assert!(error.to_string().contains("too large"), "{error}");
}
