//! Many spoken dialogues, several at a time, counted.

use std::panic::catch_unwind;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};

use serde::Serialize;
use user_study::wilson;

use super::dialogue::{Conditions, Ending, Held, converse};

/// Results of many dialogues.
#[derive(Clone, Debug, Serialize)]
pub struct Tally {
    /// Signal to noise, decibels.
    pub snr_db: f64,
    /// Every dialogue, in order.
    pub dialogues: Vec<Held>,
}

/// Holds the dialogues `0..count`, `at_a_time` of them in parallel.
///
/// # Panics
/// If a dialogue cannot be held at all.
pub fn tally(conditions: Conditions, count: u64, at_a_time: usize, report: fn(&Held)) -> Tally {
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
                    let held = converse_or_retry(Conditions { number, ..conditions });
                    report(&held);
                    done.lock().expect("no dialogue panicked").push(held);
                }
            });
        }
    });
    let mut dialogues = done.into_inner().expect("no dialogue panicked");
    dialogues.sort_by_key(|held| held.number);
    Tally { snr_db: conditions.snr_db, dialogues }
}

/// Retries once where the machine is too busy to start a group: that says nothing about speech.
fn converse_or_retry(conditions: Conditions) -> Held {
    catch_unwind(|| converse(conditions)).unwrap_or_else(|_| converse(conditions))
}

impl Tally {
    /// Number of dialogues that ended like this.
    pub fn ended(&self, ending: Ending) -> usize {
        self.dialogues.iter().filter(|held| held.ending() == ending).count()
    }

    /// Wilson's interval of 95 % for the share of right ones.
    pub fn interval(&self) -> (f64, f64) {
        let interval = wilson(self.ended(Ending::Right) as u64, self.dialogues.len() as u64);
        (interval.low, interval.high)
    }

    /// The mean of something over the dialogues.
    pub fn mean(&self, of: impl Fn(&Held) -> f64) -> f64 {
        self.dialogues.iter().map(of).sum::<f64>() / self.dialogues.len().max(1) as f64
    }

    /// The sum of something over the dialogues.
    pub fn sum(&self, of: impl Fn(&Held) -> u32) -> u32 {
        self.dialogues.iter().map(of).sum()
    }
}
