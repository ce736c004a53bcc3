//! Lifecycle of a service under its supervisor: signals, lifeline, readiness and heartbeats.
//!
//! The protocol is that of `sd_notify`: datagrams to `$NOTIFY_SOCKET`. The lifeline is a pipe that
//! only the supervisor could write to: its end of file means that the supervisor has died. The
//! service then shuts down, and if it cannot, a guard thread kills its whole process group.

use crate::bus::{self, WakeListener, Woken};
use crate::exit::{Exit, Failure};
use crate::group::{self, GroupName, GroupPaths};
use crate::notify::Notifier;
use crate::{Span, Time, clock, sync_time};
use messages::{Epoch, Incarnation};
use rustix::event::{PollFd, PollFlags, poll};
use rustix::fs::{FlockOperation, flock};
use std::fs::File;
use std::ops::ControlFlow;
use std::os::fd::{AsFd, BorrowedFd, FromRawFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::sync::Arc;
use std::time::Duration;

/// Timeout for the shutdown of a service whose supervisor has died, before it is killed.
const ORPHAN_GRACE: Duration = Duration::from_secs(15);
/// Timeout for a service's dependencies on others at start. A held or stopped one does not block
/// it: the service is then reported ready, and continues when the other one returns.
const READY_PATIENCE: Span = Span::from_ms(1_000);
/// Longest time between two heartbeats of a service that is awake.
const BEAT_MAX: Span = Span::from_ms(1_000);
/// The part of it, one eighth, by which a heartbeat may be late, for a service that is soon awake
/// anyway.
const LATE_PART: u64 = 8;

/// The environment that the supervisor has set for this process.
#[derive(Clone, Debug)]
pub struct Environment {
    /// The group's folders.
    pub paths: GroupPaths,
    /// Epoch of the group.
    pub epoch: Epoch,
    /// Number of this start of the service.
    pub incarnation: Incarnation,
    /// Arguments of the program; a swapped service may have some.
    pub arguments: Vec<String>,
}

impl Environment {
    /// Environment of a node without a group, in simulations and reports: its home is not writable.
    pub fn nowhere() -> Self {
        Self {
            paths: GroupPaths::nowhere(),
            epoch: Epoch(1),
            incarnation: Incarnation(1),
            arguments: Vec::new(),
        }
    }

    /// Reads the environment variables that the supervisor sets.
    ///
    /// # Errors
    /// Not started by a supervisor, or by one of another kind.
    pub fn read(arguments: Vec<String>) -> Result<Self, Failure> {
        let name = text(group::ENV_GROUP)?;
        let usage = |e: group::GroupError| Failure::new(Exit::Usage, e.to_string());
        let name = GroupName::new(&name).map_err(usage)?;
        Ok(Self {
            paths: GroupPaths::resolve(&name).map_err(usage)?,
            epoch: Epoch(number(group::ENV_EPOCH)?),
            incarnation: Incarnation(number(group::ENV_INCARNATION)?),
            arguments,
        })
    }
}

fn text(key: &str) -> Result<String, Failure> {
    std::env::var(key).map_err(|_| {
        let help = "help: services are started by their supervisor, `whichone up`";
        Failure::new(Exit::Usage, format!("{key} is not set; {help}"))
    })
}

fn number<T: std::str::FromStr>(key: &str) -> Result<T, Failure> {
    let value = text(key)?;
    value.parse().map_err(|_| Failure::new(Exit::Usage, format!("{key}={value} is not a number")))
}

/// Connection of a service to its supervisor.
#[derive(Debug)]
pub struct Lifecycle {
    signals: UnixStream,
    lifeline: Option<OwnedFd>,
    _alive: File,
    beat_every: Span,
    last_beat: Option<Time>,
    /// Shortage reported by the last beat.
    shortage: String,
    /// Status last given to the operator.
    status: String,
    notifier: Notifier,
    /// Whether the last poll has found a signal or the end of the lifeline.
    is_called: bool,
}

/// Takes over SIGXFSZ, which kills a process that writes a file beyond its limit of size (`ulimit
/// -f`): the write fails then, as on a full disk.
///
/// # Errors
/// The operating system refuses it.
pub fn survive_long_files() -> std::io::Result<()> {
    signal_hook::flag::register(signal_hook::consts::SIGXFSZ, Arc::default()).map(drop)
}

impl Lifecycle {
    /// Takes over SIGTERM and SIGINT, the lifeline, and the alive lock.
    ///
    /// # Errors
    /// The operating system refuses one of them.
    pub fn begin(paths: &GroupPaths) -> Result<Self, Failure> {
        let failed = |what: &'static str| {
            move |e: std::io::Error| Failure::new(Exit::NotReached, format!("{what}: {e}"))
        };
        let (signals, writer) = UnixStream::pair().map_err(failed("signal pipe"))?;
        signals.set_nonblocking(true).map_err(failed("signal pipe"))?;
        survive_long_files().map_err(failed("signal handler"))?;
        for signal in [signal_hook::consts::SIGTERM, signal_hook::consts::SIGINT] {
            let writer = writer.try_clone().map_err(failed("signal pipe"))?;
            signal_hook::low_level::pipe::register(signal, writer)
                .map_err(failed("signal handler"))?;
        }
        let alive = safe_files::open_lock(&paths.alive_lock()).map_err(failed("alive.lock"))?;
        flock(&alive, FlockOperation::NonBlockingLockShared)
            .map_err(|e| failed("alive.lock")(e.into()))?;
        let lifeline = lifeline().map_err(failed("lifeline"))?;
        if let Some(fd) = &lifeline {
            guard(fd.try_clone().map_err(failed("lifeline"))?);
        }
        let watchdog =
            sd_notify::watchdog_enabled().map(|period| Span::from_s(period.as_secs_f64()));
        let beat_every = watchdog.map_or(BEAT_MAX, |period| Span(period.0 / 3).min(BEAT_MAX));
        let notifier = Notifier::from_environment().map_err(failed("notification socket"))?;
        Ok(Self {
            signals,
            lifeline,
            _alive: alive,
            beat_every,
            last_beat: None,
            shortage: String::new(),
            status: String::new(),
            notifier,
            is_called: false,
        })
    }

    /// Sleeps until there is a wake-up, one of `sources` is readable, a signal arrives, the
    /// supervisor ends, or `longest` has passed.
    fn wait(&mut self, listener: &WakeListener, sources: Sources<'_>, longest: Span) -> Ready {
        let [a, b, c] = sources;
        let lifeline = self.lifeline.as_ref().map(AsFd::as_fd);
        let Woken { by_wake, sources: [a, b, c, signal, orphaned] } =
            listener.sleep(&[a, b, c, Some(self.signals.as_fd()), lifeline], longest);
        self.is_called = signal || orphaned;
        Ready { by_wake, sources: [a, b, c] }
    }

    /// Returns true if the service has been asked to shut down.
    fn shutdown_requested(&mut self) -> bool {
        if !self.is_called {
            return false;
        }
        let mut byte = [0_u8; 16];
        let signalled = std::io::Read::read(&mut self.signals, &mut byte).is_ok_and(|n| n > 0);
        signalled || self.lifeline.as_ref().is_some_and(orphaned)
    }

    /// Notifies the supervisor that the service is ready.
    pub fn ready(&mut self) {
        let version = build_info::full_version();
        self.notifier.say(&format!("X_VERSION={version}\nREADY=1"));
    }

    /// Reports the service's status to the operator, if it has changed.
    fn status(&mut self, status: Option<&str>) {
        let status = status.unwrap_or_default();
        if self.status != status {
            self.notifier.say(&format!("STATUS={}", status.replace('\n', " ")));
            self.status = status.to_owned();
        }
    }

    /// Notifies the supervisor that the service is shutting down.
    pub fn stopping(&mut self) {
        self.notifier.say("STOPPING=1");
    }

    /// Sends a heartbeat if one is due, or if the service's shortage has changed. Called only by
    /// the main loop after a full pass, so that a heartbeat proves progress. `rejected` messages
    /// count in addition to those that the bus has rejected.
    pub fn beat(
        &mut self,
        now: Time,
        pending_since: Option<Time>,
        shortage: Option<&str>,
        rejected: u64,
    ) {
        let shortage = shortage.unwrap_or_default();
        let has_changed = self.shortage.is_empty() != shortage.is_empty();
        if !has_changed && self.last_beat.is_some_and(|last| now < last + self.beat_every) {
            return;
        }
        self.last_beat = Some(now);
        self.shortage = shortage.replace('\n', " ");
        let age_ms = pending_since.map_or(0, |since| now.since(since).0 / 1_000_000);
        let (shortage, lost) = (&self.shortage, bus::lost());
        let rejected = bus::rejected().saturating_add(rejected);
        let (syncs, sync_us) = sync_time::total();
        let sync_us = sync_us.as_micros();
        self.notifier.beat(&format!(
            "WATCHDOG=1\nX_INPUT_AGE_MS={age_ms}\nX_SHORTAGE={shortage}\nX_REJECTED={rejected}\n\
             X_LOST={lost}\nX_SYNCS={syncs}\nX_SYNC_US={sync_us}"
        ));
    }

    /// Returns when a service that sleeps has to send its next heartbeat.
    pub fn next_beat(&self, now: Time) -> Time {
        let late = Span(self.beat_every.0 / LATE_PART);
        self.last_beat.map_or(now, |last| last + self.beat_every + late)
    }
}

/// Most descriptors, besides its wake-ups, that end the sleep of a service.
pub const SOURCES_MAX: usize = 3;
/// Descriptors that end the sleep of a service, the same for life; those that it lacks are `None`.
pub type Sources<'a> = [Option<BorrowedFd<'a>>; SOURCES_MAX];
/// Whether there is a wake-up, and which of the [`Sources`] are readable, in their order.
pub type Ready = Woken<SOURCES_MAX>;

/// A service as the main loop drives it: one pass after another until it has shut down.
pub trait Cycle {
    /// Returns the listener of the service's wake-ups, on which it sleeps.
    fn listener(&self) -> &WakeListener;

    /// Returns the descriptors that end the sleep, and when it ends at the latest.
    fn wake(&self, now: Time) -> (Sources<'_>, Time);

    /// Returns whether the service can do its work; it is reported ready once it can.
    fn is_ready(&self) -> bool {
        true
    }

    /// Starts the shutdown; further passes follow until one breaks the loop.
    fn shut_down(&mut self);

    /// Processes pending inputs, decides and publishes; breaks once the service has shut down.
    /// Besides shared memory, only ready descriptors need to be read.
    ///
    /// # Errors
    /// A resource that the service requires is lost.
    fn pass(&mut self, ready: Ready) -> Result<ControlFlow<()>, Failure>;

    /// Returns the health of the service: without heartbeats the supervisor restarts it.
    fn health(&mut self, now: Time) -> Health;

    /// Returns the service's status for the operator.
    fn status(&self) -> Option<&str> {
        None
    }

    /// Returns the resource that the service waits for, e.g. disk space: it is healthy, and a
    /// restart would not help.
    fn shortage(&self) -> Option<&str> {
        None
    }

    /// Returns how many messages the service itself has rejected as invalid.
    fn rejected(&self) -> u64 {
        0
    }
}

/// Health of a service.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Health {
    /// Working; the arrival of its oldest unprocessed input.
    Working(Option<Time>),
    /// A part of the service is unresponsive.
    Stuck,
}

/// Drives a service until it has shut down.
///
/// # Errors
/// As [`Cycle::pass`].
pub fn drive(mut lifecycle: Lifecycle, cycle: &mut impl Cycle) -> Result<(), Failure> {
    let overdue = clock::now() + READY_PATIENCE;
    let (mut is_ready, mut is_ending) = (false, false);
    loop {
        let now = clock::now();
        if !is_ready && (cycle.is_ready() || now >= overdue) {
            is_ready = true;
            lifecycle.ready();
            tracing::info!("ready");
        }
        let (sources, until) = cycle.wake(now);
        let until = if is_ready { until } else { until.min(overdue) };
        let longest = until.min(lifecycle.next_beat(now)).since(now);
        let ready = lifecycle.wait(cycle.listener(), sources, longest);
        if !is_ending && lifecycle.shutdown_requested() {
            is_ending = true;
            lifecycle.stopping();
            cycle.shut_down();
        }
        let flow = cycle.pass(ready)?;
        lifecycle.status(cycle.status());
        let now = clock::now();
        if let Health::Working(pending_since) = cycle.health(now) {
            lifecycle.beat(now, pending_since, cycle.shortage(), cycle.rejected());
        }
        if flow.is_break() {
            tracing::info!("shut down on request");
            return Ok(());
        }
    }
}

/// The inherited read end of the supervisor's lifeline.
fn lifeline() -> std::io::Result<Option<OwnedFd>> {
    let Ok(number) = std::env::var(group::ENV_LIFELINE_FD) else { return Ok(None) };
    let bad = || std::io::Error::other(format!("{}={number}", group::ENV_LIFELINE_FD));
    let raw: i32 = number.parse().map_err(|_| bad())?;
    if raw <= 2 || rustix::io::fcntl_getfd(borrow(raw)).is_err() {
        return Err(bad());
    }
    // SAFETY: the descriptor is open (just asked), was inherited for this purpose, and its number
    // is used nowhere else in this process.
    #[allow(unsafe_code)]
    let fd = unsafe { OwnedFd::from_raw_fd(raw) };
    rustix::io::fcntl_setfd(&fd, rustix::io::FdFlags::CLOEXEC)?;
    Ok(Some(fd))
}

fn borrow(raw: i32) -> BorrowedFd<'static> {
    // SAFETY: used for one query, which fails if the descriptor is not open.
    #[allow(unsafe_code)]
    unsafe {
        BorrowedFd::borrow_raw(raw)
    }
}

fn orphaned(lifeline: &OwnedFd) -> bool {
    let mut fds = [PollFd::new(lifeline, PollFlags::IN)];
    let now = rustix::time::Timespec { tv_sec: 0, tv_nsec: 0 };
    poll(&mut fds, Some(&now)).is_ok_and(|n| n > 0)
}

/// Waits for the end of the supervisor and then of this process; kills the process group if that
/// times out.
fn guard(lifeline: OwnedFd) {
    let watch = move || {
        while poll(&mut [PollFd::new(&lifeline, PollFlags::IN)], None).is_err() {}
        std::thread::sleep(ORPHAN_GRACE);
        let _ = rustix::process::kill_current_process_group(rustix::process::Signal::KILL);
    };
    let started =
        std::thread::Builder::new().name("guard".into()).stack_size(64 << 10).spawn(watch);
    if let Err(error) = started {
        tracing::warn!(%error, "no guard thread; an orphan would end by its main loop only");
    }
}
