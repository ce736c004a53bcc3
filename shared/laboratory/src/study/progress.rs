//! A bar that fills, on a terminal's standard error and nowhere else.

use std::io::{self, IsTerminal};
use std::time::{Duration, Instant};

use crate::progress::draw;

/// Progress of a long run.
pub(super) struct Progress {
    whole: usize,
    done: usize,
    began: Instant,
    drawn: Option<Instant>,
    shown: bool,
}

/// Runs that end sooner show no bar.
const PATIENCE: Duration = Duration::from_millis(500);
/// Time between two drawings.
const DRAW_EVERY: Duration = Duration::from_millis(100);
/// Cells of the bar.
const WIDTH: usize = 40;

impl Progress {
    /// A run of `whole` steps begins.
    pub(super) fn new(whole: usize) -> Self {
        let shown = io::stderr().is_terminal();
        Self { whole, done: 0, began: Instant::now(), drawn: None, shown }
    }

    /// One step more is done.
    pub(super) fn step(&mut self) {
        self.done += 1;
        let passed = self.began.elapsed();
        let due = self.drawn.is_none_or(|drawn| drawn.elapsed() >= DRAW_EVERY);
        if self.shown && passed >= PATIENCE && due {
            self.drawn = Some(Instant::now());
            draw(&bar(self.done, self.whole, passed));
        }
    }
}

impl Drop for Progress {
    /// Restores the line.
    fn drop(&mut self) {
        if self.drawn.is_some() {
            draw("");
        }
    }
}

fn bar(done: usize, whole: usize, passed: Duration) -> String {
    let share = done as f64 / whole.max(1) as f64;
    let full = ((share * WIDTH as f64) as usize).min(WIDTH);
    let left_s = passed.as_secs_f64() * (1.0 / share.max(1e-9) - 1.0);
    let (bar, rest) = ("█".repeat(full), "·".repeat(WIDTH - full));
    format!("{bar}{rest} {:3.0} %  {left_s:.0} s left", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn progress_bar_shows_the_time_left() {
        let half = bar(5, 10, Duration::from_secs(30));
        assert_eq!(half.matches('█').count(), WIDTH / 2);
        assert_eq!(half.matches('·').count(), WIDTH / 2);
        assert!(half.ends_with(" 50 %  30 s left"), "{half}");
        assert!(bar(10, 10, Duration::from_secs(9)).ends_with("100 %  0 s left"));
        assert!(bar(0, 0, Duration::ZERO).contains("0 %"));
    }
}
