//! Results of utterances that were decoded before their end was certain.
//!
//! Invariant: an early result is used only for the very samples that were decoded.

use std::collections::VecDeque;

use service::bounded::push_bounded;
use speech_engines::stream::SpeechSegment;

use crate::RecognisedSegment;

/// Early results that are kept: one for each speaker, and one that turned out to be too early.
const EARLY_MAX: usize = 4;

/// Results of segments that were decoded before their end was certain.
#[derive(Default)]
pub(super) struct EarlyResults {
    results: VecDeque<(SpeechSegment, RecognisedSegment)>,
    /// The inputs that were answered last: hints about them come too late.
    answered: VecDeque<u64>,
}

impl EarlyResults {
    pub(super) fn keep(&mut self, segment: SpeechSegment, result: RecognisedSegment) {
        push_bounded(&mut self.results, EARLY_MAX, (segment, result));
    }

    pub(super) fn take(&mut self, segment: &SpeechSegment) -> Option<RecognisedSegment> {
        let is_same = |(known, _): &(SpeechSegment, _)| {
            known.speech == segment.speech && known.samples == segment.samples
        };
        let at = self.results.iter().position(is_same)?;
        self.results.remove(at).map(|(_, result)| result)
    }

    pub(super) fn answered(&mut self, sound: u64) {
        push_bounded(&mut self.answered, EARLY_MAX, sound);
    }

    pub(super) fn is_answered(&self, sound: u64) -> bool {
        self.answered.contains(&sound)
    }
}
