//! Definitions shared by several messages.

use crate::schema::wire_struct;
use crate::wire::WireError;
use iceoryx2::prelude::ZeroCopySend;
use scene::{AttributeId, ObjectId, Options, Question, ValueId};
use vocabulary::Presentation;
use vocabulary::ids::PromptId;
use vocabulary::time::Time;

wire_struct! {
    /// The sender of a message; the user header of every topic.
    Stamp = "Stamp" {
        /// Epoch of the group's journals.
        epoch: u64,
        /// When it was sent.
        sent_ns: u64,
        /// Incarnation of the sender; 0 for a client.
        incarnation: u32,
        /// Number of the message among those of its writer in this topic, from 1; 0 where the
        /// sender does not count. A reader sees from a gap how many it has lost.
        sequence: u32,
    }
}

wire_struct! {
    /// A [`Question`] on the wire.
    WireQuestion = "Question" {
        /// 0 none, 1 point, 2 attribute, 3 which, 4 choice; the values of a choice, each plus 1, are the bytes of
        /// `object` and `value`, the lower one first, and 0 where there are fewer than four.
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
        let (kind, object, attribute, value) = match question {
            Question::None => (0, 0, 0, 0),
            Question::Point(i) => (1, i.0, 0, 0),
            Question::Attribute(k, v) => (2, 0, k.0, v.0),
            Question::Which(k) => (3, 0, k.0, 0),
            Question::Choice(k, options) => {
                let [first, second] = packed(options);
                (4, first, k.0, second)
            }
        };
        Self { kind, object, attribute, value }
    }
}

fn packed(options: Options) -> [u16; 2] {
    let mut bytes = [0; Options::MAX];
    bytes.iter_mut().zip(options.values()).for_each(|(byte, v)| *byte = v.0 as u8 + 1);
    [u16::from_le_bytes([bytes[0], bytes[1]]), u16::from_le_bytes([bytes[2], bytes[3]])]
}

fn unpacked(packed: [u16; 2]) -> Option<Options> {
    let bytes = packed.into_iter().flat_map(u16::to_le_bytes);
    let used = bytes.filter_map(|byte| byte.checked_sub(1));
    Options::new(&used.map(|v| ValueId(v.into())).collect::<Vec<_>>())
}

/// Whether the scene has the question is for the reader to check.
impl TryFrom<WireQuestion> for Question {
    type Error = WireError;

    fn try_from(wire: WireQuestion) -> Result<Self, WireError> {
        match wire.kind {
            0 => Ok(Self::None),
            1 => Ok(Self::Point(ObjectId(wire.object))),
            2 => Ok(Self::Attribute(AttributeId(wire.attribute), ValueId(wire.value))),
            3 => Ok(Self::Which(AttributeId(wire.attribute))),
            4 => {
                let options = unpacked([wire.object, wire.value]);
                let options = options.ok_or(WireError::new("options", wire.value.into()))?;
                Ok(Self::Choice(AttributeId(wire.attribute), options))
            }
            kind => Err(WireError::new("question kind", kind.into())),
        }
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

/// Greatest coordinate of a pointing gesture, metres; rejects mistyped numbers.
pub const POINTED_AT_MAX_M: f64 = 100.0;

wire_struct! {
    /// A pointing gesture, or none.
    WireGesture = "Gesture" {
        /// The point that the person points at, metres, frame `base`: x, y, z.
        target_m: [f64; 3],
        /// 1 where there is a gesture, else 0.
        present: u8,
        /// Zero.
        reserved: [u8; 7],
    }
}

impl From<Option<[f64; 3]>> for WireGesture {
    fn from(target_m: Option<[f64; 3]>) -> Self {
        let present = u8::from(target_m.is_some());
        Self { target_m: target_m.unwrap_or_default(), present, ..Self::default() }
    }
}

impl WireGesture {
    /// The point indicated by the gesture, metres, frame `base`; `None` without a gesture.
    ///
    /// # Errors
    /// A code or a coordinate that makes no sense.
    pub fn target_m(&self) -> Result<Option<[f64; 3]>, WireError> {
        match self.present {
            0 => Ok(None),
            1 if is_somewhere(&self.target_m) => Ok(Some(self.target_m)),
            1 => Err(WireError::new("pointing target with flag", 1)),
            other => Err(WireError::new("gesture flag", other.into())),
        }
    }
}

/// Returns whether a person can point there: finite, and not farther than [`POINTED_AT_MAX_M`].
pub fn is_somewhere(target_m: &[f64; 3]) -> bool {
    target_m.iter().all(|x| x.abs() <= POINTED_AT_MAX_M)
}

/// The used entries of a list in a fixed layout; `what` names their count in the error.
pub(super) fn used<'a, T>(
    slots: &'a [T],
    count: u8,
    what: &'static str,
) -> Result<&'a [T], WireError> {
    slots.get(..usize::from(count)).ok_or(WireError::new(what, count.into()))
}

/// A number from 0 to 1; `what` names it in the error.
pub(super) fn checked_share(what: &'static str, share: f64) -> Result<f64, WireError> {
    if share.is_finite() && (0.0..=1.0 + 1e-9).contains(&share) {
        Ok(share)
    } else {
        Err(WireError::new(what, (share as f32).to_bits()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gesture_round_trips_and_invalid_targets_are_rejected() {
        for target in [None, Some([0.5, -0.25, 0.0]), Some([100.0, 0.0, -100.0])] {
            assert_eq!(WireGesture::from(target).target_m(), Ok(target));
        }
        for x in [f64::NAN, f64::INFINITY, 100.5] {
            assert!(WireGesture::from(Some([0.0, x, 0.0])).target_m().is_err());
        }
        assert!(WireGesture { present: 2, ..WireGesture::default() }.target_m().is_err());
    }
}
