//! The choices among the questions of a reduced problem.

use scene::Question;
use vocabulary::{Costs, Params};

use super::{CHOOSING, problem};
use crate::planning::Reduced;
use crate::testing::scene_of;
use crate::{Belief, Model};

/// The choices that matter: of all values, or of two of them; a choice of all but one is as
/// informative as the choice of all, and one of two values as a yes/no question.
#[test]
fn choices_that_tell_the_same_are_asked_once() {
    let asked = |values: usize| -> Vec<usize> {
        let list: Vec<_> = (0..values)
            .map(|v| serde_json::json!({"name": format!("o{v}"), "attributes": {"k": format!("v{v}")}}))
            .collect();
        let model = Model::new(&scene_of(&serde_json::json!({"objects": list})), Params::default());
        let problem = problem(&model, CHOOSING, Costs::SECONDS);
        let reduced = Reduced::new(&problem, &Belief::uniform(values));
        let asked = reduced.queries.iter().map(|query| reduced.question(*query));
        let options = asked.filter_map(|question| match question {
            Question::Choice(_, options) => Some(options.values().len()),
            _ => None,
        });
        options.collect()
    };
    assert_eq!(asked(2), Vec::<usize>::new());
    assert_eq!(asked(3), [3]);
    assert_eq!(asked(4), [4, 2, 2, 2, 2, 2, 2]);
    assert_eq!(asked(6), [4, 3, 3, 3, 3, 2, 2, 2, 2, 2, 2]);
}

#[test]
fn questions_that_are_spent_are_not_asked() {
    let model = Model::new(&crate::testing::bowls(), Params::default());
    let plain = problem(&model, CHOOSING, Costs::SECONDS);
    let belief = Belief::uniform(6);
    let asked = |spent: &[Question]| -> Vec<Question> {
        let reduced = Reduced::new(&crate::DecisionProblem { spent, ..plain }, &belief);
        reduced.queries.iter().map(|query| reduced.question(*query)).collect()
    };
    let all = asked(&[]);
    assert!(all.iter().any(|question| matches!(question, Question::Choice(..))));
    for question in &all {
        let offers = |it: &Question| match (*it, *question) {
            (Question::Choice(k, options), Question::Attribute(of, v)) => {
                k == of && options.contains(v)
            }
            _ => false,
        };
        let is_spent = |it: &Question| it == question || offers(it);
        let left = asked(&[*question]);
        assert!(!left.iter().any(is_spent), "{question:?}: {left:?}");
        // Others that tell the same may take its place.
        let others = all.iter().filter(|it| !is_spent(it));
        assert!(others.into_iter().all(|other| left.contains(other)), "{question:?}: {left:?}");
    }
}
