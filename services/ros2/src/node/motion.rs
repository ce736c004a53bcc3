//! Orders to the motion stop, by topic and by service.

use super::{Node, failure};
use crate::dds::Call;
use crate::orders::Event;
use crate::types::Triggered;
use messages::MotionOrder;
use service::clock;

/// A call of `stop` or `resume`.
pub(super) type MotionCall = (MotionOrder, Call);

impl Node {
    /// Takes orders to the motion stop and gives them to the arm.
    pub(super) fn on_orders(&mut self) {
        let Self { dds, counters, orders, .. } = self;
        dds.arrivals.clear();
        let mut is_stopped = false;
        // A flood of stops is one stop.
        let more = dds.stop_topic.drain(&mut counters.unreadable, |_, _| is_stopped = true);
        self.has_more = more;
        let stops = dds.stop.calls(&mut counters.unreadable);
        let resumes = dds.resume.calls(&mut counters.unreadable);
        let calls =
            |order, calls: Vec<Call>| calls.into_iter().map(move |call| (order, Some(call)));
        // Of a stop and a release at once, the stop counts.
        let all = calls(MotionOrder::Resume, resumes).chain(calls(MotionOrder::Stop, stops));
        let mut overruled = Vec::new();
        for (order, call) in all.chain(is_stopped.then_some((MotionOrder::Stop, None))) {
            tracing::info!(?order, "motion stop");
            overruled.extend(orders.give(order, call.map(|call| (order, call)), clock::now()));
        }
        self.respond(overruled, &failure("overruled by another order"));
        self.advance_orders();
    }

    pub(super) fn advance_orders(&mut self) {
        self.orders.advance(&self.stop_client, clock::now());
        let success = |message: &str| Triggered { success: true, message: message.to_owned() };
        let (callers, response) = match self.orders.event(clock::now()) {
            None => return,
            Some(Event::Done(callers, Ok(state))) if state.stopped => {
                (callers, success("stopped, at rest"))
            }
            Some(Event::Done(callers, Ok(_))) => (callers, success("released")),
            Some(Event::Done(callers, Err(why)) | Event::Late(callers, why)) => {
                tracing::error!(why, "motion order not confirmed");
                (callers, failure(&why))
            }
        };
        self.respond(callers, &response);
    }

    pub(super) fn respond(&mut self, callers: Vec<MotionCall>, response: &Triggered) {
        for (order, call) in callers {
            let server = match order {
                MotionOrder::Stop => &self.dds.stop,
                MotionOrder::Resume => &self.dds.resume,
            };
            server.respond(call, response.clone(), &mut self.counters.dropped);
        }
    }
}
