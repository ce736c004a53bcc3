//! Many spoken dialogues, several at a time, counted.

use std::panic::catch_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use serde::Serialize;

use super::dialogue::{Conditions, Told, converse};

/// What came of many dialogues.
#[derive(Clone, Debug, Serialize)]
pub struct Tally {
    /// Signal to noise, decibels.
    pub snr_db: f64,
    /// Every dialogue, in order.
    pub dialogues: Vec<Told>,
}

/// Holds the dialogues `0..count`, so many of them at a time.
///
/// # Panics
/// If a dialogue could not be held at all.
pub fn tally(conditions: Conditions, count: u64, at_a_time: usize, tell: fn(&Told)) -> Tally {
    let next = AtomicU64::new(0);
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..at_a_time.max(1) {
            scope.spawn(|| {
                loop {
                    let number = next.fetch_add(1, Ordering::Relaxed);
                    if number >= count {
                        return;
                    }
                    let told = converse_patiently(Conditions { number, ..conditions });
                    tell(&told);
                    done.lock().expect("no dialogue panicked").push(told);
                }
            });
        }
    });
    let mut dialogues = done.into_inner().expect("no dialogue panicked");
    dialogues.sort_by_key(|told| told.number);
    Tally { snr_db: conditions.snr_db, dialogues }
}

/// A machine that is too busy to start a group gets another try: that says nothing about speech.
fn converse_patiently(conditions: Conditions) -> Told {
    catch_unwind(|| converse(conditions)).unwrap_or_else(|_| converse(conditions))
}

impl Tally {
    /// Dialogues in which the right object was brought.
    pub fn right(&self) -> usize {
        self.dialogues.iter().filter(|told| told.is_right()).count()
    }

    /// Wilson's interval of 95 % for the share of right ones.
    pub fn interval(&self) -> (f64, f64) {
        wilson(self.right(), self.dialogues.len())
    }

    /// The mean of something over the dialogues.
    pub fn mean(&self, of: impl Fn(&Told) -> f64) -> f64 {
        self.dialogues.iter().map(of).sum::<f64>() / self.dialogues.len().max(1) as f64
    }

    /// The sum of something over the dialogues.
    pub fn sum(&self, of: impl Fn(&Told) -> u32) -> u32 {
        self.dialogues.iter().map(of).sum()
    }
}

/// Wilson's score interval of 95 % (Wilson 1927).
pub fn wilson(hits: usize, of: usize) -> (f64, f64) {
    if of == 0 {
        return (0.0, 1.0);
    }
    const Z: f64 = 1.959_964;
    let (n, p) = (of as f64, hits as f64 / of as f64);
    let centre = p + Z * Z / (2.0 * n);
    let half = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    let scale = 1.0 + Z * Z / n;
    (((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_is_wilson_s() {
        let (low, high) = wilson(59, 60);
        assert!((low - 0.911_4).abs() < 5e-4 && (high - 0.997_1).abs() < 5e-4, "{low} {high}");
        assert_eq!(wilson(0, 0), (0.0, 1.0));
        let (low, high) = wilson(60, 60);
        assert!((low - 0.939_8).abs() < 5e-4 && high > 0.999_99, "{low} {high}");
    }
}
