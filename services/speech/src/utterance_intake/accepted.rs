//! Accepted utterances until the policy has applied them, and the receipts of all requests.

use std::collections::VecDeque;

use messages::outbox::Outbox;
use messages::{AppliedMark, ClientId, Receipt, RequestKey, UtteranceSeq, topics};
use service::Time;
use service::bounded::push_bounded;

use crate::record::Accepted;
use crate::{Fx, Out};

/// Utterances that may wait to be applied; beyond it users are asked to wait.
const WAITING_MAX: usize = 256;

#[derive(serde::Serialize, serde::Deserialize)]
pub(crate) struct AcceptedUtterances {
    outbox: Outbox<Accepted>,
    /// The latest ones, applied or not.
    recent: VecDeque<Accepted>,
    /// `true` if the policy's mark is known. Before that a number could be assigned twice.
    is_marked: bool,
}

impl AcceptedUtterances {
    pub(super) fn new() -> Self {
        let outbox = Outbox::new(UtteranceSeq(0), topics::WINDOW, WAITING_MAX);
        Self { outbox, recent: VecDeque::new(), is_marked: false }
    }

    pub(super) fn add(&mut self, accepted: Accepted) {
        push_bounded(&mut self.recent, ITEMS_MAX, accepted.clone());
        if accepted.seq > self.outbox.last() {
            self.outbox.push(accepted.seq, accepted);
        }
    }

    /// Returns a recent utterance by its request and segment.
    pub(super) fn find(&self, key: RequestKey, segment: u32) -> Option<&Accepted> {
        self.recent.iter().find(|accepted| accepted.key == key && accepted.segment.0 == segment)
    }

    /// Returns the next number, or why there is none.
    pub(super) fn next(&self) -> Result<UtteranceSeq, String> {
        if !self.is_marked {
            return Err("the robot is not ready yet; help: repeat it".to_owned());
        }
        self.outbox.next().map_err(|full| full.to_string())
    }

    /// Handles the policy's mark. Returns whether it is new.
    pub(crate) fn acknowledge(&mut self, mark: AppliedMark) -> bool {
        let (before, was_marked) = (self.outbox.len(), self.is_marked);
        if !self.outbox.acknowledge(UtteranceSeq(mark.seq)) {
            tracing::warn!(mark = mark.seq, last = %self.outbox.last(), "impossible mark rejected");
            return false;
        }
        self.is_marked = true;
        self.outbox.len() != before || !was_marked
    }

    /// Handles a journal that was set aside: utterances up to `over` are never sent again.
    pub(crate) fn skip(&mut self, over: UtteranceSeq) {
        let before = self.outbox.len();
        self.outbox.skip(over);
        if self.outbox.len() < before {
            let dropped = before - self.outbox.len();
            tracing::warn!(dropped, "utterances from before a journal was set aside are dropped");
        }
    }

    pub(crate) fn is_marked(&self) -> bool {
        self.is_marked
    }

    /// Returns the utterances to send; none before the mark is known: all may be applied then.
    pub(super) fn to_send(&self) -> impl Iterator<Item = &Accepted> {
        let window = self.outbox.window().map(|(_, accepted)| accepted);
        window.filter(|_| self.is_marked)
    }

    /// Returns when the utterance at the head of the queue was accepted.
    pub(crate) fn pending_since(&self) -> Option<Time> {
        self.outbox.window().next().map(|(_, accepted)| accepted.accepted)
    }

    /// Returns when the oldest utterance that is not applied was accepted.
    pub(super) fn oldest(&self) -> Option<Time> {
        self.outbox.window().map(|(_, accepted)| accepted.accepted).min()
    }

    /// Returns the number of utterances of a client that are not applied.
    pub(super) fn of_client(&self, client: ClientId) -> usize {
        self.outbox.waiting().filter(|accepted| accepted.key.client() == client).count()
    }

    /// Returns the number of utterances that are not applied.
    pub(super) fn len(&self) -> usize {
        self.outbox.len()
    }

    /// Returns the utterances that a new journal must begin with, in order: those that are not
    /// applied yet, and the latest ones.
    pub(crate) fn snapshot(&self) -> impl Iterator<Item = Accepted> + '_ {
        let recent = self.recent.front().map(|accepted| accepted.seq);
        let older = move |accepted: &&Accepted| recent.is_some_and(|seq| accepted.seq < seq);
        self.outbox.waiting().filter(older).chain(&self.recent).cloned()
    }
}

/// The latest receipts that were sent, so that a repeated request gets the same ones.
#[derive(Default, serde::Serialize, serde::Deserialize)]
pub(super) struct Receipts {
    sent: VecDeque<Receipt>,
}

impl Receipts {
    pub(super) fn record(&mut self, receipt: Receipt) {
        push_bounded(&mut self.sent, ITEMS_MAX, receipt);
    }

    /// Publishes the receipts of a request again. Returns `false` unless it has all of them.
    pub(super) fn repeat(&self, key: RequestKey, fx: &mut Fx) -> bool {
        let receipts = || self.sent.iter().filter(|receipt| receipt.request() == key);
        let segments = receipts().next().map_or(u32::MAX, |receipt| receipt.segments);
        if receipts().count() < segments as usize {
            return false;
        }
        receipts().for_each(|receipt| fx.publish(Out::Receipt(Box::new(*receipt))));
        true
    }
}

/// Utterances and receipts that are remembered for repeated requests.
const ITEMS_MAX: usize = 128;

#[cfg(test)]
mod tests {
    use super::*;
    use messages::Source;

    fn accepted(seq: u64) -> Accepted {
        Accepted {
            seq: UtteranceSeq(seq),
            key: RequestKey([0; 16]),
            segment: (0, 1),
            hypotheses: Vec::new(),
            gesture: None,
            origin: Source::Text.into(),
            asked: Vec::new(),
            onset: Time(seq),
            end: Time(seq),
            snr_db: 0.0,
            accepted: Time(seq),
        }
    }

    fn numbers(accepted: &AcceptedUtterances) -> Vec<u64> {
        accepted.snapshot().map(|accepted| accepted.seq.0).collect()
    }

    #[test]
    fn snapshot_holds_what_is_not_applied_and_what_may_be_repeated_each_once() {
        let mut all = AcceptedUtterances::new();
        assert!(numbers(&all).is_empty());
        (1..=200).for_each(|seq| all.add(accepted(seq)));
        assert_eq!(numbers(&all), (1..=200).collect::<Vec<_>>());
        assert!(all.acknowledge(AppliedMark { seq: 50 }));
        assert_eq!(numbers(&all), (51..=200).collect::<Vec<_>>());
        assert!(all.acknowledge(AppliedMark { seq: 200 }));
        assert_eq!(numbers(&all), (73..=200).collect::<Vec<_>>());
        let mut recovered = AcceptedUtterances::new();
        all.snapshot().for_each(|accepted| recovered.add(accepted));
        assert_eq!(numbers(&recovered), numbers(&all));
    }
}
