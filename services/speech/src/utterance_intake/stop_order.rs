//! The stop that a user orders in words. The order outlives this service: it is repeated until the
//! arm has carried it out, whichever process restarts meanwhile.

use std::collections::VecDeque;

use messages::{RequestKey, Sound};
use serde::{Deserialize, Serialize};
use service::bounded::push_bounded;
use service::{Span, Time};

use super::UtteranceIntake;
use super::origin::Origin;
use crate::record::Record;
use crate::utterance_content::UtteranceContent;
use crate::{Fx, Hypothesis, Out};

/// Interval of the passes in which a pending order is repeated.
const PASS_EVERY: Span = Span::from_ms(50);
/// Requests that are remembered, so that their repetitions give no further order.
const REQUESTS_MAX: usize = 64;

impl UtteranceIntake {
    /// Stops the arm if the words say so, which waits for no disk and no other request.
    pub(super) fn obey_stop(
        &mut self,
        origin: &Origin,
        content: &UtteranceContent,
        now: Time,
        fx: &mut Fx,
    ) {
        if content.is_stop() {
            self.stop.give((origin.key, origin.segment.0), now, fx);
        }
    }

    /// Obeys a stop in a request that cannot be accepted yet and will be repeated.
    pub(super) fn obey_unmarked(&mut self, origin: &Origin, sound: Sound, now: Time, fx: &mut Fx) {
        let words = match sound {
            Sound::Text(text) => vec![Hypothesis::certain(text)],
            Sound::Transcript { hypotheses } => hypotheses,
            _ => return,
        };
        if let Ok(content) = UtteranceContent::transcript(words) {
            self.obey_stop(origin, &content, now, fx);
        }
    }
}

/// The latest stop, until the arm has carried it out.
#[derive(Default, Serialize, Deserialize)]
pub(crate) struct StopOrder {
    pending: Option<Time>,
    next_pass: Time,
    /// The latest requests and segments that ordered one.
    requests: VecDeque<(RequestKey, u32)>,
}

impl StopOrder {
    /// Returns when the next pass is due, in which the shell repeats a pending order.
    pub(crate) fn deadline(&self) -> Option<Time> {
        self.pending.map(|_| self.next_pass)
    }

    pub(crate) fn tick(&mut self, now: Time) {
        self.next_pass = now + PASS_EVERY;
    }

    /// Restores the order from a record.
    pub(crate) fn restore(&mut self, record: &Record) {
        match record {
            Record::StopOrdered(given) => self.pending = Some(*given),
            Record::StopSettled(given) => self.end(*given),
            Record::Accepted(_) | Record::Presented(_) => {}
        }
    }

    /// Returns the record of a pending order, for a journal that begins with the state.
    pub(crate) fn snapshot(&self) -> Option<Record> {
        self.pending.map(Record::StopOrdered)
    }

    /// Gives the order of a request, at once: it waits for no disk.
    pub(super) fn give(&mut self, request: (RequestKey, u32), now: Time, fx: &mut Fx) {
        if self.requests.contains(&request) {
            return;
        }
        push_bounded(&mut self.requests, REQUESTS_MAX, request);
        self.order(now, fx);
    }

    /// Gives the order of a former incarnation again.
    pub(crate) fn resume(&mut self, now: Time, fx: &mut Fx) {
        match self.pending {
            // Of a clock before a restart of the machine.
            Some(given) if given > now => self.order(now, fx),
            Some(given) => fx.publish_urgent(Out::Stop(given)),
            None => {}
        }
    }

    /// Notes that the arm has carried out the order, or obeys a later one.
    pub(crate) fn settle(&mut self, given: Time, fx: &mut Fx) {
        if self.pending.is_some_and(|pending| pending <= given) {
            self.end(given);
            fx.append(Record::StopSettled(given));
        }
    }

    fn order(&mut self, now: Time, fx: &mut Fx) {
        self.pending = Some(now);
        fx.append(Record::StopOrdered(now));
        fx.publish_urgent(Out::Stop(now));
    }

    fn end(&mut self, given: Time) {
        self.pending = self.pending.filter(|pending| *pending > given);
    }
}
