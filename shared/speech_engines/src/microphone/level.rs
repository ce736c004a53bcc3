//! Sound level.

use crate::audio::RATE_HZ;
use crate::live_events::QUIETEST_DB;

/// Samples per measurement: a fifth of a second.
const WINDOW: usize = RATE_HZ as usize / 5;

/// Level over the last fifth of a second.
#[derive(Debug)]
pub(super) struct Level {
    squares: f64,
    samples: usize,
    db: f32,
}

impl Default for Level {
    fn default() -> Self {
        Self { squares: 0.0, samples: 0, db: QUIETEST_DB }
    }
}

impl Level {
    /// Processes the next samples. Returns whether there is a new value.
    pub(super) fn push(&mut self, samples: &[i16]) -> bool {
        self.squares += samples.iter().map(|&s| f64::from(s) * f64::from(s)).sum::<f64>();
        self.samples += samples.len();
        if self.samples < WINDOW {
            return false;
        }
        let full = f64::from(i16::MAX) * f64::from(i16::MAX);
        let power = self.squares / self.samples as f64 / full;
        self.db = (10.0 * power.log10()).max(f64::from(QUIETEST_DB)) as f32;
        (self.squares, self.samples) = (0.0, 0);
        true
    }

    /// Returns the root mean square, decibels below full scale.
    pub(super) fn db(&self) -> f32 {
        self.db
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_is_in_decibels_below_full_scale() {
        let mut level = Level::default();
        assert!(!level.push(&[i16::MAX; 1_000]) && level.db() == QUIETEST_DB);
        assert!(level.push(&[i16::MAX; 2_200]) && level.db().abs() < 1e-3);
        assert!(level.push(&[328; 3_200]) && (level.db() + 40.0).abs() < 0.1, "{}", level.db());
        assert!(level.push(&[0; 3_200]) && level.db() == QUIETEST_DB);
    }
}
