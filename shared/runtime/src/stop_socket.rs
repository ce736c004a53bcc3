//! The motion stop's own path: datagrams on a socket of the arm's service.
//!
//! An order and its answer need no file, no shared memory, no disk and no other process: the socket is
//! there since the start of the service, and a client's answer comes to an address that the kernel
//! makes up. So the arm can be stopped on a full disk, with full shared memory, without a free
//! descriptor in the service, with a hung supervisor and a dead policy.
//!
//! An order is a JSON object in one datagram, `{"order":"stop","given_ns":N}`, and is answered by the
//! arm's [`StopState`]. It is repeated until the answer is the wanted one; `given_ns`, its time on the
//! monotonic clock, makes repetitions harmless. Only the group's own user and root are heard: the
//! socket lies in the private folder `run/`, and both sides check the credentials that the kernel
//! attaches to each datagram.

use std::io::{self, IoSliceMut};
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::path::PathBuf;

use messages::{MotionInhibit, MotionOrder};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::Errno;
use rustix::net::{
    AddressFamily, RecvAncillaryBuffer, RecvAncillaryMessage, RecvFlags, SendFlags, SocketAddrUnix,
    SocketFlags, SocketType, bind, recvmsg, sendto, socket_with, sockopt,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::group::GroupPaths;
use crate::{Span, Time, clock};

mod repeated;

pub use repeated::RepeatedStop;

/// Longest datagram, bytes.
const DATAGRAM_BYTES_MAX: usize = 512;
/// Most datagrams of one pass.
const DATAGRAMS_MAX: usize = 64;
/// Interval at which an order is repeated.
const RESEND_EVERY: Span = Span::from_ms(10);
/// Time for a restart of the arm's service, before it counts as absent.
const RESTART_GRACE: Span = Span::from_ms(1_000);
/// Time without an answer before the caller is notified.
const SILENCE: Span = Span::from_ms(250);
/// Time that a stop of an arm at rest is given to become durable.
const DURABLE_GRACE: Span = Span::from_ms(500);

/// An order to the motion stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopOrder {
    /// Stop or release.
    pub order: MotionOrder,
    /// Time at which it was given, nanoseconds of the monotonic clock; an older one than the last obeyed is ignored.
    pub given_ns: u64,
}

/// State of the arm's motion stop: the answer to an order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct StopState {
    /// The answered order's time.
    pub given_ns: u64,
    /// Time of the order in force; later than `given_ns` if that one overrules the answered order.
    pub in_force_ns: u64,
    /// True if the stop is latched.
    pub stopped: bool,
    /// True if no set-point changes.
    pub at_rest: bool,
    /// True if the latch survives a restart of the service.
    pub durable: bool,
    /// Reason why the robot cannot move; where the robot is not heard, `at_rest` is a belief.
    pub inhibit: MotionInhibit,
}

impl StopState {
    /// Returns whether the stop that was given at `given` needs no repetition: it is latched for good and the arm
    /// is at rest, or a later order is in force.
    pub fn settles(&self, given: Time) -> bool {
        let is_done = self.stopped && self.at_rest && self.durable;
        let is_overruled = !self.stopped && self.in_force_ns > given.ns();
        self.given_ns == given.ns() && (is_done || is_overruled)
    }
}

/// Where an answer goes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Caller(SocketAddrUnix);

/// As the bytes of an address that is no file, which is the only kind that orders come from.
impl Serialize for Caller {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.abstract_name().unwrap_or_default().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Caller {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = Vec::<u8>::deserialize(deserializer)?;
        SocketAddrUnix::new_abstract_name(&name).map(Self).map_err(serde::de::Error::custom)
    }
}

impl Caller {
    /// A caller with an address of this name that is no file.
    ///
    /// # Panics
    /// If the name is longer than addresses are.
    pub fn named(name: &[u8]) -> Self {
        Self(SocketAddrUnix::new_abstract_name(name).expect("a short name"))
    }
}

/// The service's end.
#[derive(Debug)]
pub struct StopListener {
    socket: OwnedFd,
}

impl StopListener {
    /// Binds the group's socket, in the place of a former incarnation's.
    ///
    /// # Errors
    /// The operating system refuses it.
    pub fn bind(paths: &GroupPaths) -> io::Result<Self> {
        let path = paths.stop_socket();
        match std::fs::remove_file(&path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
        let socket = socket()?;
        bind(&socket, &SocketAddrUnix::new(&path)?)?;
        Ok(Self { socket })
    }

    /// Readable while orders wait.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }

    /// Hands waiting orders to `take`, up to a bound.
    pub fn drain(&self, mut take: impl FnMut(StopOrder, Caller)) {
        for _ in 0..DATAGRAMS_MAX {
            match receive::<StopOrder>(&self.socket) {
                Ok(Some((order, Some(from)))) => take(order, Caller(from)),
                Ok(_) => {}
                Err(Errno::INTR) => {}
                Err(_) => return,
            }
        }
    }

    /// Answers without waiting. A caller that is gone, or whose queue is full, asks again.
    pub fn answer(&self, Caller(address): &Caller, state: &StopState) {
        if let Err(error) = send(&self.socket, state, address) {
            tracing::debug!(%error, "answer to a motion order not delivered");
        }
    }
}

/// The client's end. It never waits.
#[derive(Debug)]
pub struct StopClient {
    socket: OwnedFd,
    path: PathBuf,
}

/// An order is not carried out, or not known to be.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StopError {
    /// The group is not running.
    #[error(
        "group {0} is not running; a robot that moves all the same is stopped by its own emergency stop; \
         help: start the group with `whichone up --group {0}`"
    )]
    NoGroup(String),
    /// No process listens.
    #[error("the arm's service is not running; the robot may still move; {EMERGENCY}")]
    Absent,
    /// No answer.
    #[error("the arm's service does not answer after {0} s; the robot may still move; {EMERGENCY}")]
    Silent(f64),
    /// The arm has the order, and is not at rest yet.
    #[error("the arm is stopping but not at rest after {0} s; {EMERGENCY}")]
    Moving(f64),
    /// A later order is in force.
    #[error("overruled by a later order; help: see `whichone watch`")]
    Overruled,
    /// The arm answers, and the motion stop stays as it is.
    #[error(
        "the arm has not taken the order after {0} s (motion inhibited: {1:?}); help: release the robot's \
         emergency stop, reset and enable the robot, then give the order again"
    )]
    NotTaken(f64, MotionInhibit),
    /// The client has no socket.
    #[error("no socket: {0}; {EMERGENCY}")]
    Socket(String),
}

const EMERGENCY: &str = "help: use the robot's own emergency stop, then see `whichone status`";

impl StopClient {
    /// Opens a socket whose address the kernel makes up; no file.
    ///
    /// # Errors
    /// The process or the system has no descriptor left.
    pub fn open(paths: &GroupPaths) -> io::Result<Self> {
        let socket = socket()?;
        bind(&socket, &SocketAddrUnix::new_unnamed())?;
        Ok(Self { socket, path: paths.stop_socket() })
    }

    /// Readable while answers wait.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.socket.as_fd()
    }

    /// Sends the order that was given at `given`. A full queue drops it: it is repeated anyway.
    ///
    /// # Errors
    /// [`StopError::Absent`] if nobody listens.
    pub fn send(&self, order: MotionOrder, given: Time) -> Result<(), StopError> {
        let socket_error = |error: Errno| StopError::Socket(error.to_string());
        let to = SocketAddrUnix::new(&self.path).map_err(socket_error)?;
        match send(&self.socket, &StopOrder { order, given_ns: given.ns() }, &to) {
            Ok(()) | Err(Errno::AGAIN | Errno::NOBUFS | Errno::INTR) => Ok(()),
            Err(Errno::NOENT | Errno::CONNREFUSED) => Err(StopError::Absent),
            Err(error) => Err(socket_error(error)),
        }
    }

    /// Returns the next answer.
    pub fn take(&self) -> Option<StopState> {
        (0..DATAGRAMS_MAX).find_map(|_| match receive::<StopState>(&self.socket) {
            Ok(answer) => answer.map(|(state, _)| Some(state)),
            Err(Errno::INTR) => None,
            Err(_) => Some(None),
        })?
    }
}

/// Gives an order and waits until the arm has carried it out: latched, at rest and durable, or
/// released. A stop that cannot become durable is returned as such.
///
/// While there is still time, `keep_trying` is asked between repetitions with the reason for which the answer
/// is late; the reason is the error where it returns false. It must not wait.
///
/// # Errors
/// Not confirmed within `patience`, which no error exceeds; see [`StopError`].
pub fn give(
    paths: &GroupPaths,
    order: MotionOrder,
    patience: Span,
    keep_trying: &mut dyn FnMut(&StopError) -> bool,
) -> Result<StopState, StopError> {
    let client = StopClient::open(paths).map_err(|error| StopError::Socket(error.to_string()))?;
    let given = clock::now();
    let mut progress = Progress::new(order, given, patience);
    loop {
        let absent = match client.send(order, given) {
            Err(StopError::Absent) if !paths.run().is_dir() => {
                return Err(StopError::NoGroup(paths.name().to_string()));
            }
            Err(StopError::Absent) => true,
            sent => sent.map(|()| false)?,
        };
        wait(&client, RESEND_EVERY);
        while let Some(state) = client.take() {
            progress.on_answer(state, clock::now());
        }
        let now = clock::now();
        if let Some(result) = progress.result(absent, now) {
            return result;
        }
        if let Some(trouble) = progress.trouble(absent, now)
            && !keep_trying(&trouble)
        {
            return Err(trouble);
        }
    }
}

/// Progress of one order. Pure: the caller sends the order and hands in the answers.
#[derive(Debug)]
pub struct Progress {
    order: MotionOrder,
    given: Time,
    patience: Span,
    state: Option<StopState>,
    /// Time since which the arm has been at rest.
    rests_since: Option<Time>,
}

impl Progress {
    /// An order that was given at `given` and is carried out within `patience`, or has failed.
    pub fn new(order: MotionOrder, given: Time, patience: Span) -> Self {
        Self { order, given, patience, state: None, rests_since: None }
    }

    /// Takes in an answer; those to other orders are ignored.
    pub fn on_answer(&mut self, state: StopState, now: Time) {
        if state.given_ns != self.given.ns() {
            return;
        }
        self.rests_since = state.at_rest.then(|| self.rests_since.unwrap_or(now));
        self.state = Some(state);
    }

    /// Returns the result once there is one. `absent`: no process listened to the latest repetition.
    ///
    /// # Errors
    /// As [`give`].
    pub fn result(&self, absent: bool, now: Time) -> Option<Result<StopState, StopError>> {
        let waited = now.since(self.given);
        let late = waited >= self.patience;
        let Some(state) = self.state else {
            return match absent {
                true => (late || waited >= RESTART_GRACE).then_some(Err(StopError::Absent)),
                false => late.then(|| Err(StopError::Silent(waited.s()))),
            };
        };
        if state.stopped != (self.order == MotionOrder::Stop) {
            if state.in_force_ns > self.given.ns() {
                return Some(Err(StopError::Overruled));
            }
            return late.then(|| Err(StopError::NotTaken(waited.s(), state.inhibit)));
        }
        if self.order == MotionOrder::Resume {
            return Some(Ok(state));
        }
        match self.rests_since {
            None => late.then(|| Err(StopError::Moving(waited.s()))),
            Some(since) => {
                let done = state.durable || late || now.since(since) >= DURABLE_GRACE;
                done.then_some(Ok(state))
            }
        }
    }

    /// Returns why there is no answer yet, if that has lasted.
    fn trouble(&self, absent: bool, now: Time) -> Option<StopError> {
        let waited = now.since(self.given);
        match self.state {
            Some(_) => None,
            None if absent => Some(StopError::Absent),
            None => (waited >= SILENCE).then(|| StopError::Silent(waited.s())),
        }
    }
}

fn wait(client: &StopClient, longest: Span) {
    let timeout = rustix::time::Timespec { tv_sec: 0, tv_nsec: longest.0 as i64 };
    // Interrupted or not: the caller looks for answers.
    let _ = poll(&mut [PollFd::new(&client.fd(), PollFlags::IN)], Some(&timeout));
}

fn socket() -> rustix::io::Result<OwnedFd> {
    let flags = SocketFlags::CLOEXEC | SocketFlags::NONBLOCK;
    let socket = socket_with(AddressFamily::UNIX, SocketType::DGRAM, flags, None)?;
    sockopt::set_socket_passcred(&socket, true)?;
    Ok(socket)
}

fn send(socket: &OwnedFd, message: &impl Serialize, to: &SocketAddrUnix) -> Result<(), Errno> {
    let bytes = serde_json::to_vec(message).map_err(|_| Errno::INVAL)?;
    sendto(socket, &bytes, SendFlags::NOSIGNAL, to).map(drop)
}

/// Returns the next message with its sender's address; none for one that does not count.
fn receive<T: DeserializeOwned>(
    socket: &OwnedFd,
) -> Result<Option<(T, Option<SocketAddrUnix>)>, Errno> {
    let mut bytes = [0; DATAGRAM_BYTES_MAX];
    let mut space = [MaybeUninit::uninit(); rustix::cmsg_space!(ScmCredentials(1))];
    let mut control = RecvAncillaryBuffer::new(&mut space);
    let mut slices = [IoSliceMut::new(&mut bytes)];
    let received = recvmsg(socket, &mut slices, &mut control, RecvFlags::CMSG_CLOEXEC)?;
    let heard = control.drain().any(|message| match message {
        RecvAncillaryMessage::ScmCredentials(sender) => {
            sender.uid.is_root() || sender.uid == rustix::process::geteuid()
        }
        _ => false,
    });
    if !heard {
        tracing::warn!("datagram of another user on the stop socket ignored");
        return Ok(None);
    }
    let from = received.address.and_then(|address| SocketAddrUnix::try_from(address).ok());
    match serde_json::from_slice(&bytes[..received.bytes.min(DATAGRAM_BYTES_MAX)]) {
        Ok(message) => Ok(Some((message, from))),
        Err(error) => {
            tracing::warn!(%error, "unintelligible datagram on the stop socket ignored");
            Ok(None)
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;
