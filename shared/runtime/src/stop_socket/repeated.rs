//! A stop that is repeated until the arm has carried it out.

use messages::MotionOrder;

use super::{StopClient, StopError};
use crate::group::GroupPaths;
use crate::{Span, Time, clock};
use std::io;

/// Interval at which a pending stop is repeated: what a restarted arm may move before it is stopped again.
const RESEND_EVERY: Span = Span::from_ms(40);

/// The latest stop that the arm has not carried out. It never waits; its owner calls [`RepeatedStop::pass`].
#[derive(Debug)]
pub struct RepeatedStop {
    client: StopClient,
    /// When the stop was given, and when it was sent last.
    pending: Option<(Time, Time)>,
}

impl RepeatedStop {
    /// Opens the path to the arm of a group, which may be there or not.
    ///
    /// # Errors
    /// The process or the system has no descriptor left.
    pub fn open(paths: &GroupPaths) -> io::Result<Self> {
        Ok(Self { client: StopClient::open(paths)?, pending: None })
    }

    /// Gives the stop of that time in the place of an earlier one, and sends it at once.
    pub fn give(&mut self, given: Time) {
        self.send(given);
    }

    /// Repeats a pending stop if it is due. Returns the time of one that needs no repetition any more: carried out,
    /// or overruled by a later order.
    pub fn pass(&mut self) -> Option<Time> {
        let (given, sent) = self.pending?;
        while let Some(state) = self.client.take() {
            if state.settles(given) {
                self.pending = None;
                return Some(given);
            }
        }
        if clock::now() >= sent + RESEND_EVERY {
            self.send(given);
        }
        None
    }

    fn send(&mut self, given: Time) {
        self.pending = Some((given, clock::now()));
        match self.client.send(MotionOrder::Stop, given) {
            // The arm's service is away: it finds the order when it is back.
            Ok(()) | Err(StopError::Absent) => {}
            Err(error) => tracing::warn!(%error, "stop order not sent"),
        }
    }
}
