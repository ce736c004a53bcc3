//! Timestamps of a viewer's samples, robust against wrong clocks.

use service::{Span, Time};

const SAMPLE_NS: u64 = 62_500;
/// Longest time that sound may take to arrive.
const OLDEST: Span = Span::from_ms(3_000);
/// A clock that deviates more from the samples before has jumped.
const JUMP: Span = Span::from_ms(100);

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Timestamps {
    /// The number of a sample, its time, and whether the viewer claimed that time.
    known: Option<(u64, Time, bool)>,
}

impl Timestamps {
    /// Returns when sample `number`, the first of `count`, was recorded: as `claimed`, if that is
    /// plausible. Times in the future or older than three seconds, and jumps of the clock within a
    /// stream, are replaced from the samples before, else from the time of arrival.
    pub(super) fn taken(
        &mut self,
        claimed: Time,
        number: u64,
        count: usize,
        arrived: Time,
    ) -> Time {
        let latest = Time(arrived.ns().saturating_sub(count as u64 * SAMPLE_NS));
        let earliest = Time(arrived.ns().saturating_sub(OLDEST.0));
        let can_be = |time: Time| (earliest..=latest).contains(&time);
        let expected = self.known.and_then(|(known, time, said)| {
            let since = number.checked_sub(known)?.checked_mul(SAMPLE_NS)?;
            let time = Time(time.ns().checked_add(since)?);
            can_be(time).then_some((time, said))
        });
        let (taken, said) = match expected {
            Some((time, true)) if !can_be(claimed) || apart(claimed, time) > JUMP => (time, true),
            Some((time, false)) if !can_be(claimed) => (time, false),
            _ if can_be(claimed) => (claimed, true),
            _ => (latest, false),
        };
        self.known = Some((number, taken, said));
        taken
    }
}

fn apart(a: Time, b: Time) -> Span {
    Span(a.ns().abs_diff(b.ns()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TENTH: usize = 1_600;

    fn ms(ms: u64) -> Time {
        Time(ms * 1_000_000)
    }

    /// Returns the timestamps of frames of 100 ms, the first recorded at 100 s, each arriving 150
    /// ms after its beginning, given the times that the viewer's clock claims.
    fn times(claimed_ms: &[u64]) -> Vec<u64> {
        let mut timestamps = Timestamps::default();
        let taken = claimed_ms.iter().enumerate().map(|(n, claimed)| {
            let (number, arrived) = (n as u64 * TENTH as u64, ms(100_150 + n as u64 * 100));
            timestamps.taken(ms(*claimed), number, TENTH, arrived).ns() / 1_000_000
        });
        taken.collect()
    }

    #[test]
    fn timestamps_follow_plausible_clocks_only() {
        for (clock, claimed, taken) in [
            ("right", &[100_000, 100_101, 100_199][..], &[100_000, 100_101, 100_199][..]),
            ("ahead: the arrival counts", &[200_000, 200_100], &[100_050, 100_150]),
            ("behind: the arrival counts", &[5, 96_000], &[100_050, 100_150]),
            ("corrected", &[0, 100_090, 100_190], &[100_050, 100_090, 100_190]),
            (
                "jumping: the samples before count",
                &[100_000, 98_500, 98_600, 100_300, 99_000_000],
                &[100_000, 100_100, 100_200, 100_300, 100_400],
            ),
        ] {
            assert_eq!(times(claimed), taken, "{clock}");
        }
    }

    #[test]
    fn timestamps_survive_arbitrary_numbers() {
        let mut timestamps = Timestamps::default();
        assert_eq!(timestamps.taken(ms(10), u64::MAX, TENTH, ms(1_000)), ms(10));
        assert_eq!(timestamps.taken(Time(u64::MAX), 0, TENTH, Time(5)), Time(0));
        timestamps.taken(ms(10), 0, TENTH, ms(1_000));
        assert_eq!(timestamps.taken(Time(u64::MAX), u64::MAX, TENTH, ms(1_100)), ms(1_000));
    }
}
