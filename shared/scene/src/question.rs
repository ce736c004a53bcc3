//! The robot's questions: `(Q_t, Q_v)` of section 3.3, extended by open and choice questions.

use crate::{AttributeId, ObjectId, Options, ValueId};

/// A question of the robot's; the observable part of the state.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize,
)]
pub enum Question {
    /// Nothing has been asked yet.
    #[default]
    None,
    /// "This one?", pointing at the object.
    Point(ObjectId),
    /// "Is its k v?": yes or no.
    Attribute(AttributeId, ValueId),
    /// "What is its k?": open.
    Which(AttributeId),
    /// "v, w or x?": which of these values of k.
    Choice(AttributeId, Options),
}

impl Question {
    /// Returns the attribute that the question asks about.
    pub fn attribute(self) -> Option<AttributeId> {
        match self {
            Self::Attribute(k, _) | Self::Which(k) | Self::Choice(k, _) => Some(k),
            Self::None | Self::Point(_) => None,
        }
    }
}
