//! Times at which the robot itself speaks.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use service::{Span, Time};

/// Playbacks that are remembered: samples arrive some tenths of a second after they were recorded.
const PLAYBACKS_MAX: usize = 8;

/// Times of the robot's own voice, which a microphone in the room records as well. Shared between
/// voice and microphones.
#[derive(Debug)]
pub struct PlaybackMask {
    /// Duration of the echo after a playback.
    echo: Span,
    /// Beginning and end of the latest playbacks.
    playbacks: Mutex<VecDeque<(Time, Option<Time>)>>,
}

impl PlaybackMask {
    /// Returns the mask of a silent robot; `echo` covers the reverberation of the room and the buffers of
    /// the sound card.
    pub fn new(echo: Span) -> Self {
        Self { echo, playbacks: Mutex::default() }
    }

    /// Records the beginning of a playback.
    pub fn begins(&self, at: Time) {
        let mut playbacks = self.playbacks();
        if playbacks.len() >= PLAYBACKS_MAX {
            playbacks.pop_front();
        }
        playbacks.push_back((at, None));
    }

    /// Records the end of the playback.
    pub fn ends(&self, at: Time) {
        if let Some((_, end @ None)) = self.playbacks().back_mut() {
            *end = Some(at);
        }
    }

    /// Returns whether a microphone may record the robot itself at `at`.
    pub fn covers(&self, at: Time) -> bool {
        let covers = |(began, ended): &(Time, Option<Time>)| {
            *began <= at && ended.is_none_or(|ended| at < ended + self.echo)
        };
        self.playbacks().iter().any(covers)
    }

    fn playbacks(&self) -> MutexGuard<'_, VecDeque<(Time, Option<Time>)>> {
        // Every statement leaves the list consistent.
        self.playbacks.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn playback_mask_covers_playback_and_echo() {
        let mask = PlaybackMask::new(Span::from_ms(300));
        let ms = |ms: u64| Time(ms * 1_000_000);
        assert!(!mask.covers(ms(0)));
        mask.begins(ms(1_000));
        assert!(!mask.covers(ms(999)) && mask.covers(ms(1_000)) && mask.covers(ms(9_000)));
        mask.ends(ms(2_000));
        mask.ends(ms(5_000));
        assert!(mask.covers(ms(2_299)) && !mask.covers(ms(2_300)));
        mask.begins(ms(3_000));
        assert!(mask.covers(ms(1_500)), "late samples are judged by their own time");
        (0..100).for_each(|n| mask.begins(ms(10_000 + n)));
        assert!(mask.playbacks().len() <= PLAYBACKS_MAX);
    }
}
