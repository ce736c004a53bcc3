//! Everything that is shown, at one moment.

use messages::WireCode;
use std::collections::VecDeque;

use messages::{ArmStatus, MotionInhibit, PickOutcome, PickPhase, Receipt, ReceiptStatus};
use scene::{Scene, question_to_json};
use serde_json::{Map, Value as Json, json};
use service::Time;
use service::clock;
use service::group::GroupPaths;
use service::status::GroupStatus;

use crate::error::CliError;
use crate::verbs::conversation::{Conversation, Seen};
use crate::verbs::hearing;

/// Lines of the dialogue that are kept.
const LINES_MAX: usize = 6;

/// A group and its dialogue.
pub(super) struct Picture {
    conversation: Conversation,
    /// What the supervisor said last.
    pub(super) status: Option<GroupStatus>,
    /// Who said what, latest last.
    pub(super) said: VecDeque<(Speaker, String)>,
    last_words: Option<(u64, u32)>,
    /// The highest utterance of the time before this.
    before: Option<u64>,
    /// When the looking began.
    began: Time,
}

/// Who said something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Speaker {
    Person,
    Robot,
    /// Somebody, but not to the robot, or so it seemed.
    Unmeant,
}

impl Picture {
    pub(super) fn new(conversation: Conversation) -> Self {
        Self {
            conversation,
            status: None,
            said: VecDeque::new(),
            last_words: None,
            before: None,
            began: clock::now(),
        }
    }

    pub(super) fn paths(&self) -> &GroupPaths {
        self.conversation.paths()
    }

    pub(super) fn scene(&self) -> &Scene {
        self.conversation.scene()
    }

    pub(super) fn seen(&self) -> &Seen {
        self.conversation.seen()
    }

    /// Whether every service has been heard of.
    pub(super) fn is_complete(&self) -> bool {
        let seen = self.seen();
        seen.view.is_some() && seen.activity.is_some() && seen.arm.is_some()
    }

    /// Takes in what has happened.
    pub(super) fn look(&mut self) -> Result<(), CliError> {
        let receipts = self.conversation.look()?;
        if self.before.is_none() {
            self.before = self.seen().view.as_ref().map(|view| view.applied);
        }
        for receipt in receipts {
            self.heard(&receipt);
        }
        let Some((said, text)) = self.seen().words() else { return Ok(()) };
        if self.last_words != Some(said) {
            let text = text.to_owned();
            self.last_words = Some(said);
            self.say(Speaker::Robot, text);
        }
        Ok(())
    }

    fn heard(&mut self, receipt: &Receipt) {
        let Ok(text) = receipt.note.as_str() else { return };
        let is = |status: ReceiptStatus| receipt.status == status.code();
        if is(ReceiptStatus::Accepted) && receipt.seq > self.before.unwrap_or(0) {
            self.say(Speaker::Person, text.to_owned());
        } else if is(ReceiptStatus::NotForMe) && Time(receipt.end_ns) > self.began {
            let text = if text.is_empty() { "(nothing that could be made out)" } else { text };
            self.say(Speaker::Unmeant, format!("heard, not for me: {text}"));
        }
    }

    fn say(&mut self, speaker: Speaker, text: String) {
        if self.said.len() == LINES_MAX {
            self.said.pop_front();
        }
        self.said.push_back((speaker, text));
    }

    /// The picture as JSON.
    pub(super) fn to_json(&self) -> Json {
        let said: Vec<Json> = (self.said.iter())
            .map(|(speaker, text)| {
                let who = match speaker {
                    Speaker::Person => "person",
                    Speaker::Robot => "robot",
                    Speaker::Unmeant => "unmeant",
                };
                json!({ "who": who, "text": text })
            })
            .collect();
        json!({
            "dialogue": dialogue(self.scene(), self.seen()),
            "said": said,
            "hearing": self.seen().hearing.as_ref().map(hearing::to_json),
            "arm": self.seen().arm.map(|arm| arm_to_json(self.scene(), &arm)),
            "group": self.status,
        })
    }
}

fn dialogue(scene: &Scene, seen: &Seen) -> Option<Json> {
    let view = seen.view.as_ref()?;
    let names = scene.objects().iter().map(|object| object.name.clone());
    let belief: Map<String, Json> = names.zip(view.belief.iter().map(|p| Json::from(*p))).collect();
    let question = scene.contains(view.question).then(|| question_to_json(scene, view.question));
    Some(json!({
        "interaction": view.interaction,
        "applied": view.applied,
        "belief": belief,
        "absent": view.absent,
        "person": view.person.map(|(p_l, epsilon)| json!({ "p_l": p_l, "epsilon": epsilon })),
        "decision": view.decision,
        "question": question,
        "text": view.text,
        "value": view.value,
        "planner": view.planner,
        "bounds": view.bounds,
        "alternatives": view.alternatives,
        "questions": view.questions,
        "expected_questions": view.expected_questions,
        "last": view.last.as_ref().map(|last| json!({
            "interaction": last.interaction,
            "object": last.name,
            "outcome": last.outcome,
            "questions": last.questions,
            "seconds": last.seconds,
        })),
    }))
}

fn arm_to_json(scene: &Scene, arm: &ArmStatus) -> Json {
    json!({
        "interaction": arm.interaction,
        "object": (arm.interaction != 0).then(|| object_name(scene, arm.object)).flatten(),
        "phase": PickPhase::from_code(arm.phase).ok(),
        "outcome": PickOutcome::from_code(arm.outcome).ok(),
        "moving": arm.moving != 0,
        "stopped": arm.stopped != 0,
        "hindrance": MotionInhibit::from_code(arm.hindrance).ok(),
        "remaining_s": arm.remaining_s,
    })
}

/// The object's name, if the scene has it.
pub(super) fn object_name(scene: &Scene, object: u32) -> Option<&str> {
    scene.objects().get(object as usize).map(|object| object.name.as_str())
}
