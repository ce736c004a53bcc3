//! Definitions shared by several messages.

use crate::schema::wire_struct;
use crate::wire::{self, WireError};
use dialogue::Presentation;
use dialogue::ids::PromptId;
use dialogue::time::Time;
use iceoryx2::prelude::ZeroCopySend;
use scene::Question;

wire_struct! {
    /// The sender of a message; the user header of every topic.
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

wire_struct! {
    /// A question as it was put to the person: one presentation of a prompt.
    AskedQuestion = "AskedQuestion" {
        /// [`crate::PromptId`].
        prompt: u64,
        /// [`scene::Scene::key`] of the scene that it was asked about.
        scene: u64,
        /// When its sound began.
        began_ns: u64,
        /// When its sound ended or was broken off; 0 while it lasts.
        ended_ns: u64,
        /// The question that was asked.
        question: WireQuestion,
        /// Which presentation of the prompt.
        presentation: u32,
        /// 1 where it was said to its end.
        whole: u8,
        /// Zero.
        reserved: [u8; 3],
    }
}

impl From<&Presentation> for AskedQuestion {
    fn from(presentation: &Presentation) -> Self {
        Self {
            prompt: presentation.prompt.0,
            scene: presentation.scene,
            began_ns: presentation.began.ns(),
            ended_ns: presentation.ended.map_or(0, Time::ns),
            question: presentation.question.into(),
            presentation: presentation.number,
            whole: presentation.complete.into(),
            ..Self::default()
        }
    }
}

impl TryFrom<&AskedQuestion> for Presentation {
    type Error = WireError;

    fn try_from(wire: &AskedQuestion) -> Result<Self, WireError> {
        Ok(Self {
            prompt: PromptId(wire.prompt),
            number: wire.presentation,
            question: wire.question.try_into()?,
            scene: wire.scene,
            began: Time(wire.began_ns),
            ended: (wire.ended_ns > 0).then_some(Time(wire.ended_ns)),
            complete: wire.whole != 0,
        })
    }
}

/// A number from 0 to 1; `what` names it in the error.
pub(super) fn checked_share(what: &'static str, share: f64) -> Result<f64, WireError> {
    if share.is_finite() && (0.0..=1.0 + 1e-9).contains(&share) {
        Ok(share)
    } else {
        Err(WireError::new(what, (share as f32).to_bits()))
    }
}
