//! Recording times of the samples of a live stream.

use std::collections::VecDeque;

use vocabulary::time::Time;

/// Nanoseconds of one sample at [`RATE_HZ`](crate::RATE_HZ), exactly.
const SAMPLE_NS: i64 = 62_500;
/// Length of an interval over which reads are compared.
const INTERVAL_NS: i64 = 250_000_000;
/// Intervals that are remembered: two seconds.
const INTERVALS: usize = 8;

/// Estimates the recording times of a stream's samples from the times of the reads.
///
/// Each read bounds the beginning of the stream from above: its time minus all samples up to it.
/// The least delayed read is the most accurate, so the earliest beginning within the last two
/// seconds is used. This follows a sound card whose clock drifts (at 300 parts per million the
/// error is 0.6 ms) or that lost samples, and late reads have no effect.
#[derive(Debug, Default)]
pub struct SampleClock {
    /// Samples read.
    taken: i64,
    /// Number and earliest beginning of each interval.
    intervals: VecDeque<(i64, i64)>,
}

impl SampleClock {
    /// Returns the recording time of the first of `count` samples that were read at `now`.
    pub fn read(&mut self, count: usize, now: Time) -> Time {
        let (now, before) = (now.ns() as i64, self.taken);
        self.taken += count as i64;
        let began = now - self.taken * SAMPLE_NS;
        let interval = now / INTERVAL_NS;
        match self.intervals.back_mut() {
            Some((last, earliest)) if *last == interval => *earliest = began.min(*earliest),
            _ => self.intervals.push_back((interval, began)),
        }
        while self.intervals.front().is_some_and(|(s, _)| interval - s >= INTERVALS as i64) {
            self.intervals.pop_front();
        }
        let earliest = self.intervals.iter().map(|(_, began)| *began).min().unwrap_or(began);
        Time((earliest + before * SAMPLE_NS).max(0) as u64)
    }
}

/// Returns the time `samples` after `time`, or before it.
pub fn shifted(time: Time, samples: i64) -> Time {
    Time((time.ns() as i64 + samples * SAMPLE_NS).max(0) as u64)
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: u64 = 1_000_000_000;

    /// Returns the error of the last of many reads of 20 ms, ns; `late` is the delay of each, ns.
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
    fn sample_clock_follows_jitter_drift_and_lost_samples() {
        let jitter = |n: usize| (n as u64 * 7 % 40) * 1_000_000;
        // Half a second is missing from the tenth second on.
        let lost = |n: usize| if n < 500 { 0 } else { S / 2 };
        assert_eq!(error(10, 62_500, |_| 0), 0);
        assert_eq!(error(15, 62_500, lost), (S / 2) as i64);
        for error in
            [error(10, 62_500, jitter), error(600, 62_481, |_| 0), error(600, 62_519, |_| 0)]
        {
            assert!(error.abs() < 1_000_000, "{error} ns");
        }
    }

    #[test]
    fn sample_clock_dates_buffered_samples_back() {
        let mut clock = SampleClock::default();
        assert_eq!(clock.read(48_000, Time(10 * S)), Time(7 * S));
        assert_eq!(shifted(Time(7 * S), 48_000), Time(10 * S));
        assert_eq!(shifted(Time(0), -1), Time(0));
    }
}
