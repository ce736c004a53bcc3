//! Times at which the robot itself speaks.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use vocabulary::time::{Span, Time};

/// Playbacks that are remembered: samples arrive some tenths of a second after they were recorded.
const PLAYBACKS_MAX: usize = 8;

/// The robot's own sound in a microphone of the room.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum OwnVoice {
    /// Nothing.
    #[default]
    Silent,
    /// Rest of the voice in the room and in the buffers of the sound card.
    Echo,
    /// The voice itself.
    Speaking,
}

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
    /// Returns the mask of a silent robot; `echo` covers the reverberation of the room and the
    /// buffers of the sound card.
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

    /// Returns the robot's own sound that a microphone may record at `at`.
    pub fn own_voice(&self, at: Time) -> OwnVoice {
        let own_voice = |(began, ended): &(Time, Option<Time>)| match ended {
            _ if at < *began => OwnVoice::Silent,
            Some(ended) if at >= *ended + self.echo => OwnVoice::Silent,
            Some(ended) if at >= *ended => OwnVoice::Echo,
            _ => OwnVoice::Speaking,
        };
        self.playbacks().iter().map(own_voice).max().unwrap_or_default()
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
        let is = |at, expected: OwnVoice| assert_eq!(mask.own_voice(ms(at)), expected, "{at} ms");
        is(0, OwnVoice::Silent);
        mask.begins(ms(1_000));
        is(999, OwnVoice::Silent);
        is(1_000, OwnVoice::Speaking);
        is(9_000, OwnVoice::Speaking);
        mask.ends(ms(2_000));
        mask.ends(ms(5_000));
        is(1_999, OwnVoice::Speaking);
        is(2_299, OwnVoice::Echo);
        is(2_300, OwnVoice::Silent);
        mask.begins(ms(2_200));
        is(2_250, OwnVoice::Speaking);
        is(1_500, OwnVoice::Speaking);
        (0..100).for_each(|n| mask.begins(ms(10_000 + n)));
        assert!(mask.playbacks().len() <= PLAYBACKS_MAX);
    }
}
