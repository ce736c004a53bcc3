//! Counters that wake: an eventfd, whose writer adds to it and whose reader need not read it, since each addition is an
//! event of an edge-triggered `epoll`.
//!
//! The writer offers it in a datagram, with one end of a pair of sockets. A reader that takes the counter answers with
//! a byte; one that does not know about counters (iceoryx2's own, in programs of other languages) closes both, and
//! datagrams are sent as before. The pair also tells the reader that the writer has ended. A
//! reader that has died is added to until iceoryx2 forgets it, when the supervisor has cleaned up.

use rustix::event::{EventfdFlags, eventfd};
use rustix::net::{
    AddressFamily, RecvFlags, SendAncillaryBuffer, SendAncillaryMessage, SendFlags, SocketFlags,
    SocketType, recv, send, sendmsg, socketpair,
};
use std::io::IoSlice;
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::OnceLock;

/// Descriptors of an offer.
pub(super) const DESCRIPTORS: usize = 2;

/// The writer's end.
#[derive(Debug)]
pub(super) struct Offered {
    counter: OwnedFd,
    answers: OwnedFd,
    /// The answer, once it is there.
    is_taken: OnceLock<bool>,
}

impl Offered {
    /// Offers a counter in a datagram, which is a wake-up itself.
    ///
    /// # Errors
    /// There are no descriptors, or the socket is full or closed.
    pub(super) fn send(socket: BorrowedFd<'_>) -> rustix::io::Result<Self> {
        let counter = eventfd(0, EventfdFlags::CLOEXEC | EventfdFlags::NONBLOCK)?;
        let (answers, peer) =
            socketpair(AddressFamily::UNIX, SocketType::STREAM, SocketFlags::CLOEXEC, None)?;
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmRights(DESCRIPTORS))];
        let mut control = SendAncillaryBuffer::new(&mut space);
        let carried: [_; DESCRIPTORS] = [counter.as_fd(), peer.as_fd()];
        control.push(SendAncillaryMessage::ScmRights(&carried));
        let flags = SendFlags::DONTWAIT | SendFlags::NOSIGNAL;
        sendmsg(socket, &[IoSlice::new(&[0])], &mut control, flags)?;
        Ok(Self { counter, answers, is_taken: OnceLock::new() })
    }

    /// Wakes the reader. Returns false if it has refused the counter or not answered yet.
    pub(super) fn wake(&self) -> bool {
        self.is_taken() && rustix::io::write(&self.counter, &1_u64.to_ne_bytes()).is_ok()
    }

    fn is_taken(&self) -> bool {
        if let Some(is_taken) = self.is_taken.get() {
            return *is_taken;
        }
        // Without a byte there is no answer yet; the end of the stream is a refusal.
        let answer = recv(&self.answers, &mut [0], RecvFlags::DONTWAIT);
        answer.is_ok_and(|(_, bytes)| *self.is_taken.get_or_init(|| bytes > 0))
    }
}

/// The reader's end.
#[derive(Debug)]
pub(super) struct Taken {
    /// Each addition is one event where it is listened to edge-triggered.
    pub(super) counter: OwnedFd,
    /// Hung up once the writer has ended.
    pub(super) writer: OwnedFd,
}

impl Taken {
    /// Tells the writer that its additions are noticed from now on.
    ///
    /// # Errors
    /// The writer has ended.
    pub(super) fn confirm(&self) -> rustix::io::Result<()> {
        send(&self.writer, &[0], SendFlags::DONTWAIT | SendFlags::NOSIGNAL).map(drop)
    }
}
