//! The sleep of a main loop: on its wake-ups, and on the other descriptors that it has to look at.

use crate::Span;
use rustix::event::epoll::{self, CreateFlags, Event, EventData, EventFlags};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::net::{RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, recvmsg};
use std::cell::{Cell, RefCell};
use std::io::IoSliceMut;
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, AsRawFd, BorrowedFd, OwnedFd, RawFd};

/// Most events of one wake-up; others follow with the next one.
const EVENTS_MAX: usize = 16;
/// Most pipes of processes that wake this one; others use its socket.
const PIPES_MAX: usize = 64;
/// Bytes of a pipe that are left unread, of the 4096 and more that it holds.
const UNREAD_MAX: u32 = 256;
/// Shorter sleeps end on time. Others may last up to a millisecond longer, the unit of `epoll_wait`.
const PRECISE_BELOW: Span = Span::from_ms(20);
/// The wake-up socket's event. Those of sources and pipes follow.
const SOCKET: u64 = 0;
/// First event of a source.
const SOURCES: u64 = 1;
/// First event of a pipe.
const PIPES: u64 = 1 << 32;

/// What has ended a sleep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Woken<const N: usize> {
    /// A wake-up.
    pub by_wake: bool,
    /// Which of the sources are readable.
    pub sources: [bool; N],
}

/// A pipe whose bytes are wake-ups.
#[derive(Debug)]
struct Pipe {
    fd: OwnedFd,
    /// Wake-ups since it was read.
    unread: u32,
}

impl Pipe {
    fn empty(&mut self) {
        self.unread = 0;
        while rustix::io::read(&self.fd, &mut [0_u8; 4096]).is_ok_and(|read| read == 4096) {}
    }
}

fn timespec(span: Span) -> Timespec {
    Timespec { tv_sec: (span.0 / 1_000_000_000) as i64, tv_nsec: (span.0 % 1_000_000_000) as i64 }
}

/// Waits for wake-ups and for other descriptors.
#[derive(Debug)]
pub(super) struct Sleeper {
    epoll: OwnedFd,
    /// Sources of the last sleep.
    sources: RefCell<Vec<Option<RawFd>>>,
    pipes: RefCell<Vec<Option<Pipe>>>,
    /// Datagrams wait in the wake-up socket.
    has_datagrams: Cell<bool>,
}

impl Sleeper {
    /// Creates a sleeper on the wake-up socket.
    pub(super) fn new(socket: BorrowedFd<'_>) -> rustix::io::Result<Self> {
        let epoll = epoll::create(CreateFlags::CLOEXEC)?;
        epoll::add(&epoll, socket, EventData::new_u64(SOCKET), EventFlags::IN)?;
        Ok(Self {
            epoll,
            sources: RefCell::default(),
            pipes: RefCell::default(),
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
        let mut space = [MaybeUninit::uninit(); EVENTS_MAX];
        let Ok(events) = self.wait(&mut space, longest) else {
            return Woken { by_wake: true, sources: [true; N] };
        };
        for event in events {
            match event.data.u64() {
                SOCKET => {
                    self.has_datagrams.set(true);
                    woken.by_wake = true;
                }
                pipe @ PIPES.. => {
                    self.on_pipe((pipe - PIPES) as usize, event.flags);
                    woken.by_wake = true;
                }
                source => woken.sources[(source - SOURCES) as usize] = true,
            }
        }
        woken
    }

    fn wait<'a>(
        &self,
        space: &'a mut [MaybeUninit<Event>],
        longest: Span,
    ) -> rustix::io::Result<&'a mut [Event]> {
        let mut longest = longest;
        if longest < PRECISE_BELOW && longest > Span(0) {
            poll(&mut [PollFd::new(&self.epoll, PollFlags::IN)], Some(&timespec(longest)))?;
            longest = Span(0);
        }
        epoll::wait(&self.epoll, space, Some(&timespec(longest))).map(|(events, _)| events)
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

    fn on_pipe(&self, number: usize, flags: EventFlags) {
        let mut pipes = self.pipes.borrow_mut();
        let Some(slot) = pipes.get_mut(number) else { return };
        // Its process has ended; closing it ends its events too.
        if flags.intersects(EventFlags::HUP | EventFlags::ERR) {
            *slot = None;
        }
        if let Some(pipe) = slot {
            pipe.unread += 1;
            if pipe.unread >= UNREAD_MAX {
                pipe.empty();
            }
        }
    }

    /// Receives what waits in the wake-up socket, with the pipes in it.
    pub(super) fn empty(&self, socket: BorrowedFd<'_>) {
        if !self.has_datagrams.replace(false) {
            return;
        }
        // A full pipe is one reason for a datagram.
        self.pipes.borrow_mut().iter_mut().flatten().for_each(Pipe::empty);
        // iceoryx2 has each datagram carry its sender's credentials.
        const SPACE: usize = rustix::cmsg_space!(ScmRights(1), ScmCredentials(1));
        let mut space = [MaybeUninit::uninit(); SPACE];
        let flags = RecvFlags::DONTWAIT | RecvFlags::CMSG_CLOEXEC;
        loop {
            let mut control = RecvAncillaryBuffer::new(&mut space);
            let mut byte = [0];
            if recvmsg(socket, &mut [IoSliceMut::new(&mut byte)], &mut control, flags).is_err() {
                return;
            }
            for message in control.drain() {
                if let RecvAncillaryMessage::ScmRights(fds) = message {
                    fds.for_each(|fd| self.adopt(fd));
                }
            }
        }
    }

    /// Listens to a pipe too. One that is not wanted is closed, which its writer notices.
    fn adopt(&self, fd: OwnedFd) {
        let mut pipes = self.pipes.borrow_mut();
        let free = pipes.iter().position(Option::is_none).unwrap_or(pipes.len());
        if free >= PIPES_MAX {
            return;
        }
        let event = EventData::new_u64(PIPES + free as u64);
        match epoll::add(&self.epoll, fd.as_fd(), event, EventFlags::IN | EventFlags::ET) {
            Ok(()) if free == pipes.len() => pipes.push(Some(Pipe { fd, unread: 0 })),
            Ok(()) => pipes[free] = Some(Pipe { fd, unread: 0 }),
            Err(error) => tracing::debug!(%error, "a peer's pipe is not used"),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use rustix::net::{SendAncillaryBuffer, SendAncillaryMessage, SendFlags, sendmsg};
    use std::io::IoSlice;
    use std::os::unix::net::UnixDatagram;

    /// A wake-up socket as iceoryx2 makes it, and one that is connected to it.
    fn sockets() -> (UnixDatagram, UnixDatagram) {
        let (here, there) = UnixDatagram::pair().unwrap();
        rustix::net::sockopt::set_socket_passcred(&here, true).unwrap();
        (here, there)
    }

    fn is_woken(sleeper: &Sleeper) -> bool {
        sleeper.sleep(&[], Span(0)).by_wake
    }

    /// Sends one pipe's reading end, as a notifier does, and returns the other end.
    fn offer(socket: &UnixDatagram) -> OwnedFd {
        let (reading, writing) =
            rustix::pipe::pipe_with(rustix::pipe::PipeFlags::NONBLOCK).unwrap();
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(1))];
        let mut control = SendAncillaryBuffer::new(&mut space);
        let carried = [reading.as_fd()];
        control.push(SendAncillaryMessage::ScmRights(&carried));
        sendmsg(socket, &[IoSlice::new(&[0])], &mut control, SendFlags::empty()).unwrap();
        writing
    }

    #[test]
    fn bytes_of_a_pipe_wake_each_time_until_its_writer_ends() {
        let (here, there) = sockets();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let pipe = offer(&there);
        assert!(is_woken(&sleeper), "by the datagram");
        sleeper.empty(here.as_fd());
        assert!(!is_woken(&sleeper));
        // More than the pipe holds, so it has to be emptied now and then.
        for n in 0..100_000 {
            rustix::io::write(&pipe, &[0]).unwrap();
            assert!(is_woken(&sleeper), "wake-up {n}");
        }
        drop(pipe);
        is_woken(&sleeper);
        assert!(sleeper.pipes.borrow().iter().all(Option::is_none), "its descriptor is closed");
    }

    #[test]
    fn pipe_beyond_the_bound_is_closed_so_that_its_writer_uses_the_socket() {
        let (here, there) = sockets();
        let sleeper = Sleeper::new(here.as_fd()).unwrap();
        let pipes: Vec<OwnedFd> = (0..=PIPES_MAX)
            .map(|_| {
                let pipe = offer(&there);
                assert!(is_woken(&sleeper));
                sleeper.empty(here.as_fd());
                pipe
            })
            .collect();
        let is_written = |pipe: &OwnedFd| rustix::io::write(pipe, &[0]).is_ok();
        assert!(pipes[..PIPES_MAX].iter().all(is_written));
        assert!(!is_written(&pipes[PIPES_MAX]));
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
