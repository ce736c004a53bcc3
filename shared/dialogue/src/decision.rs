//! Decisions of the planners, and the questions that they choose from.

use scene::{AttributeId, Options, Question, ValueId};
use serde::{Deserialize, Serialize};
use vocabulary::{Action, Actions};

use crate::Model;

/// A planner's choice, with its value and bounds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// The chosen action.
    pub action: Action,
    /// Expected discounted return of doing it, in the unit of the costs. Planners that do not look
    /// ahead value a question as if they had to pick after its answer.
    pub value: f64,
    /// The other actions that were weighed, best first, with their values; at most
    /// [`Decision::ALTERNATIVES_MAX`].
    pub alternatives: Vec<(Action, f64)>,
    /// How many questions are still to be expected, this one and repetitions after silence
    /// included.
    pub expected_questions: f64,
    /// Certified lower and upper bound on the value of the best policy, if the planner has them.
    pub bounds: Option<(f64, f64)>,
}

impl Decision {
    /// Most alternatives that a decision lists.
    pub const ALTERNATIVES_MAX: usize = 16;
}

impl Model {
    /// Every question of the action space, useful or not: attribute by attribute the open question,
    /// the yes/no questions and the choices, then the objects to point at. Of an attribute with
    /// many values the choices are those among the values that most objects have.
    pub fn questions(&self, actions: Actions) -> Vec<Question> {
        let mut questions = Vec::new();
        for k in (0..self.attributes()).map(AttributeId::from) {
            if actions.which {
                questions.push(Question::Which(k));
            }
            if actions.attribute {
                let values = (0..self.values(k)).map(ValueId::from);
                questions.extend(values.map(|v| Question::Attribute(k, v)));
            }
            if actions.choice {
                let mut count = vec![0; self.values(k)];
                for entry in self.column(k) {
                    count.get_mut(usize::from(*entry)).into_iter().for_each(|count| *count += 1);
                }
                let mut values: Vec<ValueId> = (0..count.len()).map(ValueId::from).collect();
                values.sort_by_key(|v| std::cmp::Reverse(count[v.index()]));
                questions.extend(choices(&values).map(|options| Question::Choice(k, options)));
            }
        }
        if actions.point() {
            questions.extend((0..self.objects()).map(|i| Question::Point(i.into())));
        }
        questions
    }
}

/// The choices among the first values, the largest first.
pub(crate) fn choices(values: &[ValueId]) -> impl Iterator<Item = Options> {
    let values = values[..values.len().min(Options::MAX)].to_vec();
    let mut subsets: Vec<u32> = (0..1 << values.len()).collect();
    subsets.sort_by_key(|subset| std::cmp::Reverse(subset.count_ones()));
    subsets.into_iter().filter_map(move |subset| {
        let is_in = |at: &usize| subset & (1 << at) != 0;
        let chosen: Vec<ValueId> = (0..values.len()).filter(is_in).map(|at| values[at]).collect();
        Options::new(&chosen)
    })
}

#[cfg(test)]
mod tests {
    use vocabulary::{Mode, Params};

    use super::*;
    use crate::testing::bowls;

    #[test]
    fn the_action_space_of_the_bowls() {
        let model = Model::new(&bowls(), Params::default());
        let count = |mode, attribute, which| {
            let actions = Actions { mode, attribute, which, choice: false };
            let questions = model.questions(actions);
            assert!(questions.iter().all(|q| actions.allow(Action::Ask(*q)) && model.contains(*q)));
            questions.len()
        };
        assert_eq!(count(Mode::Remote, true, true), 5 + 11);
        assert_eq!(count(Mode::Remote, true, false), 11);
        assert_eq!(count(Mode::Present, true, false), 11 + 6);
        assert_eq!(count(Mode::Present, false, false), 6);
        assert_eq!(count(Mode::Remote, false, false), 0);
        let actions = Actions { choice: true, ..Actions::default() };
        let asked = model.questions(actions).into_iter();
        let asked = asked.filter(|question| matches!(question, Question::Choice(..)));
        // Two attributes of three values, two of two, and one of a single value.
        assert_eq!(asked.count(), 4 + 4 + 1 + 1);
    }
}
