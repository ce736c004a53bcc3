//! Counters that wake: an eventfd, whose writer adds to it and whose reader need not read it, since each addition is an
//! event of an edge-triggered `epoll`.
//!
//! The writer offers it in a datagram. A reader that takes it says so in the counter itself; one that does not know
//! about counters (iceoryx2's own, in programs of other languages) closes it, and datagrams are sent as before. A pipe
//! in which nothing is written goes with the counter: its end tells the reader that the writer has ended.

use rustix::event::{EventfdFlags, eventfd};
use rustix::net::{SendAncillaryBuffer, SendAncillaryMessage, SendFlags, sendmsg};
use rustix::pipe::{PipeFlags, pipe_with};
use std::io::IoSlice;
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::atomic::{AtomicBool, Ordering};

/// Descriptors of one counter.
pub(super) const DESCRIPTORS: usize = 2;
/// What the reader adds when it takes the counter, more than a writer does before.
const TAKEN: u64 = 1 << 32;

/// The writer's end.
#[derive(Debug)]
pub(super) struct Offered {
    counter: OwnedFd,
    _lifeline: OwnedFd,
    is_taken: AtomicBool,
}

impl Offered {
    /// Offers a counter in a datagram, which is a wake-up itself.
    ///
    /// # Errors
    /// There are no descriptors, or the socket is full or closed.
    pub(super) fn send(socket: BorrowedFd<'_>) -> rustix::io::Result<Self> {
        let counter = eventfd(0, EventfdFlags::CLOEXEC | EventfdFlags::NONBLOCK)?;
        let (lifeline, own_end) = pipe_with(PipeFlags::CLOEXEC | PipeFlags::NONBLOCK)?;
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(DESCRIPTORS))];
        let mut control = SendAncillaryBuffer::new(&mut space);
        let carried: [_; DESCRIPTORS] = [counter.as_fd(), lifeline.as_fd()];
        control.push(SendAncillaryMessage::ScmRights(&carried));
        let flags = SendFlags::DONTWAIT | SendFlags::NOSIGNAL;
        sendmsg(socket, &[IoSlice::new(&[0])], &mut control, flags)?;
        Ok(Self { counter, _lifeline: own_end, is_taken: AtomicBool::new(false) })
    }

    /// Wakes the reader. Returns false if it has not taken the counter, at least not yet.
    pub(super) fn wake(&self) -> bool {
        self.is_taken() && rustix::io::write(&self.counter, &1_u64.to_ne_bytes()).is_ok()
    }

    fn is_taken(&self) -> bool {
        if self.is_taken.load(Ordering::Relaxed) {
            return true;
        }
        let mut count = [0; 8];
        let is_read = rustix::io::read(&self.counter, &mut count).is_ok();
        let is_taken = is_read && u64::from_ne_bytes(count) >= TAKEN;
        self.is_taken.store(is_taken, Ordering::Relaxed);
        is_taken
    }
}

/// The reader's end.
#[derive(Debug)]
pub(super) struct Taken {
    /// Readable each time it has been added to.
    pub(super) counter: OwnedFd,
    /// Hung up once the writer has ended.
    pub(super) lifeline: OwnedFd,
}

impl Taken {
    /// Tells the writer that its additions are noticed from now on.
    pub(super) fn confirm(&self) -> rustix::io::Result<()> {
        rustix::io::write(&self.counter, &TAKEN.to_ne_bytes()).map(drop)
    }
}
