//! The sleep of a main loop: on its wake-ups, and on the other descriptors that it has to look at.

use super::alarm::Alarm;
use super::counter::{DESCRIPTORS, Taken};
use crate::{Span, Time, clock};
use rustix::event::Timespec;
use rustix::event::epoll::{self, CreateFlags, Event, EventData, EventFlags};
use rustix::net::{RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, recvmsg};
use std::cell::{Cell, RefCell};
use std::io::IoSliceMut;
use std::mem::MaybeUninit;
use std::os::fd::{AsRawFd, BorrowedFd, OwnedFd, RawFd};

/// Most events of one wake-up; others follow with the next one.
const EVENTS_MAX: usize = 16;
/// Most counters of processes that wake this one; others use its socket.
const COUNTERS_MAX: usize = 64;
/// The wake-up socket's event.
const SOCKET: u64 = 0;
/// The alarm's event. Those of sources and counters follow.
const ALARM: u64 = 1;
/// First event of a source.
const SOURCES: u64 = 2;
/// First event of a counter; the next one is its writer's end.
const COUNTERS: u64 = 1 << 32;

/// What has ended a sleep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Woken<const N: usize> {
    /// A wake-up.
    pub by_wake: bool,
    /// Which of the sources are readable.
    pub sources: [bool; N],
}

/// Waits for wake-ups and for other descriptors.
#[derive(Debug)]
pub(super) struct Sleeper {
    epoll: OwnedFd,
    /// Ends a sleep; cheaper than a timeout of `epoll_wait`, which the kernel sets and cancels each time.
    alarm: Alarm,
    /// Sources of the last sleep.
    sources: RefCell<Vec<Option<RawFd>>>,
    counters: RefCell<Vec<Option<Taken>>>,
    /// Datagrams wait in the wake-up socket.
    has_datagrams: Cell<bool>,
}

impl Sleeper {
    /// Creates a sleeper on the wake-up socket.
    pub(super) fn new(socket: BorrowedFd<'_>) -> rustix::io::Result<Self> {
        let epoll = epoll::create(CreateFlags::CLOEXEC)?;
        let alarm = Alarm::new()?;
        epoll::add(&epoll, socket, EventData::new_u64(SOCKET), EventFlags::IN)?;
        // Each expiry is one event, so it is never read.
        let each = EventFlags::IN | EventFlags::ET;
        epoll::add(&epoll, &alarm, EventData::new_u64(ALARM), each)?;
        Ok(Self {
            epoll,
            alarm,
            sources: RefCell::default(),
            counters: RefCell::default(),
            has_datagrams: Cell::new(false),
        })
    }

    /// Sleeps until there is a wake-up, one of `sources` is readable, or `longest` has passed. After an
    /// interruption everything counts as ready. A descriptor stays open from its first sleep to the last.
    pub(super) fn sleep<const N: usize>(
        &self,
        sources: &[Option<BorrowedFd<'_>>; N],
        longest: Span,
    ) -> Woken<N> {
        if let Err(error) = self.register(sources) {
            tracing::error!(%error, "a descriptor cannot be waited for");
        }
        let mut woken = Woken { by_wake: false, sources: [false; N] };
        let until = clock::now() + longest;
        // Without an alarm it does not wait.
        let waits = || longest > Span(0) && self.alarm.set_by(until);
        loop {
            let waits = waits();
            let mut space = [MaybeUninit::uninit(); EVENTS_MAX];
            let timeout = (!waits).then(Timespec::default);
            let Ok((events, _)) = epoll::wait(&self.epoll, &mut space, timeout.as_ref()) else {
                return Woken { by_wake: true, sources: [true; N] };
            };
            let is_over = self.note(events, until, &mut woken);
            if !waits || is_over || woken.by_wake || woken.sources.contains(&true) {
                return woken;
            }
        }
    }

    /// Notes what the events mean. Returns whether the time is over.
    fn note<const N: usize>(&self, events: &[Event], until: Time, woken: &mut Woken<N>) -> bool {
        let mut is_over = false;
        for event in events {
            match event.data.u64() {
                SOCKET => {
                    self.has_datagrams.set(true);
                    woken.by_wake = true;
                }
                ALARM => is_over = self.alarm.went_off() >= Some(until),
                counter @ COUNTERS.. => {
                    self.on_counter(counter - COUNTERS);
                    woken.by_wake = true;
                }
                source => woken.sources[(source - SOURCES) as usize] = true,
            }
        }
        is_over
    }

    fn register(&self, sources: &[Option<BorrowedFd<'_>>]) -> rustix::io::Result<()> {
        let mut known = self.sources.borrow_mut();
        known.resize(sources.len(), None);
        for ((known, source), event) in known.iter_mut().zip(sources).zip(SOURCES..) {
            let raw = source.map(|fd| fd.as_raw_fd());
            if *known == raw {
                continue;
            }
            if let Some(source) = source {
                epoll::add(&self.epoll, source, EventData::new_u64(event), EventFlags::IN)?;
            }
            *known = raw;
        }
        Ok(())
    }

    /// Drops a counter whose writer has ended.
    fn on_counter(&self, event: u64) {
        if event % 2 == 1
            && let Some(slot) = self.counters.borrow_mut().get_mut((event / 2) as usize)
            && let Some(counter) = slot.take()
        {
            self.forget(&counter);
        }
    }

    /// Ends the events of a counter: closing it does not where another process has a copy, as a child has until it
    /// runs its own program.
    fn forget(&self, counter: &Taken) {
        for descriptor in [&counter.counter, &counter.writer] {
            if let Err(error) = epoll::delete(&self.epoll, descriptor) {
                tracing::debug!(%error, "a counter was not listened to");
            }
        }
    }

    /// Receives what waits in the wake-up socket, with the counters in it.
    pub(super) fn empty(&self, socket: BorrowedFd<'_>) {
        if !self.has_datagrams.replace(false) {
            return;
        }
        // iceoryx2 has each datagram carry its sender's credentials.
        const SPACE: usize = rustix::cmsg_space!(ScmRights(DESCRIPTORS), ScmCredentials(1));
        let mut space = [MaybeUninit::uninit(); SPACE];
        let flags = RecvFlags::DONTWAIT | RecvFlags::CMSG_CLOEXEC;
        loop {
            let mut control = RecvAncillaryBuffer::new(&mut space);
            let mut byte = [0];
            if recvmsg(socket, &mut [IoSliceMut::new(&mut byte)], &mut control, flags).is_err() {
                return;
            }
            for message in control.drain() {
                if let RecvAncillaryMessage::ScmRights(mut fds) = message
                    && let (Some(counter), Some(writer)) = (fds.next(), fds.next())
                {
                    self.offered(Taken { counter, writer });
                }
            }
        }
    }

    /// Takes a counter. One that is not taken is closed, and its writer goes on with datagrams.
    fn offered(&self, counter: Taken) {
        let mut counters = self.counters.borrow_mut();
        let free = counters.iter().position(Option::is_none).unwrap_or(counters.len());
        if free >= COUNTERS_MAX {
            return;
        }
        match self.take(&counter, COUNTERS + 2 * free as u64) {
            Ok(()) if free == counters.len() => counters.push(Some(counter)),
            Ok(()) => counters[free] = Some(counter),
            Err(error) => {
                tracing::debug!(%error, "a counter of a peer is not used");
                self.forget(&counter);
            }
        }
    }

    fn take(&self, counter: &Taken, event: u64) -> rustix::io::Result<()> {
        let (added, ended) = (EventData::new_u64(event), EventData::new_u64(event + 1));
        epoll::add(&self.epoll, &counter.counter, added, EventFlags::IN | EventFlags::ET)?;
        epoll::add(&self.epoll, &counter.writer, ended, EventFlags::HUP | EventFlags::ET)?;
        counter.confirm()
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use crate::bus::counter::Offered;
    use std::os::fd::AsFd;
    use std::os::unix::net::UnixDatagram;

    #[test]
    fn sleep_ends_on_time_whatever_the_alarm_was_set_to_before() {
        let (here, there) = sockets();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let quiet = Woken { by_wake: false, sources: [] };
        let sleep = |span| {
            let started = clock::now();
            assert_eq!(sleeper.sleep(&[], span), quiet);
            let slept = clock::now().since(started);
            assert!(slept >= span, "{slept:?} of {span:?}");
        };
        for ms in [20, 1, 0, 5, 1] {
            sleep(Span::from_ms(ms));
        }
        // Woken early, it leaves an alarm that goes off before the next sleep is over.
        there.send(&[0]).unwrap();
        assert!(sleeper.sleep(&[], Span::from_ms(5)).by_wake);
        sleeper.empty(here.as_fd());
        sleep(Span::from_ms(50));
    }

    /// A wake-up socket as iceoryx2 makes it, and one that is connected to it.
    fn sockets() -> (UnixDatagram, UnixDatagram) {
        let (here, there) = UnixDatagram::pair().unwrap();
        rustix::net::sockopt::set_socket_passcred(&here, true).unwrap();
        (here, there)
    }

    fn is_woken(sleeper: &Sleeper) -> bool {
        sleeper.sleep(&[], Span(0)).by_wake
    }

    #[test]
    fn counter_wakes_each_time_once_it_is_taken_until_its_writer_ends() {
        let (here, there) = sockets();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let counter = Offered::send(there.as_fd()).unwrap();
        assert!(!counter.wake(), "nobody has taken it");
        assert!(is_woken(&sleeper), "by the datagram");
        sleeper.empty(here.as_fd());
        assert!(!is_woken(&sleeper), "taking it does not wake");
        for n in 0..100_000 {
            assert!(counter.wake());
            assert!(is_woken(&sleeper), "wake-up {n}");
            assert!(!is_woken(&sleeper), "once");
        }
        drop(counter);
        is_woken(&sleeper);
        assert!(
            sleeper.counters.borrow().iter().all(Option::is_none),
            "its descriptors are closed"
        );
        assert!(!is_woken(&sleeper));
    }

    #[test]
    fn end_of_a_writer_wakes_once_whoever_has_copies_of_its_descriptors() {
        let (here, there) = sockets();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let counter = Offered::send(there.as_fd()).unwrap();
        assert!(is_woken(&sleeper));
        sleeper.empty(here.as_fd());
        assert!(counter.wake());
        assert!(is_woken(&sleeper));
        // As a child of this process has them until it runs its own program.
        let copies = sleeper.counters.borrow()[0]
            .as_ref()
            .map(|taken| [&taken.counter, &taken.writer].map(|fd| fd.try_clone().unwrap()));
        drop(counter);
        assert!(is_woken(&sleeper));
        assert!(!is_woken(&sleeper));
        drop(copies);
    }

    #[test]
    fn counter_beyond_the_bound_is_closed_so_that_its_writer_uses_the_socket() {
        let (here, there) = sockets();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let offer = || {
            let counter = Offered::send(there.as_fd()).unwrap();
            assert!(is_woken(&sleeper));
            sleeper.empty(here.as_fd());
            counter
        };
        let mut counters: Vec<Offered> = (0..=COUNTERS_MAX).map(|_| offer()).collect();
        let refused = counters.pop().unwrap();
        assert!(counters.iter().all(Offered::wake));
        assert!(!refused.wake());
        // A writer that ends makes room.
        counters.pop();
        while is_woken(&sleeper) {}
        assert!(offer().wake());
    }

    #[test]
    fn sources_are_reported_in_their_places() {
        let (here, _there) = sockets();
        let (source, other) = UnixDatagram::pair().unwrap();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let sources = [None, Some(source.as_fd())];
        let quiet = Woken { by_wake: false, sources: [false, false] };
        assert_eq!(sleeper.sleep(&sources, Span::from_ms(1)), quiet);
        other.send(&[1]).unwrap();
        let ready = Woken { by_wake: false, sources: [false, true] };
        assert_eq!(sleeper.sleep(&sources, Span::from_ms(1_000)), ready);
    }
}
