//! Datagrams of the motion stop's path: who is heard, and whose clock counts.

use std::io::IoSliceMut;
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::sync::atomic::{AtomicU64, Ordering};

use rustix::io::Errno;
use rustix::net::{
    AddressFamily, RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, SendFlags, SocketAddrUnix,
    SocketFlags, SocketType, bind, recvmsg, sendto, socket_with, sockopt,
};
use rustix::process::Uid;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Longest datagram, bytes.
pub(super) const BYTES_MAX: usize = 512;

/// A socket that neither waits nor hears other users.
#[derive(Debug)]
pub(super) struct Endpoint {
    socket: OwnedFd,
    /// Datagrams that were ignored. Any user can send them, so they are not logged one by one.
    ignored: AtomicU64,
}

impl Endpoint {
    pub(super) fn bind(address: &SocketAddrUnix) -> rustix::io::Result<Self> {
        let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
        let socket = socket_with(AddressFamily::UNIX, SocketType::DGRAM, flags, None)?;
        sockopt::set_socket_passcred(&socket, true)?;
        bind(&socket, address)?;
        Ok(Self { socket, ignored: AtomicU64::new(0) })
    }

    pub(super) fn fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }

    pub(super) fn send(&self, message: &impl Serialize, to: &SocketAddrUnix) -> Result<(), Errno> {
        let bytes = serde_json::to_vec(message).map_err(|_| Errno::INVAL)?;
        sendto(&self.socket, &bytes, SendFlags::NOSIGNAL, to).map(drop)
    }

    /// Returns the next message with its sender's address; `None` for a message that does not
    /// count. Senders may be root, this process's user and those whom `is_peer` accepts.
    pub(super) fn receive<T: DeserializeOwned>(
        &self,
        is_peer: impl Fn(Uid) -> bool,
    ) -> Result<Option<(T, Option<SocketAddrUnix>)>, Errno> {
        let mut bytes = [0; BYTES_MAX];
        let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmCredentials(1))];
        let mut control = RecvAncillaryBuffer::new(&mut space);
        let mut slices = [IoSliceMut::new(&mut bytes)];
        let received = recvmsg(&self.socket, &mut slices, &mut control, RecvFlags::CMSG_CLOEXEC)?;
        let is_heard = control.drain().any(|message| match message {
            RecvAncillaryMessage::ScmCredentials(sender) => {
                let uid = sender.uid;
                uid.is_root() || uid == rustix::process::geteuid() || is_peer(uid)
            }
            _ => false,
        });
        if !is_heard {
            self.ignore(&"of another user");
            return Ok(None);
        }
        let from = received.address.and_then(|address| SocketAddrUnix::try_from(address).ok());
        match serde_json::from_slice(&bytes[..received.bytes.min(BYTES_MAX)]) {
            Ok(message) => Ok(Some((message, from))),
            Err(error) => {
                self.ignore(&error);
                Ok(None)
            }
        }
    }

    /// Counts an ignored datagram, and logs the count at powers of two.
    fn ignore(&self, why: &dyn std::fmt::Display) {
        let ignored = self.ignored.fetch_add(1, Ordering::Relaxed) + 1;
        if ignored.is_power_of_two() {
            tracing::warn!(ignored, %why, "datagrams on the motion stop's path ignored");
        }
    }
}

/// Translation between this process's monotonic clock and the machine's: a container may have a
/// clock of its own, by which an order would seem to be from the past or the future.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ClockOffset(i64);

impl ClockOffset {
    /// The offset of this process's time namespace; 0 if the kernel has none.
    pub(super) fn of_process() -> Self {
        let offsets = std::fs::read_to_string("/proc/self/timens_offsets");
        Self(offsets.ok().and_then(|text| parse(&text)).unwrap_or_default())
    }

    /// Returns a time of this process in the machine's. 0 stays, because it means no time.
    pub(super) fn machine_ns(self, ns: u64) -> u64 {
        shift(ns, self.0.saturating_neg())
    }

    /// Returns a time of the machine in this process's.
    pub(super) fn own_ns(self, ns: u64) -> u64 {
        shift(ns, self.0)
    }
}

fn shift(ns: u64, by: i64) -> u64 {
    if ns == 0 { 0 } else { ns.saturating_add_signed(by).max(1) }
}

/// Reads the line `monotonic SECONDS NANOSECONDS`.
fn parse(offsets: &str) -> Option<i64> {
    let line = offsets.lines().find_map(|line| line.trim().strip_prefix("monotonic"))?;
    let mut numbers = line.split_whitespace().map(str::parse::<i64>);
    let (seconds, nanoseconds) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
    seconds.checked_mul(1_000_000_000)?.checked_add(nanoseconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offset_of_a_time_namespace_is_read_and_reversible() {
        let text = "monotonic       -2000         5\nboottime            0         0\n";
        let offset = ClockOffset(parse(text).unwrap_or_default());
        assert_eq!(offset, ClockOffset(-1_999_999_999_995));
        assert_eq!(offset.machine_ns(7), 2_000_000_000_002);
        assert_eq!(offset.own_ns(2_000_000_000_002), 7);
        assert_eq!((offset.machine_ns(0), offset.own_ns(0)), (0, 0));
        assert_eq!((offset.own_ns(9), offset.machine_ns(u64::MAX)), (1, u64::MAX));
        for damaged in ["", "monotonic", "monotonic x 0", "monotonic 9223372036854775807 0"] {
            assert_eq!(parse(damaged), None, "{damaged}");
        }
    }
}
