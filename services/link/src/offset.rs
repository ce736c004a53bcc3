//! Times of one machine's clock on another one. Clocks are never compared: known are only a frame's
//! times of sending, by the sender's clock, and of arrival, by the receiver's.

use service::{Span, Time};

/// Length of the windows over which the shortest way is sought: shorter than clocks take to drift
/// by a millisecond.
const WINDOW: Span = Span::from_ms(20_000);

/// Translates times of a sender's monotonic clock into this machine's. A translated time is late by
/// the shortest way that a frame has taken lately, and never earlier than it was.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offset {
    /// Least difference (arrival minus sending, nanoseconds) of this window and of the one before.
    least: [Option<i128>; 2],
    began: Time,
}

impl Offset {
    /// Takes a frame that was sent at `sent_ns` of the sender's clock and has arrived at `now`.
    pub fn observe(&mut self, sent_ns: u64, now: Time) {
        let [current, _] = self.least;
        if current.is_some() && now >= self.began + WINDOW {
            self.least = [None, current];
        }
        if self.least[0].is_none() {
            self.began = now;
        }
        let difference = i128::from(now.ns()) - i128::from(sent_ns);
        let least = self.least[0].map_or(difference, |least| least.min(difference));
        self.least[0] = Some(least);
    }

    /// Translates a time; 0, for none, and every time before the first frame stay as they are.
    pub fn here(&self, there_ns: u64) -> u64 {
        let Some(least) = self.least.into_iter().flatten().min().filter(|_| there_ns > 0) else {
            return there_ns;
        };
        let here = i128::from(there_ns) + least;
        // A time before this machine's start is the earliest that it knows.
        u64::try_from(here.max(1)).unwrap_or(u64::MAX)
    }
}

/// Age of a time at `now`, nanoseconds; `None` for 0, which means none.
pub fn age_ns(at_ns: u64, now: Time) -> Option<u64> {
    (at_ns > 0).then(|| now.ns().saturating_sub(at_ns))
}

/// The time that is `age_ns` old at `now`; 0 without an age.
pub fn time_ns(age_ns: Option<u64>, now: Time) -> u64 {
    age_ns.map_or(0, |age| now.ns().saturating_sub(age).max(1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    #[test]
    fn times_are_translated_by_the_shortest_way() {
        let mut offset = Offset::default();
        assert_eq!(offset.here(5), 5);
        // The sender's clock is 900 s ahead; frames take 50 ms and more.
        for (sent_ms, way_ms) in [(900_000, 80), (900_100, 50), (900_200, 400)] {
            offset.observe(at(sent_ms).ns(), at(sent_ms - 900_000 + way_ms));
        }
        assert_eq!(offset.here(at(900_150).ns()), at(200).ns());
        assert_eq!(offset.here(0), 0);
        assert_eq!(offset.here(1), 1, "before this machine's start");
    }

    #[test]
    fn drift_is_followed_within_two_windows() {
        let mut offset = Offset::default();
        // 100 ppm: the sender's clock loses 6 ms a minute.
        for s in 0..600_u64 {
            offset.observe(at(s * 1000).ns() - s * 100_000, at(s * 1000 + 50));
        }
        let error_ns = at(599_050).ns() - offset.here(at(599_000).ns() - 599 * 100_000);
        assert!(error_ns <= 4_000_000, "{error_ns}");
    }

    #[test]
    fn ages_survive_the_way() {
        assert_eq!(age_ns(0, at(7)), None);
        assert_eq!(time_ns(None, at(7)), 0);
        let age = age_ns(at(1_000).ns(), at(1_300));
        assert_eq!(time_ns(age, at(50_000)), at(49_700).ns());
        assert_eq!(time_ns(Some(u64::MAX), at(5)), 1, "older than the machine");
        assert_eq!(age_ns(at(9).ns(), at(7)), Some(0), "from the future");
    }
}
