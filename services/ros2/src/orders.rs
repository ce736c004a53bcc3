//! Orders to the motion stop, on the stop's own path. A stop is repeated until the arm confirms it or
//! another order overrules it, however long the arm's service is away.

use messages::MotionOrder;
use service::stop_socket::{Progress, StopError, StopState};
use service::{Span, Time};

/// Interval at which an unconfirmed order is repeated.
const RESEND_EVERY: Span = Span::from_ms(20);
/// Deadline for the answer to a caller; a release that is later would surprise.
const PATIENCE: Span = Span::from_ms(4_000);
/// Most callers that wait for an answer; the order of a further one is given all the same.
const CALLERS_MAX: usize = 32;

/// Answer to a caller: what is true, or why the order is not carried out.
pub type Answer = Result<StopState, String>;

/// The order that is in force until it is confirmed.
#[derive(Debug)]
struct Pending<C> {
    order: MotionOrder,
    given: Time,
    sent: Option<Time>,
    progress: Progress,
    callers: Vec<C>,
    /// No process listened to the latest repetition.
    is_absent: bool,
    /// Callers have been answered that it is late.
    is_late: bool,
}

/// Orders on their way. `C` identifies who waits for the answer.
#[derive(Debug)]
pub struct Orders<C>(Option<Pending<C>>);

impl<C> Default for Orders<C> {
    fn default() -> Self {
        Self(None)
    }
}

impl<C> Orders<C> {
    /// Puts an order in force, which is to be sent at once. Returns the callers of a contrary one, whose
    /// order is overruled.
    pub fn give(&mut self, order: MotionOrder, caller: Option<C>, now: Time) -> Vec<C> {
        let mut callers = Vec::new();
        let mut overruled = Vec::new();
        if let Some(before) = self.0.take() {
            let is_same = before.order == order;
            *(if is_same { &mut callers } else { &mut overruled }) = before.callers;
        }
        callers.extend(caller.filter(|_| callers.len() < CALLERS_MAX));
        let progress = Progress::new(order, now, PATIENCE);
        let (is_absent, is_late) = (false, false);
        self.0 =
            Some(Pending { order, given: now, sent: None, progress, callers, is_absent, is_late });
        overruled
    }

    /// Returns the order that is due to be sent, with its original time, which makes repetitions
    /// harmless.
    pub fn due(&mut self, now: Time) -> Option<(MotionOrder, Time)> {
        let pending =
            self.0.as_mut().filter(|it| it.sent.is_none_or(|sent| now >= sent + RESEND_EVERY))?;
        pending.sent = Some(now);
        Some((pending.order, pending.given))
    }

    /// Notes whether a process listened.
    pub fn on_sent(&mut self, sent: &Result<(), StopError>) {
        if let Some(pending) = &mut self.0 {
            pending.is_absent = matches!(sent, Err(StopError::Absent));
        }
    }

    /// Takes in an answer of the arm.
    pub fn on_answer(&mut self, state: StopState, now: Time) {
        if let Some(pending) = &mut self.0 {
            pending.progress.on_answer(state, now);
        }
    }

    /// Returns the result once there is one, and who waits for it. A stop that is not confirmed in time
    /// stays in force.
    pub fn result(&mut self, now: Time) -> Option<(Vec<C>, Answer)> {
        let pending = self.0.as_mut()?;
        let result = pending.progress.result(pending.is_absent, now)?;
        let callers = std::mem::take(&mut pending.callers);
        let stays = pending.order == MotionOrder::Stop
            && matches!(result, Err(ref error) if !matches!(error, StopError::Overruled));
        let was_late = std::mem::replace(&mut pending.is_late, stays);
        if !stays {
            self.0 = None;
        } else if was_late && callers.is_empty() {
            return None;
        }
        Some((callers, result.map_err(|error| error.to_string())))
    }

    /// Returns whether an order is not confirmed, so that the next repetition should come soon.
    pub fn is_pending(&self) -> bool {
        self.0.is_some()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use messages::MotionInhibit;

    fn at(ms: u64) -> Time {
        Time(1_000_000 * ms)
    }

    fn answer(given: Time, stopped: bool) -> StopState {
        let (given_ns, in_force_ns) = (given.ns(), given.ns());
        let inhibit = MotionInhibit::None;
        StopState { given_ns, in_force_ns, stopped, at_rest: true, durable: true, inhibit }
    }

    #[test]
    fn stop_is_repeated_until_it_is_confirmed_and_callers_are_answered_meanwhile() {
        let mut orders = Orders::default();
        assert!(orders.give(MotionOrder::Stop, Some('a'), at(1)).is_empty());
        assert_eq!(orders.due(at(1)), Some((MotionOrder::Stop, at(1))));
        assert_eq!(orders.due(at(10)), None);
        assert_eq!(orders.due(at(21)), Some((MotionOrder::Stop, at(1))));
        orders.on_sent(&Err(StopError::Absent));
        assert!(orders.result(at(900)).is_none());
        let (callers, result) = orders.result(at(1_001)).unwrap();
        assert!(callers == ['a'] && result.unwrap_err().contains("emergency stop"));
        assert!(orders.result(at(1_100)).is_none(), "reported once");
        assert!(orders.due(at(60_000)).is_some(), "a minute later, still in force");
        orders.on_sent(&Ok(()));
        orders.on_answer(answer(at(1), true), at(60_001));
        assert!(matches!(orders.result(at(60_001)), Some((_, Ok(state))) if state.stopped));
        assert!(!orders.is_pending() && orders.due(at(70_000)).is_none());
    }

    #[test]
    fn latest_order_overrules_contrary_ones_and_a_late_release_is_given_up() {
        let mut orders = Orders::default();
        orders.give(MotionOrder::Stop, Some('a'), at(1));
        orders.give(MotionOrder::Stop, Some('b'), at(2));
        assert_eq!(orders.give(MotionOrder::Resume, Some('c'), at(3)), ['a', 'b']);
        orders.on_answer(answer(at(2), true), at(4));
        assert!(orders.result(at(4)).is_none(), "an answer to another order");
        let (callers, result) = orders.result(at(4_003)).unwrap();
        assert!(callers == ['c'] && result.is_err() && !orders.is_pending());
    }

    #[test]
    fn number_of_callers_is_bounded() {
        let mut orders = Orders::default();
        (0..1_000).for_each(|n| drop(orders.give(MotionOrder::Stop, Some(n), at(n))));
        assert_eq!(orders.0.unwrap().callers.len(), CALLERS_MAX);
    }
}
