//! The robot's topics, as heard by its user and as seen by an observer.

use std::collections::BTreeMap;

use messages::{
    ActKind, Activity, EarState, PolicyView, PresentationState, Presented, Receipt, RobotAct,
    topics,
};
use service::bus::{EncodedReader, Reader};
use service::client::Client;

/// A prompt and the number of its presentation.
pub(super) type Said = (u64, u32);

/// Readers of the robot's topics, and the latest of each.
pub(super) struct Taps {
    acts: Reader<RobotAct>,
    presented: Reader<Presented>,
    receipts: Reader<Receipt>,
    activity: Reader<Activity>,
    views: EncodedReader<PolicyView>,
    /// Questions that were decided: their words.
    pub(super) questions: BTreeMap<Said, String>,
    /// True if a pick was ordered.
    pub(super) picks: bool,
    pub(super) view: PolicyView,
    pub(super) ear: Option<EarState>,
}

/// Messages that arrived since the last poll.
#[derive(Default)]
pub(super) struct News {
    /// Questions that have begun to sound, and when.
    pub(super) began: Vec<(Said, u64)>,
    /// Questions that were said to their end, and when.
    pub(super) ended: Vec<(Said, u64)>,
    /// Receipts of utterances.
    pub(super) receipts: Vec<Receipt>,
}

impl Taps {
    /// # Panics
    /// If a topic cannot be opened.
    pub(super) fn open(client: &Client) -> Self {
        let bus = client.bus();
        Self {
            acts: bus.reader(&topics::ACT).expect("acts"),
            presented: bus.reader(&topics::PRESENTED).expect("presented"),
            receipts: bus.reader(&topics::RECEIPT).expect("receipts"),
            activity: bus.reader(&topics::ACTIVITY).expect("activity"),
            views: bus.encoded_reader(&topics::VIEW).expect("views"),
            questions: BTreeMap::new(),
            picks: false,
            view: PolicyView::default(),
            ear: None,
        }
    }

    /// Reads all new messages.
    ///
    /// # Panics
    /// If a topic breaks.
    pub(super) fn look(&mut self) -> News {
        let mut news = News::default();
        let (questions, picks) = (&mut self.questions, &mut self.picks);
        let take = |act: &RobotAct| match act.kind.get() {
            ActKind::Ask => {
                let text = act.text.as_str().unwrap_or_default().to_owned();
                questions.insert((act.prompt, act.presentation), text);
            }
            ActKind::Pick => *picks = true,
            _ => {}
        };
        self.acts.drain(take).expect("acts");
        let note = |presented: &Presented| {
            let said = (presented.prompt, presented.presentation);
            match presented.state.get() {
                PresentationState::Speaking => news.began.push((said, presented.started_ns)),
                PresentationState::Ended => news.ended.push((said, presented.ended_ns)),
                _ => {}
            }
        };
        self.presented.drain(note).expect("presented");
        self.receipts.drain(|receipt| news.receipts.push(*receipt)).expect("receipts");
        let ear = |activity: &Activity| self.ear = Some(activity.ear.get());
        self.activity.drain(ear).expect("activity");
        while let Some(view) = self.views.take().expect("views") {
            self.view = view;
        }
        news
    }
}
