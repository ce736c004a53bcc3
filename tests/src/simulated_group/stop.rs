//! The stop orders of a simulated speech process, repeated as its shell does.

use messages::MotionOrder;
use service::Time;
use service::stop_socket::{Caller, Progress, StopOrder, StopState};

/// The latest stop that the arm has not carried out.
#[derive(Debug, Default)]
pub struct RepeatedStop {
    pending: Option<Progress>,
}

impl RepeatedStop {
    /// Gives the stop of that time.
    pub fn give(&mut self, given: Time) {
        self.pending = Some(Progress::new(MotionOrder::Stop, given, None));
    }

    /// Returns the order of this pass, if one is pending.
    pub fn order(&self) -> Option<arm::In<'static>> {
        let order = StopOrder::new(MotionOrder::Stop, self.pending.as_ref()?.given());
        Some(arm::In::StopOrder(order, Caller::named(b"speech")))
    }

    /// Takes an answer; returns the message to speech that settles the stop.
    pub fn on_answer(&mut self, state: StopState, now: Time) -> Option<speech::In<'static>> {
        self.pending.as_mut()?.on_answer(state, now);
        let settled = self.pending.take_if(|progress| progress.is_settled(now))?;
        Some(speech::In::StopSettled(settled.given()))
    }
}
