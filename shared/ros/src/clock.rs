//! Stamps of the robot's clock as times of this machine's monotonic clock.

use vocabulary::time::{Span, Time};

/// Fastest that the clocks are assumed to drift apart, as a share: more than crystals and NTP together.
const DRIFT_MAX: f64 = 1e-3;
/// A stamp this much before an earlier one means that the robot's clock was set back.
const SET_BACK: i64 = 100_000_000;

/// Maps the stamps of one connection.
///
/// The least delayed message gives the best bound of the difference between the clocks, so the
/// smallest `arrival - stamp` counts. Between messages it grows by the greatest drift and not more:
/// messages that waited through a stall stay as old as they are, however long it lasted.
#[derive(Debug, Default)]
pub struct StampClock {
    /// Smallest difference so far, ns, with its last use and the latest stamp.
    least: Option<(i64, Time, i64)>,
}

impl StampClock {
    /// Returns when the message with `stamp` (ns) was made, by its `arrival`. A message without a
    /// stamp counts as made when it arrives.
    pub fn map(&mut self, stamp: Option<i64>, arrival: Time) -> Time {
        let Some(stamp) = stamp else { return arrival };
        let now = arrival.ns() as i64;
        let difference = now - stamp;
        let (least, latest) = match self.least {
            Some((least, at, latest)) if stamp > latest - SET_BACK => {
                let Span(ns) = arrival.since(at);
                let drift = (ns as f64 * DRIFT_MAX) as i64;
                (difference.min(least + drift), latest.max(stamp))
            }
            _ => (difference, stamp),
        };
        self.least = Some((least, arrival, latest));
        Time((stamp + least).clamp(0, now) as u64)
    }

    /// Returns the robot's stamp for a time of this machine, ns; `None` before the first stamp.
    pub fn stamp(&self, at: Time) -> Option<i64> {
        self.least.map(|(least, ..)| at.ns() as i64 - least)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: i64 = 1_000_000;
    const S: i64 = 1000 * MS;

    /// Ages of messages in ms, from (stamp, arrival) in ms of clocks that are an hour apart.
    fn ages(messages: impl IntoIterator<Item = (i64, i64)>) -> Vec<f64> {
        let mut clock = StampClock::default();
        let age = |(stamp, arrival): (i64, i64)| {
            let arrival = Time(((7200 * S) + arrival * MS) as u64);
            let at = clock.map(Some(3600 * S + stamp * MS), arrival);
            arrival.since(at).0 as f64 / 1e6
        };
        messages.into_iter().map(age).collect()
    }

    #[test]
    fn data_that_waited_through_a_stall_stay_old() {
        let before = (0..100).map(|n| (10 * n, 10 * n + 1));
        // What was sent during three seconds arrives at once.
        let waited = (100..400).map(|n| (10 * n, 4000));
        let ages = ages(before.chain(waited));
        assert!(ages[..100].iter().all(|age| *age < 0.1), "{ages:?}");
        assert!((ages[100] - 2999.0).abs() < 5.0, "{}", ages[100]);
        assert!((ages[399] - 9.0).abs() < 5.0, "{}", ages[399]);
    }

    #[test]
    fn least_delayed_message_counts_and_drift_is_followed() {
        let jitter = ages((0..500).map(|n| (10 * n, 10 * n + 3 + n * 7 % 40)));
        assert!((jitter[499] - (499 * 7 % 40) as f64).abs() < 1.0, "{}", jitter[499]);
        // Clocks that part by 300 ppm either way, for an hour.
        for drift in [-108, 108] {
            let ages = ages((0..360).map(|n| (10_000 * n, 10_000 * n + 1000 + drift * n / 36)));
            assert!(ages.iter().all(|age| *age < 4.0), "{drift}: {ages:?}");
        }
    }

    #[test]
    fn clock_that_is_set_starts_anew() {
        let steady = (0..100).map(|n| (10 * n, 10 * n));
        for step in [-5000, 5000] {
            let stepped = (100..200).map(|n| (10 * n + step, 10 * n));
            let ages = ages(steady.clone().chain(stepped));
            assert!(ages.iter().all(|age| *age < 1.0), "{step}: {ages:?}");
        }
        // One stamp from the far future spoils nothing.
        let ages = ages(steady.clone().chain([(900_000, 1000)]).chain([(1010, 1010)]));
        assert_eq!(ages[101], 0.0);
    }

    #[test]
    fn message_without_a_stamp_counts_from_its_arrival() {
        assert_eq!(StampClock::default().map(None, Time(5)), Time(5));
    }
}
