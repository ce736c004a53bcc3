use config::Settings;
use messages::{
    Activity, ArmStatus, Hearing, PolicyView, Presented, Receipt, ReceiptStatus, WireMessage,
    topics,
};
use scene::Scene;

use super::{DialogueView, TableScene};
use crate::Time;
use crate::bus::{Bus, BusError, EncodedReader, PortError, Reader};

/// A prompt and which presentation of it.
pub type PromptId = (u64, u32);

/// Readers of the topics that publish the state of the dialogue.
#[derive(Debug)]
pub struct LatestTopics {
    views: EncodedReader<PolicyView>,
    presented: Reader<Presented>,
    activity: Reader<Activity>,
    hearing: Reader<Hearing>,
    receipts: Reader<Receipt>,
    statuses: Reader<ArmStatus>,
    /// The table's scene, if the objects come from perception.
    table: Option<TableScene>,
}

/// Messages that have arrived since the last poll.
#[derive(Clone, Debug, Default)]
pub struct Arrived {
    /// Receipts of every client's utterances.
    pub receipts: Vec<Receipt>,
    /// Statuses of the arm, with when they were sent.
    pub statuses: Vec<(ArmStatus, Time)>,
    /// Progress of the newest utterance.
    pub activity: Option<Activity>,
    /// The presentation of the robot's latest line.
    pub presented: Option<Presented>,
    /// Quality of the microphone signal.
    pub hearing: Option<Hearing>,
    /// Belief and decision of the policy.
    pub view: Option<PolicyView>,
    /// The scene, if the objects on the table have changed.
    pub scene: Option<Scene>,
}

/// The latest message of every topic.
#[derive(Clone, Debug, Default)]
pub struct Latest {
    /// Belief and decision of the policy.
    pub view: Option<PolicyView>,
    /// The presentation of the robot's latest line.
    pub presented: Presented,
    /// Utterances that are still to be applied.
    pub activity: Option<Activity>,
    /// Quality of the microphone signal.
    pub hearing: Option<Hearing>,
    /// State of the arm.
    pub arm: Option<ArmStatus>,
    /// Highest accepted utterance.
    pub accepted: u64,
}

impl LatestTopics {
    /// Opens the topics of a group with these settings: where objects come from perception, messages are about those
    /// on the table. Returns also the scene to begin with.
    ///
    /// # Errors
    /// A topic of another schema, or no shared memory.
    pub fn open(bus: &Bus, settings: &Settings) -> Result<(Self, Scene), BusError> {
        let file = &settings.scene;
        let perceives = settings.group.perception.enabled;
        let table = perceives.then(|| TableScene::open(bus, file)).transpose()?;
        let scene = table.as_ref().map_or(file, TableScene::scene).clone();
        let topics = Self {
            views: bus.encoded_reader(&topics::VIEW)?,
            presented: bus.reader(&topics::PRESENTED)?,
            activity: bus.reader(&topics::ACTIVITY)?,
            hearing: bus.reader(&topics::HEARING)?,
            receipts: bus.reader(&topics::RECEIPT)?,
            statuses: bus.reader(&topics::STATUS)?,
            table,
        };
        Ok((topics, scene))
    }

    /// Returns the objects on the table, if they come from perception.
    pub fn table(&self) -> Option<&TableScene> {
        self.table.as_ref()
    }

    /// Takes over the scene of a reload. Returns the scene to be shown.
    pub fn set_scene(&mut self, file: Scene) -> Scene {
        let Some(table) = &mut self.table else { return file };
        table.set_file(&file);
        table.scene().clone()
    }

    /// Receives new messages. Pending utterances are read before the view, which is newer.
    pub fn take(&mut self) -> Arrived {
        let mut statuses = Vec::new();
        let receipts = drain(&self.receipts);
        let activity = quiet(self.activity.latest());
        let presented = quiet(self.presented.latest());
        let hearing = quiet(self.hearing.latest());
        let taken = self
            .statuses
            .drain_stamped(|status, stamp| statuses.push((*status, Time(stamp.sent_ns))));
        quiet(taken.map(Some));
        let mut view = quiet(self.views.latest());
        let mut scene = None;
        if let Some(table) = &mut self.table {
            scene = table.take().cloned();
            view = view.and_then(|view| table.view(view));
            statuses.iter_mut().for_each(|(status, _)| *status = table.status(*status));
        }
        Arrived { scene, receipts, statuses, activity, presented, hearing, view }
    }
}

impl Latest {
    /// Applies new messages.
    pub fn update(&mut self, arrived: &Arrived) {
        arrived.receipts.iter().for_each(|receipt| self.on_receipt(receipt));
        self.activity = arrived.activity.or(self.activity);
        self.presented = arrived.presented.unwrap_or(self.presented);
        self.hearing = arrived.hearing.or(self.hearing);
        self.arm = arrived.statuses.last().map(|(status, _)| *status).or(self.arm);
        if let Some(view) = &arrived.view {
            self.view = Some(view.clone());
        }
    }

    /// Applies the receipt of an utterance.
    pub fn on_receipt(&mut self, receipt: &Receipt) {
        if receipt.status == ReceiptStatus::Accepted {
            self.accepted = self.accepted.max(receipt.seq);
        }
    }

    /// Returns whether the view is up to date: no utterance is accepted and not yet applied, and no
    /// sound is still being recognised.
    pub fn is_settled(&self) -> bool {
        let applied = self.view.as_ref().is_some_and(|view| view.applied >= self.accepted);
        applied && self.activity.is_some_and(|activity| activity.pending == 0)
    }

    /// Returns belief and decision for display; `None` until the policy has published.
    pub fn dialogue<'a>(&'a self, scene: &'a Scene) -> Option<DialogueView<'a>> {
        self.view.as_ref().map(|view| DialogueView::new(scene, view, &self.presented))
    }

    /// Returns the question in force, once it has been presented completely.
    pub fn open_question(&self) -> Option<PromptId> {
        self.view.as_ref()?.open_question(&self.presented)
    }

    /// Returns the robot's latest prompt, as shown or as said; 0 for none.
    pub fn prompt(&self) -> messages::PromptId {
        let shown = self.view.as_ref().map_or(0, |view| view.prompt);
        messages::PromptId(shown.max(self.presented.prompt))
    }

    /// Returns the line that is being presented or was presented last, if it is still the robot's
    /// latest.
    pub fn presented_line(&self) -> Option<(PromptId, &str)> {
        let view = self.view.as_ref()?;
        let Presented { prompt, presentation, state, .. } = self.presented;
        let has_begun = state.get().has_begun();
        let latest = has_begun && prompt != 0 && prompt == view.prompt && !view.text.is_empty();
        latest.then_some(((prompt, presentation), view.text.as_str()))
    }
}

/// Receives every pending message of a topic.
pub fn drain<T: WireMessage + Copy>(reader: &Reader<T>) -> Vec<T> {
    let mut all = Vec::new();
    quiet(reader.drain(|message| all.push(*message)).map(Some));
    all
}

/// Ignores a broken connection: the service's next incarnation opens another, and until then there
/// is nothing to receive.
pub fn quiet<T>(result: Result<Option<T>, PortError>) -> Option<T> {
    result.ok().flatten()
}
