//! Voices in the background: other people who talk, a television.
//!
//! The detector of speech finds speech in them all the time, so no utterance would begin or end.
//! The user is nearer to the microphone: only sound louder than those voices is the user's.

use std::collections::VecDeque;

/// Frames by which the background is judged: 20 s. Nobody talks to the robot for that long without
/// a pause.
const FRAMES: usize = 1_250;
/// Frames from which on several voices at once are known: 3 s.
const MANY_FRAMES_MIN: usize = 190;
/// Frames from which on a few voices are known: 15 s. A request of less than that may fill them.
const FEW_FRAMES_MIN: usize = 940;
/// Several voices at once: at least this share of the quieter half of the frames is speech to the
/// detector (0.02 to 0.1 in steady noise) ...
const MANY_SHARE_MIN: f32 = 0.12;
/// ... and their median is at most this far above their 10th percentile, decibels: 5 with six
/// voices, 12 with two, 18 within one request in a quiet room.
const MANY_SPREAD_DB: usize = 7;
/// A few voices: their quieter half is speech nearly always.
const FEW_SHARE_MIN: f32 = 0.97;
/// How far the user is above the median of the background, in units of that spread, and decibels at
/// least and at most.
const ABOVE_SPREAD: f32 = 1.2;
const ABOVE_DB: (f32, f32) = (4.0, 8.0);
/// Frames over which the level is averaged: syllables of a voice differ by less than its frames.
const SMOOTHED: usize = 3;
/// Frames for which a voice continues after its level has fallen: soft ends of words.
const HELD: usize = 6;
/// Level of digital silence, e.g. in place of the robot's own voice, decibels: not background.
const SILENCE_DB: f32 = -90.0;
/// Number of levels, 1 dB each, downwards from full scale.
const LEVELS: usize = 97;

/// Loudness of the voices in the background.
#[derive(Debug)]
pub(super) struct Babble {
    /// Level of each of the latest frames, decibels below full scale, and whether it was speech.
    frames: VecDeque<(u8, bool)>,
    /// Number of frames, and of those with speech, by level.
    counts: [(u16, u16); LEVELS],
    /// Powers of the latest frames.
    powers: [f32; SMOOTHED],
    /// Frames since the user was louder than the background.
    since_loud: usize,
}

impl Default for Babble {
    fn default() -> Self {
        Self {
            frames: VecDeque::with_capacity(FRAMES),
            counts: [(0, 0); LEVELS],
            powers: [0.0; SMOOTHED],
            since_loud: HELD,
        }
    }
}

impl Babble {
    /// Takes the next frame, of this level in decibels relative to full scale. Returns whether its
    /// speech, if it is speech, may be the user's.
    pub(super) fn is_user(&mut self, level_db: f32, is_speech: bool) -> bool {
        self.powers.rotate_left(1);
        self.powers[SMOOTHED - 1] = 10_f32.powf(level_db / 10.0);
        if level_db > SILENCE_DB {
            self.keep(level_db, is_speech);
        }
        let Some(least_db) = self.user_least_db() else { return true };
        let smoothed_db = 10.0 * (self.powers.iter().sum::<f32>() / SMOOTHED as f32).log10();
        self.since_loud = if smoothed_db > least_db { 0 } else { self.since_loud + 1 };
        self.since_loud < HELD
    }

    fn keep(&mut self, level_db: f32, is_speech: bool) {
        if self.frames.len() == FRAMES
            && let Some((level, was_speech)) = self.frames.pop_front()
        {
            let (all, speech) = &mut self.counts[usize::from(level)];
            *all -= 1;
            *speech -= u16::from(was_speech);
        }
        let level = (-level_db).round().clamp(0.0, (LEVELS - 1) as f32) as u8;
        self.frames.push_back((level, is_speech));
        let (all, speech) = &mut self.counts[usize::from(level)];
        *all += 1;
        *speech += u16::from(is_speech);
    }

    /// Returns the level from which on a voice is the user's, if there are other voices.
    fn user_least_db(&self) -> Option<f32> {
        let frames = self.frames.len();
        if frames < MANY_FRAMES_MIN {
            return None;
        }
        let (median, share) = self.quieter(0.5);
        let spread = self.quieter(0.1).0 - median;
        let many = share >= MANY_SHARE_MIN && spread <= MANY_SPREAD_DB;
        let few = share >= FEW_SHARE_MIN && frames >= FEW_FRAMES_MIN;
        let above_db = (ABOVE_SPREAD * spread as f32).clamp(ABOVE_DB.0, ABOVE_DB.1);
        (many || few).then_some(above_db - median as f32)
    }

    /// Returns the level below which this part of the frames lies, decibels below full scale, and
    /// the share of speech there.
    fn quieter(&self, part: f32) -> (usize, f32) {
        let wanted = (part * self.frames.len() as f32).ceil() as u32;
        let (mut all, mut speech) = (0, 0);
        for (level, counts) in self.counts.iter().enumerate().rev() {
            all += u32::from(counts.0);
            speech += u32::from(counts.1);
            if all >= wanted {
                return (level, speech as f32 / all.max(1) as f32);
            }
        }
        (0, 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Rng, signed};

    /// Level of the user's voice, decibels.
    const USER_DB: f32 = -25.0;

    /// Takes seconds of a background with levels spread evenly around `level_db`, partly speech.
    fn background(babble: &mut Babble, seconds: f64, level_db: f32, spread_db: f32, share: f32) {
        let mut rng = Rng::new(7);
        for n in 0..(seconds / 0.016) as usize {
            let is_speech = (n as f32 * share).fract() + share >= 1.0;
            babble.is_user(level_db + spread_db * signed(&mut rng), is_speech);
        }
    }

    fn user_frames(babble: &mut Babble, level_db: f32) -> usize {
        (0..20).filter(|_| babble.is_user(level_db, true)).count()
    }

    #[test]
    fn voices_in_the_background_are_not_the_user() {
        for (what, seconds, spread_db, share) in [
            ("several voices", 4.0, 5.0, 1.0),
            ("several distant voices", 4.0, 5.0, 0.4),
            ("two voices", 16.0, 14.0, 1.0),
        ] {
            let mut babble = Babble::default();
            background(&mut babble, seconds, -36.0, spread_db, share);
            assert!(user_frames(&mut babble, USER_DB) > 20 - SMOOTHED, "{what}");
            let after = user_frames(&mut babble, -36.0);
            assert!((HELD..HELD + SMOOTHED).contains(&after), "{what}: {after} frames");
        }
    }

    #[test]
    fn every_voice_may_be_the_user_where_nobody_else_talks() {
        for (what, seconds, spread_db, share) in [
            ("unknown", 1.0, 5.0, 1.0),
            ("steady noise", 30.0, 1.0, 0.05),
            ("one request in a quiet room", 12.0, 20.0, 0.96),
        ] {
            let mut babble = Babble::default();
            background(&mut babble, seconds, -36.0, spread_db, share);
            assert_eq!(user_frames(&mut babble, -40.0), 20, "{what}");
        }
    }

    #[test]
    fn a_voice_that_is_cut_out_is_no_background() {
        let mut babble = Babble::default();
        background(&mut babble, 4.0, -36.0, 5.0, 1.0);
        (0..FRAMES).for_each(|_| assert!(!babble.is_user(-96.0, false)));
        assert!(user_frames(&mut babble, USER_DB) > 20 - SMOOTHED);
    }

    #[test]
    fn voices_that_have_left_are_forgotten() {
        let mut babble = Babble::default();
        background(&mut babble, 4.0, -36.0, 5.0, 1.0);
        background(&mut babble, 21.0, -60.0, 1.0, 0.0);
        assert_eq!(user_frames(&mut babble, -40.0), 20);
    }
}
