use dialogue::{Actions, Answer, Costs, DecisionProblem, Mode, Model, Params, Rng};
use scene::{ObjectId, Question, Scene};
use serde_json::json;

use super::*;

fn scene(text: &str) -> Scene {
    let json = serde_json::from_str(text).unwrap();
    Scene::from_json("test", &json).unwrap_or_else(|problems| panic!("{problems:?}"))
}

fn bowls() -> Scene {
    scene(include_str!("../../../tests/fixtures/scenes/bowls.json"))
}

fn tools() -> Scene {
    scene(include_str!("../../../tests/fixtures/scenes/tools.json"))
}

/// Names that are no identifiers, lacking attributes, and a word of two attributes.
fn odd() -> Scene {
    let objects = json!([
        {"name": "T", "attributes": {"uniform": "2 %", "größe": "a b"}},
        {"name": "end", "attributes": {"uniform": "*"}},
        {"name": "1_#:", "attributes": {"größe": "a_b"}},
        {"name": "wanted__T", "attributes": {"uniform": "2 %", "größe": "2 %"}}]);
    let values = json!({"uniform": ["2 %", "*"], "größe": ["a b", "a_b", "2 %"]});
    scene(&json!({"objects": objects, "values": values}).to_string())
}

const ACTIONS: [Actions; 5] = [
    Actions { mode: Mode::Remote, attribute: true, which: true },
    Actions { mode: Mode::Remote, attribute: true, which: false },
    Actions { mode: Mode::Present, attribute: true, which: true },
    Actions { mode: Mode::Present, attribute: false, which: false },
    Actions { mode: Mode::Remote, attribute: false, which: false },
];

fn for_every_problem(check: impl Fn(&Scene, &DecisionProblem<'_>, &Pomdp)) {
    let awkward = Params { p_l: 1.0 / 3.0, epsilon: 1e-17, alpha: 0.2 };
    let huge = Costs { wait_s: 1e-300, correct: 1e300, wrong: 0.1 + 0.2, ..Costs::SECONDS };
    for scene in [bowls(), tools(), odd()] {
        let models = [Params::default(), awkward].map(|params| Model::new(&scene, params));
        let absent = models[0].clone().with_absent();
        for model in models.into_iter().chain([absent]) {
            for actions in ACTIONS {
                for costs in Costs::PRESETS.map(|(_, costs)| costs).into_iter().chain([huge]) {
                    let problem = DecisionProblem::new(&model, costs, actions);
                    check(&scene, &problem, &of_dialogue(&scene, &problem).unwrap());
                }
            }
        }
    }
}

#[test]
fn what_is_written_is_read_back_bit_for_bit() {
    for_every_problem(|_, _, pomdp| {
        let text = pomdp.write("a problem\n# of: \u{7} all\n\n");
        let again = Pomdp::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(again, *pomdp, "{text}");
        assert_eq!(again.write("a problem\n# of:   all\n\n"), text);
    });
}

/// Every number of the POMDP against the dialogue's own definition of it.
#[test]
fn the_pomdp_is_the_problem_that_planners_solve() {
    for_every_problem(|scene, problem, pomdp| {
        let model = problem.model;
        let questions = problem.actions.questions(model);
        let objects = model.objects();
        let end = model.hypotheses();
        assert_eq!(pomdp.states.len(), end + 1);
        assert_eq!(pomdp.actions.len(), 1 + questions.len() + objects);
        assert_eq!((pomdp.start[0], pomdp.start[end]), (1.0 / end as f64, 0.0));
        for state in 0..end {
            let (kind, texts) = unescape(&pomdp.states[state]).unwrap();
            let object = scene.objects().get(state).map(|object| object.name.clone());
            assert_eq!((&*kind == "absent", texts.first()), (object.is_none(), object.as_ref()));
            assert_eq!(pomdp.transition[0].get(state, state), 1.0);
            assert_eq!(pomdp.expected_reward(0, state), -problem.costs.wait_s);
            for (number, question) in questions.iter().enumerate() {
                let action = 1 + number;
                assert_eq!(pomdp.transition[action].get(state, state), 1.0);
                check_answers(model, *question, state, &pomdp.observation[action]);
                let cost = problem.cost(dialogue::Action::Ask(*question));
                let paid = pomdp.expected_reward(action, state);
                assert!((paid + cost).abs() < 1e-12 * cost, "{paid} {cost}");
            }
            for picked in 0..objects {
                let action = 1 + questions.len() + picked;
                assert_eq!(pomdp.transition[action].get(state, end), 1.0);
                let right = picked == state;
                let worth = if right { problem.costs.correct } else { -problem.costs.wrong };
                assert_eq!(pomdp.expected_reward(action, state), worth);
            }
        }
        for action in 0..pomdp.actions.len() {
            assert_eq!(pomdp.transition[action].row(end), &[(end as u32, 1.0)]);
            assert_eq!(pomdp.observation[action].row(end), &[(0, 1.0)]);
            assert_eq!(pomdp.expected_reward(action, end), 0.0);
        }
    });
}

fn check_answers(model: &Model, question: Question, wanted: usize, heard: &Matrix) {
    let mut expected: Vec<f64> = Answer::possible(model, question)
        .iter()
        .map(|answer| answer.probability(model, question, ObjectId::from(wanted)))
        .filter(|p| *p != 0.0)
        .collect();
    let mut found: Vec<f64> = heard.row(wanted).iter().map(|(_, p)| *p).collect();
    expected.sort_by(f64::total_cmp);
    found.sort_by(f64::total_cmp);
    assert_eq!(found, expected, "{question:?}");
}

#[test]
fn names_are_told_apart_and_say_what_they_are() {
    for_every_problem(|_, _, pomdp| {
        for names in [&pomdp.states, &pomdp.actions, &pomdp.observations] {
            let different: std::collections::HashSet<_> = names.iter().collect();
            assert_eq!(different.len(), names.len(), "{names:?}");
        }
    });
    let scene = bowls();
    let model = Model::new(&scene, Params::default());
    let actions = ACTIONS[2];
    let problem = DecisionProblem::new(&model, Costs::SECONDS, actions);
    let pomdp = of_dialogue(&scene, &problem).unwrap();
    for name in ["wait", "is__color__white", "which__size", "point__clear", "pick__metal2"] {
        assert!(pomdp.actions.iter().any(|known| known == name), "{:?}", pomdp.actions);
    }
    assert_eq!(pomdp.observations[..4], ["silence", "yes", "no", "says__color__white"]);
    assert_eq!((&*pomdp.states[0], &*pomdp.states[6]), ("wanted__white", "end"));
}

#[test]
fn a_problem_beyond_the_format_is_refused() {
    let object = |i: usize| json!({"name": i.to_string(), "attributes": {}});
    let objects: Vec<_> = (0..3_000).map(object).collect();
    let text = json!({"objects": objects, "values": {"color": ["red"]}}).to_string();
    let scene = scene(&text);
    let model = Model::new(&scene, Params::default());
    let problem = |actions| DecisionProblem::new(&model, Costs::SECONDS, actions);
    let error = of_dialogue(&scene, &problem(ACTIONS[2])).unwrap_err();
    assert_eq!(error.states, 3_001);
    assert!(error.to_string().contains("too large"), "{error}");
}

/// The format's own example, in all its forms, against the same problem entry by entry.
#[test]
fn every_form_of_the_format_is_read() {
    let tiger = "discount: 0.95 # the tiger\nvalues: reward\nstates: left right\n\
        actions: listen open-left open-right\nobservations: 2\n\n\
        T: listen\nidentity\nT:open-left\nuniform\nT: open-right : *\nreset\n\
        O: *\nuniform\nO: listen\n0.85 0.15\n1.5e-1 .85\n\
        R: listen : * : * : * -1\nR: 1 : left : * : * -100\nR: open-left : right : 0\n10 10\n\
        R: open-left : right : right : * +10\nR: open-right : left\n10. 10 10 10\n\
        R: open-right : 1 : * : * -1e2\n";
    let entries = "discount: 0.95 values: cost observations: 2 actions: listen open-left open-right\
        \nstates: left right start: 0.5 0.5\n\
        T: listen : * : * 0 T: listen : left : left 1 T: listen : right : right 1\n\
        T: 1 : * : * 0.5\nT: 2 : * : left 0.5 T: 2 : * : right 0.5\n\
        O: * : * : * 0.5\nO: 0 : 0 : 0 0.85\nO: 0 : 0 : 1 0.15\nO: 0 : 1\n0.15 0.85\n\
        R: 0 : * : * : * 1\nR: 1 : left : * : * 100\nR: 1 : right : * : * -10\n\
        R: 2 : left : * : * -10\nR: 2 : right : * : * 100\n";
    let (a, b) = (Pomdp::parse(tiger).unwrap(), Pomdp::parse(entries).unwrap());
    assert_eq!(
        (&a.transition, &a.observation, &a.start),
        (&b.transition, &b.observation, &b.start)
    );
    assert_eq!((a.values, b.values), (Values::Reward, Values::Cost));
    assert_eq!((&a.observations, a.discount), (&vec!["0".to_owned(), "1".to_owned()], 0.95));
    for action in 0..3 {
        for state in 0..2 {
            let (paid, cost) = (a.expected_reward(action, state), b.expected_reward(action, state));
            assert!((paid - cost).abs() < 1e-12, "{action} {state}: {paid} {cost}");
        }
    }
    assert_eq!(Pomdp::parse(&a.write("")).unwrap(), a);
}

#[test]
fn every_form_of_a_start_is_read() {
    let start = |line: &str| {
        let text = format!(
            "discount: 1 values: reward states: a b c actions: 1 observations: 1\n{line}\n\
             T: 0 identity O: 0 uniform"
        );
        Pomdp::parse(&text).map(|pomdp| pomdp.start)
    };
    assert_eq!(start("start: 0.25 0.75 0"), Ok(vec![0.25, 0.75, 0.0]));
    assert_eq!(start("start: 0 1 0"), Ok(vec![0.0, 1.0, 0.0]));
    assert_eq!(start("start: 2"), Ok(vec![0.0, 0.0, 1.0]));
    assert_eq!(start("start: b"), Ok(vec![0.0, 1.0, 0.0]));
    assert_eq!(start("start include: a c"), Ok(vec![0.5, 0.0, 0.5]));
    assert_eq!(start("start exclude: 1"), Ok(vec![0.5, 0.0, 0.5]));
    assert_eq!(start("start: uniform"), start(""));
    for wrong in ["start: d", "start: 3", "start: 0.5 0.6 0", "start: 1 0", "start exclude: a b c"]
    {
        assert!(start(wrong).is_err(), "{wrong}");
    }
}

#[test]
fn what_is_wrong_is_told_with_its_line_and_cure() {
    let good = "discount: 0.9\nvalues: reward\nstates: a b\nactions: x\nobservations: o p\n\
                start: uniform\nT: x\nidentity\nO: x\n0.5 0.5\n0.5 0.5\n\nR: x : * : * : * 1\n";
    assert!(Pomdp::parse(good).is_ok());
    let wrong = [
        ("discount: 0.9", "discount: 1.5", 1, "1.5 is not a probability"),
        ("discount: 0.9\n", "", 5, "discount is missing"),
        ("values: reward", "values: joy", 2, "\"joy\" stands where \"reward\" or \"cost\" belongs"),
        ("states: a b", "states: a a", 3, "state \"a\" is there twice"),
        ("states: a b", "states: T b", 3, "belongs"),
        ("states: a b", "states: 0", 3, "0 is no number of states"),
        ("states: a b", "states: 9999999999999999999999", 3, "neither a number nor a name"),
        ("states: a b", "states: a b 2c", 3, "neither a number nor a name"),
        ("actions: x", "actions: x\nactions: x", 5, "actions is there twice"),
        ("observations: o p", "observations: o ü", 5, "no part of the format"),
        ("T: x\n", "T: y\n", 7, "there is no action \"y\""),
        ("T: x\n", "T x\n", 7, "where \":\" belongs"),
        ("identity", "1 0 0", 9, "\"O\" stands where a number belongs"),
        ("identity", "1 0 0 1 0", 8, "stands where T, O or R belongs"),
        ("identity", "1 0 0 -1", 8, "-1 is not a probability"),
        ("identity", "1 0 0 nan", 8, "where a number belongs"),
        ("identity", "1 0 0 1e999", 8, "neither a number"),
        ("identity", "1 0 0.5 0.4", 13, "T: x : b sums to 0.9"),
        ("O: x\n0.5 0.5\n0.5 0.5\n", "O: x : a uniform\n", 11, "O: x : b sums to 0"),
        ("R: x : * : * : * 1", "R: x : * : * : q 1", 13, "there is no observation \"q\""),
        ("R: x : * : * : * 1", "R: x : * : 2 : * 1", 13, "there is no state 2"),
        ("R: x : * : * : * 1", "R: x : * : * : *", 13, "the end of the text stands where a number"),
        ("R: x : * : * : * 1", "Q: x", 13, "\"Q\" stands where T, O or R belongs"),
    ];
    for (part, with, line, what) in wrong {
        let text = good.replacen(part, with, 1);
        let error = Pomdp::parse(&text).unwrap_err();
        assert!(error.what.contains(what), "{with}: {error}");
        assert_eq!(error.line, line, "{with}: {error}");
        assert!(!error.cure.is_empty());
    }
}

/// Whatever a text holds, it is read or refused, and what is read is a problem.
#[test]
fn damaged_texts_are_refused_or_read_as_problems() {
    let scene = odd();
    let model = Model::new(&scene, Params::default());
    let problem = DecisionProblem::new(&model, Costs::SECONDS, ACTIONS[2]);
    let text = of_dialogue(&scene, &problem).unwrap().write("");
    let mut rng = Rng::new(17);
    for seed in 0..400 {
        let mut words: Vec<&str> = text.split(' ').collect();
        for _ in 0..1 + rng.below(3) {
            let (at, from) = (rng.below(words.len()), rng.below(words.len()));
            match rng.below(3) {
                0 => drop(words.remove(at)),
                1 => words[at] = words[from],
                _ => words.insert(at, words[from]),
            }
        }
        if let Ok(pomdp) = Pomdp::parse(&words.join(" ")) {
            assert_eq!(Pomdp::parse(&pomdp.write("")), Ok(pomdp), "damage {seed}");
        }
    }
}
