//! Restart limiter: backoff of restarts, and giving up after too many exits.

use std::collections::VecDeque;
use std::time::Duration;

use crate::Time;
use crate::configuration::RestartLimits;

/// The unrequested exits of one service.
#[derive(Clone, Debug, Default)]
pub(crate) struct RestartLimiter {
    /// Exits that may still lie within the window, oldest first; never more than `exits_max`.
    exits: VecDeque<Time>,
    /// Pauses since the last reset: the exponent of the next one.
    pauses: u32,
    /// True if the one restart without backoff has been used since the last reset.
    spared: bool,
}

/// Consequence of an unrequested exit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Start again at once.
    Again,
    /// Start again after this pause.
    After(Duration),
    /// Too many exits: do not start again.
    GiveUp {
        /// Exits within the window.
        exits: u32,
    },
}

impl RestartLimiter {
    /// Counts an exit at `now` of an incarnation that had been ready for `ready_for` (`None`: it
    /// never was) and returns the consequence.
    ///
    /// The first exit of a service that had been ready is followed by a restart at once, since a service that
    /// works and is killed from outside should be back soon; one that never became ready always
    /// waits, so that a broken one cannot spin.
    pub(crate) fn count(
        &mut self,
        limits: &RestartLimits,
        ready_for: Option<Duration>,
        now: Time,
    ) -> Verdict {
        self.reset_after(limits, ready_for);
        while self.exits.front().is_some_and(|&exit| now.saturating_sub(exit) >= limits.window) {
            self.exits.pop_front();
        }
        self.exits.push_back(now);
        let exits = u32::try_from(self.exits.len()).unwrap_or(u32::MAX);
        if exits >= limits.exits_max {
            return Verdict::GiveUp { exits };
        }
        if ready_for.is_some() && !self.spared {
            self.spared = true;
            return Verdict::Again;
        }
        Verdict::After(self.next_pause(limits))
    }

    /// Returns the pause after an exit for want of a resource, which does not count: the service is
    /// retried for as long as the shortage lasts.
    pub(crate) fn pause(
        &mut self,
        limits: &RestartLimits,
        ready_for: Option<Duration>,
    ) -> Duration {
        self.reset_after(limits, ready_for);
        self.next_pause(limits)
    }

    fn reset_after(&mut self, limits: &RestartLimits, ready_for: Option<Duration>) {
        if ready_for.is_some_and(|time| time >= limits.backoff_reset) {
            self.pauses = 0;
            self.spared = false;
        }
    }

    fn next_pause(&mut self, limits: &RestartLimits) -> Duration {
        let pause = limits.backoff_first.saturating_mul(1u32 << self.pauses.min(16));
        self.pauses = self.pauses.saturating_add(1);
        pause.min(limits.backoff_max)
    }

    /// Resets everything on a request of the operator.
    pub(crate) fn forget(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::group::tests;

    const LIMITS: RestartLimits = RestartLimits { exits_max: 100, ..tests::LIMITS };

    fn pause(ms: u64) -> Verdict {
        Verdict::After(Duration::from_millis(ms))
    }

    #[test]
    fn pauses_double_up_to_the_longest() {
        let mut limiter = RestartLimiter::default();
        let found: Vec<_> =
            (0..8).map(|s| limiter.count(&LIMITS, None, Time::from_secs(s))).collect();
        let expected = [100, 200, 400, 800, 1600, 3200, 5000, 5000].map(pause);
        assert_eq!(found, expected);
    }

    #[test]
    fn restart_limiter_skips_backoff_only_for_the_first_exit_after_readiness() {
        let mut limiter = RestartLimiter::default();
        let soon = Some(Duration::from_secs(1));
        assert_eq!(limiter.count(&LIMITS, soon, Time::from_secs(1)), Verdict::Again);
        assert_eq!(limiter.count(&LIMITS, soon, Time::from_secs(2)), pause(100));
        assert_eq!(limiter.count(&LIMITS, soon, Time::from_secs(3)), pause(200));
    }

    #[test]
    fn long_readiness_resets_the_backoff() {
        let mut limiter = RestartLimiter::default();
        for s in 0..4 {
            limiter.count(&LIMITS, None, Time::from_secs(s));
        }
        let long = Some(LIMITS.backoff_reset);
        assert_eq!(limiter.count(&LIMITS, long, Time::from_secs(40)), Verdict::Again);
        assert_eq!(limiter.count(&LIMITS, None, Time::from_secs(41)), pause(100));
    }

    #[test]
    fn restart_limiter_window_slides() {
        let limits = RestartLimits { exits_max: 3, ..LIMITS };
        let mut limiter = RestartLimiter::default();
        assert_eq!(limiter.count(&limits, None, Time::from_secs(0)), pause(100));
        assert_eq!(limiter.count(&limits, None, Time::from_secs(59)), pause(200));
        assert_eq!(limiter.count(&limits, None, Time::from_secs(60)), pause(400));
        let last = limiter.count(&limits, None, Time::from_secs(118));
        assert_eq!(last, Verdict::GiveUp { exits: 3 });
    }
}
