//! What the robot can do (section 3.2): the action space, and one decision in it.

use scene::{AttributeId, ObjectId, Question, ValueId};
use serde::{Deserialize, Serialize};

use crate::Model;

/// Whether person and robot share the room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// The person cannot see the objects: pointing at one says nothing (section 6).
    #[default]
    Remote,
    /// The person sees the objects and the arm: the robot may point.
    Present,
}

/// The action space: waiting and picking are always there, questions may be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Actions {
    /// Pointing questions are asked in mode `present` only.
    pub mode: Mode,
    /// Whether yes/no questions about attributes are asked.
    pub attribute: bool,
    /// Whether open questions about attributes are asked.
    pub which: bool,
}

/// An action.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Action {
    /// Do nothing for a turn.
    Wait,
    /// Ask.
    Ask(Question),
    /// Fetch the object; this ends the interaction.
    Pick(ObjectId),
}

/// What a planner chose, and what it knows about the choice.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// What to do.
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
    /// Certified lower and upper bound on the value of the best policy, where the planner has
    /// them.
    pub bounds: Option<(f64, f64)>,
}

impl Decision {
    /// Most alternatives that a decision lists.
    pub const ALTERNATIVES_MAX: usize = 16;
}

impl Default for Actions {
    fn default() -> Self {
        Self { mode: Mode::Remote, attribute: true, which: true }
    }
}

impl Actions {
    /// Whether the robot may point.
    pub fn point(&self) -> bool {
        self.mode == Mode::Present
    }

    /// Whether the robot may ask about attributes at all.
    pub fn about_attributes(&self) -> bool {
        self.attribute || self.which
    }

    /// Every question of the action space, useful or not: attribute by attribute the open question
    /// and the yes/no questions, then the objects to point at.
    pub fn questions(&self, model: &Model) -> Vec<Question> {
        let mut questions = Vec::new();
        for k in (0..model.attributes()).map(AttributeId::from) {
            if self.which {
                questions.push(Question::Which(k));
            }
            if self.attribute {
                let values = (0..model.values(k)).map(ValueId::from);
                questions.extend(values.map(|v| Question::Attribute(k, v)));
            }
        }
        if self.point() {
            questions.extend((0..model.objects()).map(|i| Question::Point(i.into())));
        }
        questions
    }

    /// Whether the action space holds that action.
    pub fn allow(&self, action: Action) -> bool {
        match action {
            Action::Wait | Action::Pick(_) => true,
            Action::Ask(Question::None) => false,
            Action::Ask(Question::Point(_)) => self.point(),
            Action::Ask(Question::Attribute(..)) => self.attribute,
            Action::Ask(Question::Which(_)) => self.which,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Params;
    use crate::testing::bowls;

    #[test]
    fn the_action_space_of_the_bowls() {
        let model = Model::new(&bowls(), Params::default());
        let count = |mode, attribute, which| {
            let actions = Actions { mode, attribute, which };
            let questions = actions.questions(&model);
            assert!(questions.iter().all(|q| actions.allow(Action::Ask(*q)) && model.contains(*q)));
            questions.len()
        };
        assert_eq!(count(Mode::Remote, true, true), 5 + 11);
        assert_eq!(count(Mode::Remote, true, false), 11);
        assert_eq!(count(Mode::Present, true, false), 11 + 6);
        assert_eq!(count(Mode::Present, false, false), 6);
        assert_eq!(count(Mode::Remote, false, false), 0);
    }

    #[test]
    fn what_is_switched_off_is_not_allowed() {
        let remote = Actions { attribute: false, ..Actions::default() };
        assert!(!remote.allow(Action::Ask(Question::Point(ObjectId(0)))));
        assert!(!remote.allow(Action::Ask(Question::Attribute(AttributeId(0), ValueId(0)))));
        assert!(remote.allow(Action::Ask(Question::Which(AttributeId(0)))));
        assert!(remote.allow(Action::Wait) && remote.allow(Action::Pick(ObjectId(5))));
    }

    #[test]
    fn modes_are_written_in_lower_case() {
        assert_eq!(serde_json::to_string(&Mode::Present).unwrap(), r#""present""#);
        assert_eq!(serde_json::from_str::<Mode>(r#""remote""#).unwrap(), Mode::Remote);
    }
}
