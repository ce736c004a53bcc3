//! The motion stop's own path: datagrams on a socket of the arm's service.
//!
//! An order and its answer need no file, no shared memory, no disk and no other process: the socket
//! is there since the start of the service, and a client's answer comes to an address that the
//! kernel makes up. So the arm can be stopped on a full disk, with full shared memory, without a
//! free descriptor in the service, with a hung supervisor and a dead policy.
//!
//! An order is a JSON object in one datagram, `{"order":"stop","given_ns":N}`, and is answered by
//! the arm's [`StopState`]. A release may name the stop that its giver saw, `"stop":N`: the arm keeps
//! hold if another one is in force. A stop is repeated until the arm has confirmed it, however long its
//! service is away ([`Progress`]); one whose giver ends first is kept in a file for the arm's
//! return ([`KeptStop`]). `given_ns`, its time on the machine's monotonic clock, makes repetitions
//! harmless, and keeps a release from lifting a stop that was given less than [`RESUME_AFTER`]
//! before it. Only the group's own user and root are heard: the socket lies in the private folder
//! `run/`, and both sides check the credentials that the kernel attaches to each datagram.

use std::io;
use std::os::fd::BorrowedFd;

use messages::{MotionInhibit, MotionOrder, StopId};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::io::Errno;
use rustix::net::SocketAddrUnix;
use rustix::process::{Uid, geteuid};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::json;

use crate::group::GroupPaths;
use crate::{Span, Time, clock};
use datagram::{ClockOffset, Endpoint};
use progress::RESEND_EVERY;
pub use progress::{Progress, RELEASE_PATIENCE, default_patience};

mod datagram;
mod kept;
mod progress;
mod repeated;

pub use kept::{KeptStop, is_kept};
pub use repeated::RepeatedStop;
pub use vocabulary::RESUME_AFTER;

/// Most datagrams of one pass.
const DATAGRAMS_MAX: usize = 64;

/// An order to the motion stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopOrder {
    /// Stop or release.
    pub order: MotionOrder,
    /// Time at which it was given, nanoseconds (monotonic); older than the last is ignored.
    pub given_ns: u64,
    /// The stop that a release is meant for, 0 for any.
    #[serde(default)]
    pub stop: StopId,
}

/// Asks for the state: a release that is older than every order is answered and changes nothing.
pub const LOOK: StopOrder = StopOrder { order: MotionOrder::Resume, given_ns: 0, stop: StopId(0) };

impl StopOrder {
    /// A stop, or a release of any stop, that is given at `given`.
    pub fn new(order: MotionOrder, given: Time) -> Self {
        Self { order, given_ns: given.ns(), stop: StopId(0) }
    }
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
    /// Reason why the robot cannot move; if the robot is silent, `at_rest` is an assumption.
    pub inhibit: MotionInhibit,
    /// The stop in force; 0 if none is, or for an arm of an older version.
    #[serde(default)]
    pub stop: StopId,
}

impl StopState {
    fn translated(self, time: impl Fn(u64) -> u64) -> Self {
        let (given_ns, in_force_ns) = (time(self.given_ns), time(self.in_force_ns));
        Self { given_ns, in_force_ns, ..self }
    }
}

/// Return address for an answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Caller(SocketAddrUnix);

/// Serialised as the bytes of an address that is not a file, the only kind that orders come from.
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
    /// Returns a caller with an abstract address of this name.
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
    endpoint: Endpoint,
    clock: ClockOffset,
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
        let endpoint = Endpoint::bind(&SocketAddrUnix::new(&path)?)?;
        Ok(Self { endpoint, clock: ClockOffset::of_process() })
    }

    /// Readable while orders wait.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.endpoint.fd()
    }

    /// Hands waiting orders to `take`, up to a bound.
    pub fn drain(&self, mut take: impl FnMut(StopOrder, Caller)) {
        for _ in 0..DATAGRAMS_MAX {
            match self.endpoint.receive::<StopOrder>(|_| false) {
                Ok(Some((order, Some(from)))) => {
                    let given_ns = self.clock.own_ns(order.given_ns);
                    take(StopOrder { given_ns, ..order }, Caller(from));
                }
                Ok(_) => {}
                Err(Errno::INTR) => {}
                Err(_) => return,
            }
        }
    }

    /// Answers without waiting. A caller that is gone, or whose queue is full, asks again.
    pub fn answer(&self, Caller(address): &Caller, state: &StopState) {
        let state = state.translated(|ns| self.clock.machine_ns(ns));
        if let Err(error) = self.endpoint.send(&state, address) {
            tracing::debug!(%error, "answer to a motion order not delivered");
        }
    }
}

/// The client's end. It never waits.
#[derive(Debug)]
pub struct StopClient {
    endpoint: Endpoint,
    paths: GroupPaths,
    clock: ClockOffset,
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
    #[error(
        "the arm's service does not answer after {0:.1} s; the robot may still move; {EMERGENCY}"
    )]
    Silent(f64),
    /// The arm has the order, and is not at rest yet.
    #[error("the arm is stopping but not at rest after {0:.1} s; {EMERGENCY}")]
    Moving(f64),
    /// A later order is in force.
    #[error("overruled by a later order; help: see `whichone watch`")]
    Overruled,
    /// A release of a stop that is no longer the latest.
    #[error(
        "another stop was given after the one that this releases, and holds; \
         help: see why the arm was stopped again, then release that stop, or run: whichone resume-motion"
    )]
    OtherStop,
    /// A release that was given too soon after a stop.
    #[error(
        "a stop was given less than {} s before the release; help: give the release again",
        RESUME_AFTER.s()
    )]
    TooSoon,
    /// The arm answers, and the motion stop stays as it is.
    #[error(
        "the arm has not taken the order after {0:.1} s (motion inhibited: {1:?}); help: release the robot's \
         emergency stop, reset and enable the robot, then give the order again"
    )]
    NotTaken(f64, MotionInhibit),
    /// The stop is latched, but the robot's state is unknown.
    #[error("the stop is latched, but the robot is not heard and may still move; {EMERGENCY}")]
    Unheard,
    /// A stop that is not confirmed, and that nothing repeats any more.
    #[error(
        "the stop is not confirmed, and cannot be kept for the arm's return: {0}; the robot may still move; {EMERGENCY}"
    )]
    NotKept(String),
    /// The giver ended the order before it was confirmed.
    #[error("the order is not confirmed; the robot may still move; {EMERGENCY}")]
    Ended,
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
        let endpoint = Endpoint::bind(&SocketAddrUnix::new_unnamed())?;
        Ok(Self { endpoint, paths: paths.clone(), clock: ClockOffset::of_process() })
    }

    /// Readable while answers wait.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.endpoint.fd()
    }

    /// Sends an order. A full queue drops it: it is repeated anyway.
    ///
    /// # Errors
    /// [`StopError::Absent`] if no process listens, [`StopError::NoGroup`] if `run` is missing too.
    pub fn send(&self, order: &StopOrder) -> Result<(), StopError> {
        let socket_error = |error: Errno| StopError::Socket(error.to_string());
        let to = SocketAddrUnix::new(self.paths.stop_socket()).map_err(socket_error)?;
        let given_ns = self.machine_ns(Time(order.given_ns));
        let mut message = json!({ "order": order.order, "given_ns": given_ns });
        // An arm of an older version ignores an order with a key that it does not know.
        if order.stop > StopId(0) {
            message["stop"] = json!(order.stop);
        }
        match self.endpoint.send(&message, &to) {
            Ok(()) | Err(Errno::AGAIN | Errno::NOBUFS | Errno::NOMEM | Errno::INTR) => Ok(()),
            Err(Errno::NOENT | Errno::CONNREFUSED) if !self.paths.run().is_dir() => {
                Err(StopError::NoGroup(self.paths.name().to_string()))
            }
            Err(Errno::NOENT | Errno::CONNREFUSED) => Err(StopError::Absent),
            Err(error) => Err(socket_error(error)),
        }
    }

    /// Returns the next answer.
    pub fn take(&self) -> Option<StopState> {
        let next = || self.endpoint.receive::<StopState>(|uid| self.is_groups_user(uid));
        let state = (0..DATAGRAMS_MAX).find_map(|_| match next() {
            Ok(answer) => answer.map(|(state, _)| Some(state)),
            Err(Errno::INTR) => None,
            Err(_) => Some(None),
        })??;
        Some(state.translated(|ns| self.clock.own_ns(ns)))
    }

    fn machine_ns(&self, given: Time) -> u64 {
        self.clock.machine_ns(given.ns())
    }

    /// Returns whether this is the user whom the group belongs to. Root alone needs it: others
    /// reach no group but their own.
    fn is_groups_user(&self, uid: Uid) -> bool {
        use std::os::unix::fs::MetadataExt;
        let is_owner = |run: std::fs::Metadata| run.uid() == uid.as_raw();
        geteuid().is_root() && self.paths.run().metadata().is_ok_and(is_owner)
    }
}

/// Gives an order and waits until the arm has carried it out: latched, at rest and durable, or
/// released. A stop that cannot become durable is returned as such.
///
/// `keep_trying` is asked with each repetition, and gets the reason for the missing confirmation
/// whenever a warning is due; if it returns false, the order ends. It must not wait.
///
/// A stop that is returned unconfirmed is kept for the arm's return ([`KeptStop`]).
/// # Errors
/// Not confirmed within `patience` ([`default_patience`]); without one a stop ends unconfirmed only
/// if overruled, or if the group ends or the robot is silent; see [`StopError`].
pub fn give(
    paths: &GroupPaths,
    order: MotionOrder,
    patience: impl Into<Option<Span>>,
    keep_trying: &mut dyn FnMut(Option<StopError>) -> bool,
) -> Result<StopState, StopError> {
    carry_out(paths, Progress::new(order, clock::now(), patience), keep_trying)
}

/// As [`give`], a release of this stop alone; 0 stands for any.
///
/// # Errors
/// As [`give`], or another stop is in force.
pub fn release(
    paths: &GroupPaths,
    stop: StopId,
    patience: impl Into<Option<Span>>,
    keep_trying: &mut dyn FnMut(Option<StopError>) -> bool,
) -> Result<StopState, StopError> {
    let release = Progress::new(MotionOrder::Resume, clock::now(), patience).of(stop);
    carry_out(paths, release, keep_trying)
}

/// Returns the state of the motion stop; `None` if the arm's service does not answer in `patience`.
pub fn look(paths: &GroupPaths, patience: Span) -> Option<StopState> {
    let client = StopClient::open(paths).ok()?;
    let until = clock::now() + patience;
    while clock::now() < until {
        client.send(&LOOK).ok()?;
        wait(&client, RESEND_EVERY);
        if let Some(state) = client.take() {
            return Some(state);
        }
    }
    None
}

fn carry_out(
    paths: &GroupPaths,
    mut progress: Progress,
    keep_trying: &mut dyn FnMut(Option<StopError>) -> bool,
) -> Result<StopState, StopError> {
    let client = StopClient::open(paths).map_err(|error| StopError::Socket(error.to_string()))?;
    let result = loop {
        progress.advance(&client, clock::now());
        let now = clock::now();
        if let Some(result) = progress.result(now) {
            break result;
        }
        if !keep_trying(progress.warning(now)) {
            break Err(StopError::Ended);
        }
        wait(&client, RESEND_EVERY);
    };
    match result.is_err().then(|| progress.leave(&client)) {
        Some(Err(error)) => Err(StopError::NotKept(error.to_string())),
        _ => result,
    }
}

fn wait(client: &StopClient, longest: Span) {
    let timeout = rustix::time::Timespec { tv_sec: 0, tv_nsec: longest.0 as i64 };
    // Interrupted or not: the caller looks for answers.
    let _ = poll(&mut [PollFd::new(&client.fd(), PollFlags::IN)], Some(&timeout));
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;
