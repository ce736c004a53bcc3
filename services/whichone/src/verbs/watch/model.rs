//! Model behind `watch`: the latest messages, the lines of the dialogue, and the group's status.

use messages::Receipt;
use scene::Scene;
use service::clock;
use service::group::GroupPaths;
use service::status::GroupStatus;
use service::view::{ArmView, HearingView, Latest, Lines, View};

use crate::verbs::conversation::Conversation;
use service::exit::Failure;

/// A group and its dialogue.
pub(super) struct WatchModel {
    conversation: Conversation,
    /// The supervisor's latest status.
    pub(super) status: Option<GroupStatus>,
    /// The latest lines of the dialogue.
    pub(super) lines: Lines,
}

impl WatchModel {
    pub(super) fn new(conversation: Conversation) -> Self {
        Self { conversation, status: None, lines: Lines::new(clock::now()) }
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

    /// Takes in what has arrived. Returns the receipts among it.
    pub(super) fn look(&mut self) -> Result<Vec<Receipt>, Failure> {
        let receipts = self.conversation.look()?;
        self.lines.take_in(self.conversation.latest(), &receipts);
        Ok(receipts)
    }

    /// Says something to the robot.
    pub(super) fn say(&mut self, text: &str) -> Result<(), Failure> {
        let seen = self.conversation.latest().prompt();
        self.conversation.say(text, seen)
    }

    /// Returns true if the receipt is for something that was said here.
    pub(super) fn is_own(&self, receipt: &Receipt) -> bool {
        self.conversation.is_own(receipt)
    }

    /// Returns the serialisable view.
    pub(super) fn view(&self) -> View<'_, GroupStatus> {
        let (scene, latest) = (self.scene(), self.latest());
        View {
            dialogue: latest.dialogue(scene),
            said: self.lines.said(),
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
