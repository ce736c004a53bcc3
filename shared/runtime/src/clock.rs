//! The machine's monotonic clock: one for all processes, so that times travel with messages.

use crate::Time;
use rustix::time::{ClockId, clock_gettime};

/// Returns the current time.
pub fn now() -> Time {
    let t = clock_gettime(ClockId::Monotonic);
    Time(t.tv_sec.unsigned_abs() * 1_000_000_000 + t.tv_nsec.unsigned_abs())
}
