//! The stop orders of a simulated speech process, repeated as its shell does.

use messages::MotionOrder;
use service::Time;
use service::stop_socket::{Caller, StopOrder, StopState};

/// The latest stop that the arm has not carried out.
#[derive(Debug, Default)]
pub struct RepeatedStop {
    pending: Option<Time>,
}

impl RepeatedStop {
    /// Gives the stop of that time.
    pub fn give(&mut self, given: Time) {
        self.pending = Some(given);
    }

    /// Returns the order of this pass, if one is pending.
    pub fn order(&self) -> Option<arm::In<'static>> {
        let given_ns = self.pending?.ns();
        let order = StopOrder { order: MotionOrder::Stop, given_ns };
        Some(arm::In::StopOrder(order, Caller::named(b"speech")))
    }

    /// Takes an answer; returns the message to speech that settles the stop.
    pub fn on_answer(&mut self, state: &StopState) -> Option<speech::In<'static>> {
        let given = self.pending.take_if(|given| state.settles(*given))?;
        Some(speech::In::StopSettled(given))
    }
}
