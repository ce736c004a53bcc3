//! Metrics of dialogue, arm and hearing, and how messages become metrics.

use std::collections::VecDeque;

use messages::{
    ArmStatus, Hearing, Outcome, PickOutcome, PolicyView, Receipt, ReceiptStatus, Task,
};
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets, linear_buckets};
use prometheus_client::registry::Registry;
use serde::Serialize;
use service::Time;
use service::bounded::push_bounded;
use std::sync::atomic::AtomicU64;

/// One label and its value.
type Label = [(&'static str, String); 1];

/// Receipts that are remembered, as the speech service repeats them.
const RECEIPTS_MAX: usize = 64;

/// Counters and histograms that begin with the console.
#[derive(Debug)]
pub struct DialogueMetrics {
    picks: Family<Label, Counter>,
    interactions: Family<Label, Counter>,
    questions: Counter,
    seconds: Histogram,
    asked: Histogram,
    utterances: Family<Label, Counter>,
    confidence: Histogram,
    snr: Histogram,
    level: Gauge<f64, AtomicU64>,
}

/// All outcomes of a pick, so that each is exported from the beginning.
const PICKS: [PickOutcome; 9] = [
    PickOutcome::Delivered,
    PickOutcome::Unreachable,
    PickOutcome::Interrupted,
    PickOutcome::Cancelled,
    PickOutcome::Missed,
    PickOutcome::Blocked,
    PickOutcome::PutBack,
    PickOutcome::Vanished,
    PickOutcome::Kept,
];
const INTERACTIONS: [Outcome; 7] = [
    Outcome::Delivered,
    Outcome::Refused,
    Outcome::Failed,
    Outcome::Cancelled,
    Outcome::Abandoned,
    Outcome::SceneChanged,
    Outcome::NotHere,
];
const UTTERANCES: [ReceiptStatus; 3] =
    [ReceiptStatus::Accepted, ReceiptStatus::Refused, ReceiptStatus::NotForMe];

impl Default for DialogueMetrics {
    fn default() -> Self {
        let metrics = Self {
            picks: Family::default(),
            interactions: Family::default(),
            questions: Counter::default(),
            // 1 s to 8.5 min.
            seconds: Histogram::new(exponential_buckets(1.0, 2.0, 10)),
            asked: Histogram::new(linear_buckets(0.0, 1.0, 11)),
            utterances: Family::default(),
            confidence: Histogram::new(linear_buckets(0.1, 0.1, 10)),
            snr: Histogram::new(linear_buckets(0.0, 5.0, 13)),
            level: Gauge::default(),
        };
        PICKS.iter().for_each(|it| drop(metrics.picks.get_or_create(&outcome(it))));
        INTERACTIONS.iter().for_each(|it| drop(metrics.interactions.get_or_create(&outcome(it))));
        UTTERANCES.iter().for_each(|it| drop(metrics.utterances.get_or_create(&result(it))));
        metrics
    }
}

impl DialogueMetrics {
    pub(super) fn register(&self, registry: &mut Registry) {
        let picks = "Picks that have ended, those that put an object back included";
        registry.register("picks", picks, self.picks.clone());
        let interactions = "Interactions that have ended; one that is refused later counts again";
        registry.register("interactions", interactions, self.interactions.clone());
        registry.register("questions", "Questions asked", self.questions.clone());
        let seconds = "From the first utterance to the hand-over";
        registry.register("pick_seconds", seconds, self.seconds.clone());
        let asked = "Questions asked before the hand-over";
        registry.register("pick_questions", asked, self.asked.clone());
        let utterances = "Utterances of all sources";
        registry.register("utterances", utterances, self.utterances.clone());
        let confidence = "The recogniser's confidence in the text of a spoken utterance, 0 to 1";
        registry.register("recognition_confidence", confidence, self.confidence.clone());
        let snr = "Level of a spoken utterance above the noise around it";
        registry.register("speech_snr_decibels", snr, self.snr.clone());
        let level = "Loudness of the robot's microphone, below full scale";
        registry.register("microphone_level_decibels", level, self.level.clone());
    }
}

fn outcome(outcome: &impl Serialize) -> Label {
    [("outcome", name(outcome))]
}

fn result(status: &ReceiptStatus) -> Label {
    [("result", name(status))]
}

/// Returns a value's name as the console's JSON has it.
fn name(value: &impl Serialize) -> String {
    let json = serde_json::to_value(value).unwrap_or_default();
    json.as_str().unwrap_or("unknown").to_owned()
}

/// Counts single events, from messages that are repeated. Events before the console began are not
/// counted.
#[derive(Debug)]
pub struct Tally {
    began: Time,
    /// The latest interaction that has ended.
    ended: Option<Option<(u64, Outcome)>>,
    /// Interaction, and number of questions asked in it.
    questions: Option<(u64, u32)>,
    /// The latest pick and the outcome.
    pick: Option<(u64, u32, Task, PickOutcome)>,
    receipts: VecDeque<([u8; 16], u32)>,
}

impl Tally {
    /// Begins to count at `began`.
    pub fn new(began: Time) -> Self {
        Self { began, ended: None, questions: None, pick: None, receipts: VecDeque::new() }
    }

    /// Counts questions, and interactions that have ended.
    pub fn on_view(&mut self, view: &PolicyView, metrics: &DialogueMetrics) {
        let before = match self.questions {
            Some((interaction, questions)) if interaction == view.interaction => questions,
            Some(_) => 0,
            None => view.questions,
        };
        metrics.questions.inc_by(view.questions.saturating_sub(before).into());
        self.questions = Some((view.interaction, view.questions));
        let ended = view.last.as_ref().map(|last| (last.interaction.0, last.outcome));
        let is_new = self.ended.is_some_and(|known| known != ended);
        self.ended = Some(ended);
        let Some(last) = view.last.as_ref().filter(|_| is_new) else { return };
        metrics.interactions.get_or_create(&outcome(&last.outcome)).inc();
        if last.outcome == Outcome::Delivered {
            metrics.seconds.observe(last.seconds);
            metrics.asked.observe(last.questions.into());
        }
    }

    /// Counts picks that have ended.
    pub fn on_arm(&mut self, arm: &ArmStatus, metrics: &DialogueMetrics) {
        let pick = (arm.interaction, arm.attempt, arm.task.get(), arm.outcome.get());
        let is_new = self.pick.is_some_and(|known| known != pick);
        self.pick = Some(pick);
        if is_new && arm.interaction != 0 && arm.outcome != PickOutcome::Pending {
            metrics.picks.get_or_create(&outcome(&arm.outcome.get())).inc();
        }
    }

    /// Counts utterances.
    pub fn on_receipt(&mut self, receipt: &Receipt, metrics: &DialogueMetrics) {
        let key = (receipt.key, receipt.segment);
        let was_before = Time(receipt.onset_ns.max(receipt.end_ns)) < self.began;
        if receipt.status == ReceiptStatus::Over || was_before || self.receipts.contains(&key) {
            return;
        }
        push_bounded(&mut self.receipts, RECEIPTS_MAX, key);
        metrics.utterances.get_or_create(&result(&receipt.status.get())).inc();
        // Of text there is nothing to recognise.
        if receipt.snr_db > 0.0 {
            metrics.confidence.observe(receipt.confidence.into());
            metrics.snr.observe(receipt.snr_db.into());
        }
    }

    /// Takes over the level of the microphone.
    pub fn on_hearing(&self, hearing: &Hearing, metrics: &DialogueMetrics) {
        metrics.level.set(hearing.level_db.into());
    }
}
