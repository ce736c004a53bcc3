//! Wall-clock times for monotonic stamps, and their names.

use std::time::{SystemTime, UNIX_EPOCH};

use service::{Time, clock, wall_time};

/// Nanoseconds of a second.
const SECOND: u64 = 1_000_000_000;
/// Change of the offset from which on the wall clock has been set, or the machine has slept.
const STEP_NS: u64 = SECOND / 2;

/// The offset between the wall clock and the monotonic clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct WallClock {
    /// Difference between nanoseconds since 1970 and the monotonic time.
    pub offset_ns: u64,
}

impl WallClock {
    /// Reads both clocks.
    pub fn read() -> Self {
        let wall = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let wall_ns = u64::try_from(wall.as_nanos()).unwrap_or(u64::MAX);
        Self { offset_ns: wall_ns.saturating_sub(clock::now().ns()) }
    }

    /// Returns nanoseconds since 1970.
    pub fn wall_ns(self, at: Time) -> u64 {
        self.offset_ns.saturating_add(at.ns())
    }

    /// Returns whether one of the two clocks has jumped between the two readings.
    pub fn has_jumped(self, later: Self) -> bool {
        self.offset_ns.abs_diff(later.offset_ns) > STEP_NS
    }
}

/// The name of a moment, e.g. `2026-11-25T10-08-19.250Z`: sorted by name is sorted by time.
pub fn name(wall_ns: u64) -> String {
    wall_time::text(wall_ns).replace(':', "-")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn jump_of_the_wall_clock_is_noticed_and_drift_is_not() {
        let clock = WallClock { offset_ns: 1 << 60 };
        assert_eq!(clock.wall_ns(Time(7)), (1 << 60) + 7);
        assert!(!clock.has_jumped(WallClock { offset_ns: (1 << 60) + 1_000_000 }));
        assert!(clock.has_jumped(WallClock { offset_ns: (1 << 60) - SECOND }));
    }
}
