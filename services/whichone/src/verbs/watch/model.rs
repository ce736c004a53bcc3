//! Model behind `watch`: the latest messages, the lines of the dialogue, and the group's status.

use std::collections::VecDeque;

use messages::{Receipt, ReceiptStatus};
use scene::Scene;
use service::Time;
use service::clock;
use service::group::GroupPaths;
use service::status::GroupStatus;
use service::view::{
    ArmView, DialogueView, HearingView, Latest, PromptId, SaidView, Speaker, View,
};

use crate::verbs::conversation::Conversation;
use service::exit::Failure;

/// Lines of the dialogue that are kept.
const LINES_MAX: usize = 6;

/// A group and its dialogue.
pub(super) struct WatchModel {
    conversation: Conversation,
    /// The supervisor's latest status.
    pub(super) status: Option<GroupStatus>,
    /// The latest lines of the dialogue, oldest first.
    pub(super) said: VecDeque<(Speaker, String)>,
    last_line: Option<PromptId>,
    /// The highest utterance that was applied before this client joined.
    before: Option<u64>,
    /// When this client joined.
    began: Time,
}

impl WatchModel {
    pub(super) fn new(conversation: Conversation) -> Self {
        Self {
            conversation,
            status: None,
            said: VecDeque::new(),
            last_line: None,
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

    pub(super) fn latest(&self) -> &Latest {
        self.conversation.latest()
    }

    /// Returns whether every service has published something.
    pub(super) fn is_complete(&self) -> bool {
        let latest = self.latest();
        latest.view.is_some() && latest.activity.is_some() && latest.arm.is_some()
    }

    /// Takes in what has arrived.
    pub(super) fn look(&mut self) -> Result<(), Failure> {
        let receipts = self.conversation.look()?;
        if self.before.is_none() {
            self.before = self.latest().view.as_ref().map(|view| view.applied);
        }
        for receipt in receipts {
            self.heard(&receipt);
        }
        let Some((said, text)) = self.latest().presented_line() else { return Ok(()) };
        if self.last_line != Some(said) {
            let text = text.to_owned();
            self.last_line = Some(said);
            self.say(Speaker::Robot, text);
        }
        Ok(())
    }

    fn heard(&mut self, receipt: &Receipt) {
        let Ok(text) = receipt.note.as_str() else { return };
        let is = |status: ReceiptStatus| receipt.status == status;
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

    /// Returns the serialisable view.
    pub(super) fn view(&self) -> View<'_, GroupStatus> {
        let (scene, latest) = (self.scene(), self.latest());
        View {
            dialogue: latest.view.as_ref().map(|view| DialogueView::new(scene, view)),
            said: self.said.iter().map(|(who, text)| SaidView { who: *who, text }).collect(),
            hearing: latest.hearing.as_ref().map(HearingView::new),
            arm: latest.arm.as_ref().map(|arm| ArmView::new(scene, arm)),
            group: self.status.as_ref(),
        }
    }
}

/// The object's name, if the scene has it.
pub(super) fn object_name(scene: &Scene, object: u32) -> Option<&str> {
    scene.objects().get(object as usize).map(|object| object.name.as_str())
}
