use scene::{AttributeId, ObjectId, ValueId};
use vocabulary::{Mode, Params};

use super::*;
use crate::testing::{bowls, uniform};

const ALL: Actions = Actions { mode: Mode::Present, attribute: true, which: true, choice: false };

#[test]
fn what_was_measured_counts_and_the_rest_is_uniform() {
    let model = Model::new(&bowls(), Params::default());
    let none = Durations::default();
    let mut own = uniform(&model, Costs::SECONDS);
    own.attribute[1][0] = 7.5;
    own.point.clear();
    assert_eq!((none.check(&bowls()), own.check(&bowls())), (vec![], vec![]));
    let plain = DecisionProblem::new(&model, Costs::SECONDS, ALL);
    let problem = DecisionProblem { durations: Some(&own), ..plain };
    let dear = Question::Attribute(AttributeId(1), ValueId(0));
    for question in model.questions(ALL) {
        let cost = problem.cost(Action::Ask(question));
        let expected = if question == dear { 7.5 } else { plain.cost(Action::Ask(question)) };
        assert_eq!(cost, expected, "{question:?}");
    }
    assert_eq!(problem.cost(Action::Wait), 1.0);
    assert_eq!(problem.cost(Action::Pick(ObjectId(2))), 0.0);
}

#[test]
fn durations_of_another_scene_are_told() {
    let model = Model::new(&bowls(), Params::default());
    let mut own = uniform(&model, Costs::SECONDS);
    own.point.pop();
    own.attribute[0].push(1.0);
    own.which[2] = 0.0;
    own.pick = vec![f64::NAN; 6];
    let keys: Vec<_> = own.check(&bowls()).into_iter().map(|fault| fault.0).collect();
    assert_eq!(keys, ["attribute", "which", "point", "pick"]);
}

#[test]
fn every_number_is_part_of_the_problems_key() {
    let model = Model::new(&bowls(), Params::default());
    let own = uniform(&model, Costs::SECONDS);
    let key = |own: Option<&Durations>| {
        let plain = DecisionProblem::new(&model, Costs::SECONDS, ALL);
        DecisionProblem { durations: own, ..plain }.key()
    };
    let mut other = own.clone();
    other.point[3] += 1e-9;
    assert_ne!(key(Some(&own)), key(Some(&other)));
    assert_ne!(key(Some(&own)), key(None));
}
