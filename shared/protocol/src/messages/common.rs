//! What several messages share.

use crate::schema::wire_struct;
use crate::wire::{self, WireError};
use iceoryx2::prelude::ZeroCopySend;
use scene::Question;

wire_struct! {
    /// Who sent a message; the user header of every topic.
    Stamp = "Stamp" {
        /// Epoch of the group's journals.
        epoch: u64,
        /// When it was sent.
        sent_ns: u64,
        /// Incarnation of the sender; 0 for a client.
        incarnation: u32,
        /// Zero.
        reserved: u32,
    }
}

wire_struct! {
    /// A [`Question`] on the wire.
    WireQuestion = "Question" {
        /// 0 none, 1 point, 2 attribute, 3 which.
        kind: u16,
        /// The object pointed at.
        object: u16,
        /// The attribute asked about.
        attribute: u16,
        /// The value asked about, its place in the attribute's list.
        value: u16,
    }
}

impl From<Question> for WireQuestion {
    fn from(question: Question) -> Self {
        let (kind, object, attribute, value) = wire::question_codes(question);
        Self { kind, object, attribute, value }
    }
}

impl TryFrom<WireQuestion> for Question {
    type Error = WireError;

    fn try_from(wire: WireQuestion) -> Result<Self, WireError> {
        wire::question_from((wire.kind, wire.object, wire.attribute, wire.value))
    }
}

pub(super) fn checked_weight(weight: f64) -> Result<f64, WireError> {
    if weight.is_finite() && (0.0..=1.0 + 1e-9).contains(&weight) {
        Ok(weight)
    } else {
        Err(WireError::new("weight", weight.to_bits() as u32))
    }
}
