//! Actions of the robot (section 3.2), and the action space.

use scene::{ObjectId, Question};
use serde::{Deserialize, Serialize};

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
    /// Whether choices among values of an attribute are asked.
    pub choice: bool,
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

impl Default for Actions {
    fn default() -> Self {
        Self { mode: Mode::Remote, attribute: true, which: true, choice: false }
    }
}

impl Actions {
    /// Whether the robot may point.
    #[inline]
    pub fn point(&self) -> bool {
        self.mode == Mode::Present
    }

    /// Whether the robot may ask about attributes at all.
    pub fn about_attributes(&self) -> bool {
        self.attribute || self.which || self.choice
    }

    /// Whether the action space holds that action.
    #[inline]
    pub fn allow(&self, action: Action) -> bool {
        match action {
            Action::Wait | Action::Pick(_) => true,
            Action::Ask(Question::None) => false,
            Action::Ask(Question::Point(_)) => self.point(),
            Action::Ask(Question::Attribute(..)) => self.attribute,
            Action::Ask(Question::Which(_)) => self.which,
            Action::Ask(Question::Choice(..)) => self.choice,
        }
    }
}

#[cfg(test)]
mod tests {
    use scene::{AttributeId, ValueId};

    use super::*;

    #[test]
    fn what_is_switched_off_is_not_allowed() {
        let remote = Actions { attribute: false, ..Actions::default() };
        assert!(!remote.allow(Action::Ask(Question::Point(ObjectId(0)))));
        assert!(!remote.allow(Action::Ask(Question::Attribute(AttributeId(0), ValueId(0)))));
        assert!(remote.allow(Action::Ask(Question::Which(AttributeId(0)))));
        let options = scene::Options::new(&[0, 1].map(ValueId)).unwrap();
        let choice = Action::Ask(Question::Choice(AttributeId(0), options));
        assert!(!remote.allow(choice) && Actions { choice: true, ..remote }.allow(choice));
        assert!(remote.allow(Action::Wait) && remote.allow(Action::Pick(ObjectId(5))));
    }

    #[test]
    fn modes_are_written_in_lower_case() {
        assert_eq!(serde_json::to_string(&Mode::Present).unwrap(), r#""present""#);
        assert_eq!(serde_json::from_str::<Mode>(r#""remote""#).unwrap(), Mode::Remote);
    }
}
