//! When each sample of a live stream was taken.

use std::collections::VecDeque;

use service::Time;

/// Nanoseconds of one sample at [`RATE_HZ`](crate::devices::audio::RATE_HZ), exactly.
const SAMPLE_NS: i64 = 62_500;
/// Reads are compared in stretches of this length.
const STRETCH_NS: i64 = 250_000_000;
/// Stretches that are remembered: two seconds.
const STRETCHES: usize = 8;

/// Tells the time of the samples of one stream from when they were read.
///
/// A read tells when the stream began at the latest: its own time less all samples up to it. What
/// was read with the least delay is right, so the earliest beginning of the last two seconds
/// counts. That follows a sound card whose clock drifts (at 300 parts in a million the error is
/// 0.6 ms) and one that lost samples, and a read that came late does not show.
#[derive(Debug, Default)]
pub struct SampleClock {
    /// Samples read.
    taken: i64,
    /// The earliest beginning that a read of the stretch told, with the stretch's number.
    stretches: VecDeque<(i64, i64)>,
}

impl SampleClock {
    /// `count` samples were read at `now`: when was the first of them taken?
    pub fn read(&mut self, count: usize, now: Time) -> Time {
        let (now, before) = (now.ns() as i64, self.taken);
        self.taken += count as i64;
        let began = now - self.taken * SAMPLE_NS;
        let stretch = now / STRETCH_NS;
        match self.stretches.back_mut() {
            Some((last, earliest)) if *last == stretch => *earliest = began.min(*earliest),
            _ => self.stretches.push_back((stretch, began)),
        }
        while self.stretches.front().is_some_and(|(s, _)| stretch - s >= STRETCHES as i64) {
            self.stretches.pop_front();
        }
        let earliest = self.stretches.iter().map(|(_, began)| *began).min().unwrap_or(began);
        Time((earliest + before * SAMPLE_NS).max(0) as u64)
    }
}

/// The time `samples` after `time`, or before it.
pub(crate) fn shifted(time: Time, samples: i64) -> Time {
    Time((time.ns() as i64 + samples * SAMPLE_NS).max(0) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: u64 = 1_000_000_000;

    /// Reads 20 ms each for `seconds`, `late` ns behind by number; the error of the last, ns.
    fn error(seconds: usize, sample_ns: u64, late: impl Fn(usize) -> u64) -> i64 {
        let mut clock = SampleClock::default();
        let mut error = 0;
        for n in 0..seconds * 50 {
            let first = 100 * S + (n * 320) as u64 * sample_ns;
            let now = Time(first + 320 * sample_ns + late(n));
            error = clock.read(320, now).ns() as i64 - first as i64;
        }
        error
    }

    #[test]
    fn the_least_delayed_read_of_the_last_two_seconds_counts() {
        assert_eq!(error(10, 62_500, |_| 0), 0);
        let jitter = |n: usize| (n as u64 * 7 % 40) * 1_000_000;
        assert!(error(10, 62_500, jitter) < 1_000_000, "{}", error(10, 62_500, jitter));
    }

    #[test]
    fn a_sound_card_that_is_slow_or_fast_is_followed() {
        for sample_ns in [62_481, 62_519] {
            let error = error(600, sample_ns, |_| 0);
            assert!(error.abs() < 1_000_000, "{error} ns after ten minutes");
        }
    }

    #[test]
    fn lost_samples_are_made_up_for() {
        // Half a second is missing from the tenth second on.
        let lost = |n: usize| if n < 500 { 0 } else { S / 2 };
        let error = error(15, 62_500, lost) - (S / 2) as i64;
        assert_eq!(error, 0);
    }

    #[test]
    fn what_is_read_at_once_was_said_before() {
        let mut clock = SampleClock::default();
        assert_eq!(clock.read(48_000, Time(10 * S)), Time(7 * S));
        assert_eq!(shifted(Time(7 * S), 48_000), Time(10 * S));
        assert_eq!(shifted(Time(0), -1), Time(0));
    }
}
