//! A stop that is repeated until the arm has carried it out.

use messages::MotionOrder;

use super::{Progress, StopClient};
use crate::group::GroupPaths;
use crate::{Time, clock};
use std::io;

/// The latest stop that the arm has not carried out. Its owner calls [`RepeatedStop::pass`].
#[derive(Debug)]
pub struct RepeatedStop {
    client: StopClient,
    pending: Option<Progress>,
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
        let mut progress = Progress::new(MotionOrder::Stop, given, None);
        progress.advance(&self.client, clock::now());
        self.pending = Some(progress);
    }

    /// Repeats a pending stop if due. Returns the time of one that needs no more repetition.
    pub fn pass(&mut self) -> Option<Time> {
        let now = clock::now();
        let progress = self.pending.as_mut()?;
        progress.advance(&self.client, now);
        self.pending.take_if(|progress| progress.is_settled(now)).map(|progress| progress.given())
    }
}
