//! Entries of the audit about a page.

use std::sync::PoisonError;
use std::sync::atomic::Ordering;

use service::bounded::push_bounded;

use super::{AWAITED_MAX, Visit};
use crate::audit::{Entry, Outcome};
use crate::rules::{Answered, Order};

impl Visit<'_> {
    pub(super) fn await_outcome(&self, order: &Order) {
        let mut awaited = self.awaited.lock().unwrap_or_else(PoisonError::into_inner);
        push_bounded(&mut awaited, AWAITED_MAX, (order.id, order.what.clone()));
    }

    pub(super) fn outcome(&self, answer: Answered) {
        match answer {
            Answered::Heard(text) => {
                self.note("speech", Outcome::Done, None, Some(text));
            }
            Answered::Over(stream) => self.sounds.over(stream),
            Answered::Done(id, result) => {
                let mut awaited = self.awaited.lock().unwrap_or_else(PoisonError::into_inner);
                let place = awaited.iter().position(|(known, _)| *known == id);
                let Some((_, what)) = place.and_then(|place| awaited.remove(place)) else { return };
                drop(awaited);
                let outcome = if result.is_ok() { Outcome::Done } else { Outcome::Failed };
                self.note(&what, outcome, Some(id), result.err());
            }
        }
    }

    /// Records a stop that has passed. One beyond the budget or the audit's room is only counted.
    pub(super) fn note_stop(&self, order: &Order) {
        if self.has_budget() && self.note_order(order, Outcome::Ordered, None) {
            self.await_outcome(order);
        } else {
            self.uncounted_stops.fetch_add(1, Ordering::Relaxed);
        }
    }

    /// Records how many stops have no entry of their own.
    pub(super) fn note_more_stops(&self) {
        let more = self.uncounted_stops.swap(0, Ordering::Relaxed);
        let noted = || self.note("stop", Outcome::Ordered, None, Some(format!("{more} more")));
        if more > 0 && !noted() {
            self.uncounted_stops.fetch_add(more, Ordering::Relaxed);
        }
    }

    pub(super) fn note_order(&self, order: &Order, outcome: Outcome, why: Option<String>) -> bool {
        self.gateway.audit.note(&self.entry(&order.what, outcome, Some(order.id), why))
    }

    pub(super) fn note(
        &self,
        what: &str,
        outcome: Outcome,
        id: Option<u64>,
        text: Option<String>,
    ) -> bool {
        self.gateway.audit.note(&self.entry(what, outcome, id, text))
    }

    /// The entry of an order that is given or refused, with all that it says.
    pub(super) fn entry_of(&self, order: &Order, outcome: Outcome) -> Entry {
        let entry = self.entry(&order.what, outcome, Some(order.id), order.text.clone());
        Entry { with: order.with.clone(), ..entry }
    }

    fn entry(&self, what: &str, outcome: Outcome, id: Option<u64>, text: Option<String>) -> Entry {
        let order = Some((self.number, id.unwrap_or(0)));
        let entry = Entry::new(&self.known.person, Some(&self.robot), what, outcome);
        Entry { text, order, ..entry }
    }
}
