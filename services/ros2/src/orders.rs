//! Orders to the motion stop, on the stop's own path. A stop is repeated until the arm confirms it or
//! another order overrules it, however long the arm's service is away.

use messages::{MotionOrder, StopId};
use service::stop_socket::{Progress, StopClient, StopState, default_patience};
use service::{Span, Time};

/// Deadline for the answer to a caller of a stop, which is repeated all the same.
const ANSWER_WITHIN: Span = Span::from_ms(4_000);
/// Most callers that wait for an answer; the order of a further one is given all the same.
const CALLERS_MAX: usize = 32;

/// Answer to a caller: what is true, or why the order is not carried out.
pub type Answer = Result<StopState, String>;

/// The order that is in force until it is confirmed.
#[derive(Debug)]
struct Pending<C> {
    progress: Progress,
    /// Who waits for the answer, and since when.
    callers: Vec<(C, Time)>,
}

/// Outcome of an order, or of the wait for it.
#[derive(Debug, PartialEq)]
pub enum Event<C> {
    /// The order is over; the callers who wait for it.
    Done(Vec<C>, Answer),
    /// A stop is not confirmed yet and is repeated, for the reason given; the callers who have waited long enough.
    Late(Vec<C>, String),
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
        let mut overruled = Vec::new();
        match &mut self.0 {
            Some(pending) if pending.progress.order() == order => {
                pending.progress.renew(now, StopId(0))
            }
            pending => {
                let progress = Progress::new(order, now, default_patience(order));
                let before = pending.replace(Pending { progress, callers: Vec::new() });
                overruled.extend(before.into_iter().flat_map(|before| before.callers));
            }
        }
        if let (Some(pending), Some(caller)) = (&mut self.0, caller)
            && pending.callers.len() < CALLERS_MAX
        {
            pending.callers.push((caller, now));
        }
        overruled.into_iter().map(|(caller, _)| caller).collect()
    }

    /// Repeats the order and takes in the arm's answers.
    pub fn advance(&mut self, client: &StopClient, now: Time) {
        if let Some(pending) = &mut self.0 {
            pending.progress.advance(client, now);
        }
    }

    /// Returns what has happened to the order. A stop that is not confirmed in time stays in force.
    pub fn event(&mut self, now: Time) -> Option<Event<C>> {
        let pending = self.0.as_mut()?;
        if let Some(result) = pending.progress.result(now) {
            let callers = self.0.take()?.callers.into_iter().map(|(caller, _)| caller).collect();
            return Some(Event::Done(callers, result.map_err(|error| error.to_string())));
        }
        let warning = pending.progress.warning(now);
        let is_late = |(_, since): &mut (C, Time)| now >= *since + ANSWER_WITHIN;
        let late: Vec<C> =
            pending.callers.extract_if(.., is_late).map(|(caller, _)| caller).collect();
        let why = warning.or((!late.is_empty()).then(|| pending.progress.why(now)))?;
        Some(Event::Late(late, format!("not confirmed yet; the order is repeated: {why}")))
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
    use service::stop_socket::StopError;

    fn at(ms: u64) -> Time {
        Time(1_000_000 * ms)
    }

    fn answer(given: Time, stopped: bool) -> StopState {
        let (given_ns, in_force_ns) = (given.ns(), given.ns());
        let inhibit = MotionInhibit::None;
        let (at_rest, durable, stop) = (true, true, StopId(0));
        StopState { given_ns, in_force_ns, stopped, at_rest, durable, inhibit, stop }
    }

    fn done<C>(event: Option<Event<C>>) -> (Vec<C>, Answer) {
        match event {
            Some(Event::Done(callers, answer)) => (callers, answer),
            _ => panic!("not over"),
        }
    }

    #[test]
    fn stop_is_repeated_until_it_is_confirmed_and_callers_are_answered_meanwhile() {
        let mut orders = Orders::default();
        assert!(orders.give(MotionOrder::Stop, Some('a'), at(1)).is_empty());
        let progress = |orders: &mut Orders<char>, sent| {
            orders.0.as_mut().unwrap().progress.on_sent(&sent);
        };
        progress(&mut orders, Err(StopError::Absent));
        // An hour without the arm's service; the caller is answered once, the log has a warning every few seconds.
        let (mut late, mut warnings) = (Vec::new(), 0);
        for ms in (1..3_600_000).step_by(20) {
            match orders.event(at(ms)) {
                None => {}
                Some(Event::Late(callers, why)) => {
                    assert!(why.contains("not confirmed yet") && why.contains("emergency stop"));
                    late.extend(callers.iter().map(|_| ms));
                    warnings += 1;
                }
                Some(Event::Done(_, answer)) => panic!("given up after {ms} ms: {answer:?}"),
            }
        }
        assert_eq!(late, [4_001]);
        assert!((1_200..=1_202).contains(&warnings), "{warnings}");
        progress(&mut orders, Ok(()));
        let pending = orders.0.as_mut().unwrap();
        pending.progress.on_answer(answer(at(1), true), at(3_600_001));
        let (callers, result) = done(orders.event(at(3_600_001)));
        assert!(callers.is_empty() && result.unwrap().stopped && !orders.is_pending());
    }

    #[test]
    fn latest_order_overrules_contrary_ones_and_a_late_release_is_given_up() {
        let mut orders = Orders::default();
        orders.give(MotionOrder::Stop, Some('a'), at(1));
        orders.give(MotionOrder::Stop, Some('b'), at(2));
        assert_eq!(orders.give(MotionOrder::Resume, Some('c'), at(3)), ['a', 'b']);
        let pending = orders.0.as_mut().unwrap();
        pending.progress.on_answer(answer(at(2), true), at(4));
        assert_eq!(orders.event(at(4)), None, "an answer to another order");
        let Some(Event::Late(callers, _)) = orders.event(at(4_003)) else { panic!("late") };
        assert_eq!(callers, ['c']);
        let (callers, result) = done(orders.event(at(5_003)));
        assert!(callers.is_empty() && result.is_err() && !orders.is_pending());
    }

    #[test]
    fn number_of_callers_is_bounded() {
        let mut orders = Orders::default();
        (0..1_000).for_each(|n| drop(orders.give(MotionOrder::Stop, Some(n), at(n))));
        assert_eq!(orders.0.unwrap().callers.len(), CALLERS_MAX);
    }
}
