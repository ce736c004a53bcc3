//! The system's clock, which ROS 2 uses, and the monotonic one of the group.

use crate::types::Time as RosTime;
use service::{Time, clock};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

/// Both clocks at one moment.
#[derive(Clone, Copy, Debug)]
pub struct SystemClock {
    monotonic: Time,
    system: Duration,
}

impl SystemClock {
    /// Reads both.
    pub fn now() -> Self {
        let system = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        Self { monotonic: clock::now(), system }
    }

    /// Returns a time of the monotonic clock as ROS has it.
    pub fn ros(&self, at: Time) -> RosTime {
        let age = Duration::from_nanos(self.monotonic.ns().saturating_sub(at.ns()));
        RosTime::new(self.system.saturating_sub(age))
    }

    /// Returns a stamp as a time of the monotonic clock; none if it is not set. A time before the start of
    /// the machine becomes the earliest one, and no stamp is later than this moment.
    pub fn monotonic(&self, stamp: RosTime) -> Option<Time> {
        if stamp == RosTime::default() {
            return None;
        }
        let seconds = u64::try_from(stamp.sec).unwrap_or(0);
        let age =
            self.system.saturating_sub(Duration::new(seconds, stamp.nanosec.min(999_999_999)));
        let age_ns = u64::try_from(age.as_nanos()).unwrap_or(u64::MAX);
        Some(Time(self.monotonic.ns().saturating_sub(age_ns).max(1)))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    #[test]
    fn stamps_are_mapped_both_ways_and_old_ones_stay_old() {
        let clock = SystemClock {
            monotonic: Time(5_000_000_000),
            system: Duration::new(1_000, 500_000_000),
        };
        let at = Time(4_900_000_000);
        assert_eq!(clock.ros(at), RosTime { sec: 1_000, nanosec: 400_000_000 });
        assert_eq!(clock.monotonic(clock.ros(at)), Some(at));
        let stamp = |sec| clock.monotonic(RosTime { sec, nanosec: 1 });
        assert_eq!(stamp(2_000), Some(clock.monotonic), "from the future");
        assert_eq!(stamp(500), Some(Time(1)), "before the machine was started");
        assert_eq!(stamp(-7), Some(Time(1)));
        assert_eq!(clock.monotonic(RosTime::default()), None);
    }
}
