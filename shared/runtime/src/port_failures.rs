//! Topics that fail for a while: shared memory or descriptors may be short for now.

use crate::bus::PortError;
use crate::exit::{Exit, Failure};
use crate::{Span, Time};

/// Time that a topic may fail without a break before the service gives up: a restart may help then.
const PATIENCE: Span = Span::from_ms(10_000);

/// Failure of a topic in the last pass, and since when passes have had one.
#[derive(Debug, Default)]
pub struct PortFailures(Option<(String, Time)>);

impl PortFailures {
    /// Bears with a failing topic for a while; `error` is that of this pass, if there was one.
    ///
    /// # Errors
    /// Every pass has failed for 10 s.
    pub fn judge(&mut self, error: Option<PortError>, now: Time) -> Result<(), Failure> {
        let Some(error) = error else {
            self.0 = None;
            return Ok(());
        };
        let (what, since) = self.0.get_or_insert_with(|| {
            tracing::error!(%error, "a topic fails; trying again");
            (error.to_string(), now)
        });
        if now.since(*since) < PATIENCE {
            return Ok(());
        }
        Err(Failure::new(Exit::NotReached, std::mem::take(what)))
    }

    /// Returns the failure, which a service reports as its shortage.
    pub fn shortage(&self) -> Option<&str> {
        self.0.as_ref().map(|(what, _)| what.as_str())
    }
}
