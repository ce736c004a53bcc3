//! Time that this process has spent on making its journal durable.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

static SYNCS: AtomicU64 = AtomicU64::new(0);
static TIME_US: AtomicU64 = AtomicU64::new(0);

/// Runs one sync, and counts it with its time.
pub fn measure<T>(sync: impl FnOnce() -> T) -> T {
    let began = Instant::now();
    let result = sync();
    let us = u64::try_from(began.elapsed().as_micros()).unwrap_or(u64::MAX);
    SYNCS.fetch_add(1, Ordering::Relaxed);
    TIME_US.fetch_add(us, Ordering::Relaxed);
    result
}

/// Returns the number of syncs so far, and the time that they took.
pub(crate) fn total() -> (u64, Duration) {
    (SYNCS.load(Ordering::Relaxed), Duration::from_micros(TIME_US.load(Ordering::Relaxed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn syncs_are_counted_with_their_time() {
        let before = total();
        assert_eq!(measure(|| std::thread::sleep(Duration::from_millis(2))), ());
        let after = total();
        assert!(after.0 > before.0 && after.1 >= before.1 + Duration::from_millis(2), "{after:?}");
    }
}
