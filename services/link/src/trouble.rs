//! Reports of frames that cannot be shown, at a bounded rate, so that nonsense cannot fill the log.

use service::{Span, Time};

/// Shortest interval between two reports.
const REPORT_EVERY: Span = Span::from_ms(10_000);

/// Faults of frames, with counts since the last report.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trouble {
    reported: Option<Time>,
    unreported: u64,
}

impl Trouble {
    /// Counts a frame that is not shown. Returns the number of those that a report at `now` covers,
    /// or `None` if none is due.
    pub fn count(&mut self, now: Time) -> Option<u64> {
        self.unreported += 1;
        if self.reported.is_some_and(|reported| now < reported + REPORT_EVERY) {
            return None;
        }
        self.reported = Some(now);
        Some(std::mem::take(&mut self.unreported))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_of_bad_frames_is_reported_once_in_ten_seconds() {
        let mut trouble = Trouble::default();
        let reports = (0..30_000).filter_map(|ms| trouble.count(Time(0) + Span::from_ms(ms)));
        assert_eq!(reports.collect::<Vec<_>>(), [1, 10_000, 10_000]);
    }
}
