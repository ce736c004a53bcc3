//! Loudness of a voice and of its surroundings.
//!
//! The detector of speech notices the end of a voice about 90 ms late, whatever the pause is; the
//! level falls at once. So a frame within a segment is voice only while it is louder than the
//! background and not far below the voice so far.

/// Frames this far below the loudest of the segment are quiet, decibels.
const QUIET_DB: f32 = -35.0;
/// Frames no louder than the background by this are quiet, decibels.
const ABOVE_BACKGROUND_DB: f32 = 6.0;
/// Nothing is quiet that is nearer to the loudest frame than this, decibels: soft endings of words.
const NEAR_VOICE_DB: f32 = -18.0;
/// Share of a new frame in the background, when it is louder and when it is quieter than so far.
const RISE: f32 = 0.02;
const FALL: f32 = 0.25;
/// Frames from which on the background is known: a stream may begin within a voice.
const BACKGROUND_FRAMES_MIN: usize = 8;
/// Level of digital silence, decibels below full scale.
const SILENCE_DB: f32 = -96.0;

/// Levels of a stream, decibels relative to full scale.
#[derive(Debug)]
pub(super) struct Loudness {
    /// Level of frames outside segments, and their number.
    background_db: f32,
    background_frames: usize,
    /// Level of the loudest frame of the segment in progress.
    voice_db: Option<f32>,
}

impl Default for Loudness {
    fn default() -> Self {
        Self { background_db: SILENCE_DB, background_frames: 0, voice_db: None }
    }
}

impl Loudness {
    /// Takes the level of the next frame. Returns whether it is loud enough for a voice: always
    /// outside segments, lest a soft beginning be lost.
    pub(super) fn is_voice(&mut self, level_db: f32, is_open: bool) -> bool {
        if !is_open {
            self.voice_db = None;
            self.take_background(level_db);
            return true;
        }
        let voice_db = self.voice_db.map_or(level_db, |voice_db| voice_db.max(level_db));
        self.voice_db = Some(voice_db);
        let mut quiet_db = voice_db + QUIET_DB;
        if self.background_frames >= BACKGROUND_FRAMES_MIN {
            quiet_db = quiet_db.max(self.background_db + ABOVE_BACKGROUND_DB);
        }
        level_db > quiet_db.min(voice_db + NEAR_VOICE_DB)
    }

    fn take_background(&mut self, level_db: f32) {
        let share = match level_db > self.background_db {
            _ if self.background_frames == 0 => 1.0,
            true => RISE,
            false => FALL,
        };
        self.background_db += share * (level_db - self.background_db);
        self.background_frames += 1;
    }
}

/// Returns the level of samples, decibels relative to full scale.
pub(crate) fn level_db(frame: &[i16]) -> f32 {
    let square = |sample: &i16| (f32::from(*sample) / 32_768.0).powi(2);
    let mean = frame.iter().map(square).sum::<f32>() / frame.len().max(1) as f32;
    (10.0 * mean.log10()).max(SILENCE_DB)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frame_is_voice_by_its_level_relative_to_voice_and_background() {
        for (what, background_db, level_db, expected) in [
            ("soft ending in a quiet room", -80.0, -50.0, true),
            ("far below the voice", -80.0, -58.0, false),
            ("background of a usual room", -45.0, -44.0, false),
            ("soft ending in a usual room", -45.0, -37.0, true),
            ("near the voice, however loud the background is", -22.0, -32.0, true),
        ] {
            let mut loudness = Loudness::default();
            for _ in 0..40 {
                assert!(loudness.is_voice(background_db, false), "{what}");
            }
            assert!(loudness.is_voice(-20.0, true), "{what}");
            assert_eq!(loudness.is_voice(level_db, true), expected, "{what}");
        }
    }

    #[test]
    fn frames_of_a_stream_that_begins_within_a_voice_are_judged_by_the_voice() {
        let mut loudness = Loudness::default();
        (0..3).for_each(|_| assert!(loudness.is_voice(-20.0, false)));
        assert!(loudness.is_voice(-30.0, true));
        assert!(loudness.is_voice(-45.0, true), "{loudness:?}");
        assert!(!loudness.is_voice(-80.0, true), "{loudness:?}");
    }
}
