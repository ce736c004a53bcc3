//! The robot's decisions and the progress of its belief.

use crate::fixed::common::WireQuestion;
use crate::schema::wire_struct;
use crate::text::FixedText;
use crate::wire::{Code, wire_codes};
use crate::{ActKind, InteractionId, PickId, WireError, judge};
use iceoryx2::prelude::ZeroCopySend;
use scene::{ObjectId, Question};
use vocabulary::PERSON_BYTES_MAX;

wire_struct! {
    /// The highest utterance that the belief holds. Policy to speech.
    AppliedMark = "AppliedMark" {
        /// `UtteranceSeq`.
        seq: u64,
    }
}

wire_struct! {
    /// An order to forget what was learned about a person. Clients to policy, sent again until
    /// [`PolicyView::forgot`] has its key.
    ///
    /// [`PolicyView::forgot`]: crate::PolicyView::forgot
    Forget = "Forget" {
        /// Made by the client, not 0, kept through its retries.
        key: u64,
        /// Name of the person.
        person: FixedText<PERSON_BYTES_MAX>,
        /// Zero.
        reserved: [u8; 4],
    }
}

wire_codes!(ActKind { Wait = 0, Ask = 1, Say = 2, Pick = 3, Cancel = 4, PutBack = 5, });

wire_struct! {
    /// The policy's standing decision. Policy to speech and arm, sent again until superseded.
    RobotAct = "RobotAct" {
        /// `ActId`.
        act: u64,
        /// [`InteractionId`].
        interaction: u64,
        /// `PromptId` of an `Ask` or `Say`.
        prompt: u64,
        /// Number of times the prompt has been requested: 1, and one more for each repetition.
        presentation: u32,
        /// [`ActKind`].
        kind: Code<ActKind>,
        /// 1 where the question names its object in words alone, as "do you want the blue pen?"
        /// does: the arm does not point at it. Else 0.
        in_words: u8,
        /// Zero.
        reserved: [u8; 2],
        /// The question of an `Ask`; of a `Pick` or `PutBack`, its object: it can be denied; of a `Say`, the object that can be refused or confirmed, if any.
        question: WireQuestion,
        /// [`ObjectId`] of a `Pick` or `PutBack`.
        object: u32,
        /// Attempt of a `Pick` or `PutBack`.
        attempt: u32,
        /// [`scene::Scene::key`] of the scene whose objects and attributes are meant.
        scene_key: u64,
        /// When it was decided.
        decided_ns: u64,
        /// The utterance that it answers, 0 for none.
        utterance: u64,
        /// Text to say.
        text: FixedText<244>,
    }
}

impl RobotAct {
    /// The pick that it orders, if it orders one.
    pub fn pick(&self) -> Option<(PickId, ObjectId)> {
        let object = u16::try_from(self.object).ok()?;
        (self.kind == ActKind::Pick).then_some((self.pick_id(), ObjectId(object)))
    }

    /// The order to put an object back, if it is one.
    pub fn put_back(&self) -> Option<(PickId, ObjectId)> {
        let object = u16::try_from(self.object).ok()?;
        (self.kind == ActKind::PutBack).then_some((self.pick_id(), ObjectId(object)))
    }

    /// The object that the arm points at while it asks.
    pub fn pointed_at(&self) -> Option<ObjectId> {
        match Question::try_from(self.question) {
            Ok(Question::Point(object)) => {
                (self.kind == ActKind::Ask && self.in_words == 0).then_some(object)
            }
            _ => None,
        }
    }

    /// Checks the parts that only the policy knows: its numbers, its question and its text.
    ///
    /// # Errors
    /// A number that nothing counts to, or a question or text that is none.
    pub fn judge(&self) -> Result<(Question, &str), WireError> {
        judge::count("act", self.act)?;
        judge::count("interaction", self.interaction)?;
        judge::count("prompt", self.prompt)?;
        judge::count("utterance", self.utterance)?;
        Ok((Question::try_from(self.question)?, self.text.as_str()?))
    }

    /// The key of the pick that it orders or gives up.
    pub fn pick_id(&self) -> PickId {
        PickId { interaction: InteractionId(self.interaction), attempt: self.attempt }
    }
}
