//! An utterance about which the second recogniser was asked.

use std::time::{Duration, Instant};

use crossbeam_channel::{Receiver, TryRecvError, never};
use service::clock;
use speech_engines::audio::seconds;
use speech_engines::recogniser::{FirstView, Opinion, PendingOpinion};
use speech_engines::stream::SpeechSegment;

use crate::hearing::Ensemble;

/// An utterance that the second recogniser listens to while the first one decodes it. Dropping it
/// makes it stop.
pub(super) struct Listening {
    sound: u64,
    segment: SpeechSegment,
    pending: PendingOpinion,
}

impl Listening {
    /// Lets the second recogniser listen to the segment until a time after the voice; `None` if
    /// that is over, or without a second recogniser.
    pub(super) fn begin(
        recognisers: &Ensemble,
        sound: u64,
        segment: &SpeechSegment,
        patience: Duration,
    ) -> Option<Self> {
        let ago = Duration::from_secs_f64(clock::now().since(segment.end).s());
        let until = Instant::now() + patience.checked_sub(ago)?;
        let pending = recognisers.second_listens(&segment.samples, &segment.speech, until)?;
        Some(Self { sound, segment: segment.clone(), pending })
    }

    /// Asks for an opinion on the first recogniser's hypotheses, which are about the segment with
    /// as much of the pause as `post_roll_s`, seconds, or about an earlier one.
    pub(super) fn doubted(self, first: FirstView, post_roll_s: f64) -> Doubt {
        let Self { sound, segment, pending } = self;
        // The hypotheses of an earlier pause are followed by those of this one, which are better.
        if seconds(segment.samples.len() - segment.speech.end) >= post_roll_s {
            pending.ask_about(&first.hypotheses);
        }
        Doubt { sound, segment, first, pending, is_owed: false }
    }
}

/// An utterance about which the second recogniser was asked.
pub(super) struct Doubt {
    pub(super) sound: u64,
    /// The samples that were decoded.
    pub(super) segment: SpeechSegment,
    pub(super) first: FirstView,
    pending: PendingOpinion,
    /// `true` if its end is certain, so that a result is owed.
    pub(super) is_owed: bool,
}

impl Doubt {
    /// Returns whether it is about the same speech, perhaps with another pause behind it.
    pub(super) fn is_about(&self, sound: u64, segment: &SpeechSegment) -> bool {
        self.sound == sound && self.segment.speech == segment.speech
    }

    /// Takes the result of decoding with a longer pause.
    pub(super) fn update(&mut self, segment: SpeechSegment, first: FirstView) {
        (self.segment, self.first) = (segment, first);
        self.pending.ask_about(&self.first.hypotheses);
    }

    /// Records that the end is certain.
    pub(super) fn owe(&mut self) {
        self.is_owed = true;
        self.pending.ask_about(&self.first.hypotheses);
    }

    /// Returns the opinion's channel and the time after which it is late.
    pub(super) fn awaited(doubt: Option<&Self>) -> (Receiver<Opinion>, Option<Instant>) {
        match doubt {
            None => (never(), None),
            Some(doubt) => (doubt.pending.opinion().clone(), Some(doubt.pending.until())),
        }
    }

    /// Returns the opinion, or `Some(None)` if it is late or there will be none; `None` as long as
    /// it may come.
    pub(super) fn outcome(&self) -> Option<Option<Opinion>> {
        match self.pending.opinion().try_recv() {
            Ok(opinion) => Some(Some(opinion)),
            Err(TryRecvError::Empty) if Instant::now() < self.pending.until() => None,
            Err(_) => Some(None),
        }
    }
}
