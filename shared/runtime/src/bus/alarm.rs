//! A timer that is set only where it has to go off earlier than it is set to.

use crate::Time;
use rustix::time::{
    Itimerspec, TimerfdClockId, TimerfdFlags, TimerfdTimerFlags, Timespec, timerfd_create,
    timerfd_settime,
};
use std::cell::Cell;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};

/// A timer of the machine's monotonic clock. Its descriptor is readable once it has gone off.
#[derive(Debug)]
pub(super) struct Alarm {
    fd: OwnedFd,
    /// When it goes off; `None` once it has gone off.
    set_to: Cell<Option<Time>>,
}

impl Alarm {
    pub(super) fn new() -> rustix::io::Result<Self> {
        let flags = TimerfdFlags::CLOEXEC | TimerfdFlags::NONBLOCK;
        let fd = timerfd_create(TimerfdClockId::Monotonic, flags)?;
        Ok(Self { fd, set_to: Cell::new(None) })
    }

    /// Makes it go off at that time or earlier. Returns false if the system refuses.
    pub(super) fn set_by(&self, time: Time) -> bool {
        if self.set_to.get().is_some_and(|set_to| set_to <= time) {
            return true;
        }
        // Zero would switch it off.
        let ns = time.0.max(1);
        let it_value =
            Timespec { tv_sec: (ns / 1_000_000_000) as i64, tv_nsec: (ns % 1_000_000_000) as i64 };
        let once = Itimerspec { it_interval: Timespec::default(), it_value };
        let set = timerfd_settime(&self.fd, TimerfdTimerFlags::ABSTIME, &once);
        match set {
            Ok(_) => self.set_to.set(Some(time)),
            Err(error) => tracing::error!(%error, "an alarm cannot be set"),
        }
        set.is_ok()
    }

    /// Notes that it has gone off. Returns the time that it was set to.
    pub(super) fn went_off(&self) -> Option<Time> {
        self.set_to.take()
    }
}

impl AsFd for Alarm {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.fd.as_fd()
    }
}
