//! The robot's questions: `(Q_t, Q_v)` of section 3.3, and the open question of section 7.

use crate::{AttributeId, ObjectId, ValueId};

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
}
