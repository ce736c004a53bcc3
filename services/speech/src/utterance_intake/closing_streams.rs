//! Clients' streams that have ended while utterances in them are still being recognised.

use messages::RequestKey;

use super::origin::Origin;
use crate::pending_sounds::PendingSounds;

/// Streams that may wait for the results of their utterances.
const STREAMS_MAX: usize = 64;

/// Ended streams with their number of utterances and lost samples.
#[derive(Default)]
pub(super) struct ClosingStreams {
    streams: Vec<(RequestKey, u32, u64)>,
}

impl ClosingStreams {
    /// Adds a stream. Clients repeat the end until it is confirmed; only the first end counts.
    pub(super) fn add(&mut self, stream: RequestKey, utterances: u32, lost: u64) {
        if self.streams.iter().any(|(key, ..)| *key == stream) {
            return;
        }
        if self.streams.len() >= STREAMS_MAX {
            self.streams.remove(0);
        }
        self.streams.push((stream, utterances, lost));
    }

    /// Removes the streams without pending sounds. Returns them with a note about losses.
    pub(super) fn take_done(&mut self, pending: &PendingSounds) -> Vec<(Origin, String)> {
        let done = self.streams.extract_if(.., |(key, ..)| !pending.contains(*key));
        let note = |lost| match lost {
            0 => String::new(),
            lost => format!("{lost} samples lost in transit"),
        };
        done.map(|(key, utterances, lost)| (Origin::closed(key, utterances), note(lost))).collect()
    }
}
