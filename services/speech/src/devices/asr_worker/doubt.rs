//! An utterance about which the second recogniser was asked.

use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, TryRecvError, never};
use service::clock;

use crate::Hypothesis;
use crate::devices::audio::seconds;
use crate::devices::recogniser::{Ensemble, Heard, Opinion, PendingOpinion, SecondView};
use crate::devices::stream::SpeechSegment;
use crate::devices::vad::SegmenterOptions;

/// An utterance about which the second recogniser was asked.
pub(super) struct Doubt {
    pub(super) sound: u64,
    /// The samples that were decoded.
    pub(super) segment: SpeechSegment,
    pub(super) first: Vec<Hypothesis>,
    pending: PendingOpinion,
    /// `true` if its end is certain, so that a result is owed.
    pub(super) is_owed: bool,
}

/// Has the second recogniser listen to the segment until so long after the voice; `None` if that is over,
/// or there is no second recogniser.
pub(super) fn second_listens(
    recognisers: &Ensemble,
    segment: &SpeechSegment,
    patience: Duration,
) -> Option<PendingOpinion> {
    let ago = Duration::from_secs_f64(clock::now().since(segment.end).s());
    let until = Instant::now() + patience.checked_sub(ago)?;
    recognisers.second_listens(&segment.samples, &segment.speech, until)
}

impl Doubt {
    /// Asks for an opinion on the first recogniser's hypotheses.
    pub(super) fn raise(
        pending: PendingOpinion,
        sound: u64,
        segment: SpeechSegment,
        first: Vec<Hypothesis>,
        segmenter: &SegmenterOptions,
    ) -> Self {
        // The hypotheses of an earlier pause are followed by those of this one, which are better.
        if seconds(segment.samples.len() - segment.speech.end) >= segmenter.post_roll_s {
            pending.ask_about(&first);
        }
        Self { sound, segment, first, pending, is_owed: false }
    }

    /// Returns whether it is about the same speech, perhaps with another pause behind it.
    pub(super) fn is_about(&self, sound: u64, segment: &SpeechSegment) -> bool {
        self.sound == sound && self.segment.speech == segment.speech
    }

    /// Takes what was decoded with a longer pause.
    pub(super) fn update(&mut self, segment: SpeechSegment, first: Vec<Hypothesis>) {
        (self.segment, self.first) = (segment, first);
        self.pending.ask_about(&self.first);
    }

    /// Records that the end is certain.
    pub(super) fn owe(&mut self) {
        self.is_owed = true;
        self.pending.ask_about(&self.first);
    }

    /// Returns where the opinion arrives and when it is late.
    pub(super) fn awaited(doubt: Option<&Self>) -> (Receiver<Opinion>, Option<Instant>) {
        match doubt {
            None => (never(), None),
            Some(doubt) => (doubt.pending.opinion().clone(), Some(doubt.pending.until())),
        }
    }

    /// Returns the opinion, or `Some(None)` if it is late or there will be none; `None` as long as it may
    /// come.
    pub(super) fn outcome(&self) -> Option<Option<Opinion>> {
        match self.pending.opinion().try_recv() {
            Ok(opinion) => Some(Some(opinion)),
            Err(TryRecvError::Empty) if Instant::now() < self.pending.until() => None,
            Err(_) => Some(None),
        }
    }

    /// Returns what both recognisers think; without an opinion it is late.
    pub(super) fn settled(self, opinion: Option<Opinion>) -> (u64, SpeechSegment, Heard, bool) {
        let second = opinion.map_or(SecondView::Late, SecondView::Heard);
        (self.sound, self.segment, Heard { first: self.first, second }, self.is_owed)
    }
}
