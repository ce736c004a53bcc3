//! Checkpoints of the intake.

use super::UtteranceIntake;
use crate::Config;

impl UtteranceIntake {
    /// Returns everything but the configuration, for flights that begin in the middle of a start.
    pub(crate) fn checkpoint(&self) -> Option<Vec<u8>> {
        let Self {
            config: _,
            accepted,
            stop,
            waiting,
            receipts,
            pending,
            status,
            last_partial,
            early,
        } = self;
        let requests = (accepted, stop, waiting, receipts);
        postcard::to_stdvec(&(requests, pending, status, last_partial, early)).ok()
    }

    /// Returns the intake of a checkpoint.
    pub(crate) fn resume(config: Config, checkpoint: &[u8]) -> Option<Self> {
        let (requests, pending, status, last_partial, early) =
            postcard::from_bytes(checkpoint).ok()?;
        let (accepted, stop, waiting, receipts) = requests;
        Some(Self {
            config,
            accepted,
            stop,
            waiting,
            receipts,
            pending,
            status,
            last_partial,
            early,
        })
    }
}
