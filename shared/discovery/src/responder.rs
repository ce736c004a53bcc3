//! The responder's life: a thread logs what it reports, bounds what it keeps, and starts it again if it fails.

use std::io;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use mdns_sd::{DaemonEvent, Error, IfKind, Metrics, Receiver, RecvTimeoutError, ServiceDaemon};

use crate::records::Records;

/// Longest wait for the last packet.
const GOODBYE: Duration = Duration::from_millis(500);
/// Interval of looks at what the responder keeps.
const LOOK_EVERY: Duration = Duration::from_secs(1);
/// Shortest and longest pause before a responder is started again.
const PAUSE: (Duration, Duration) = (Duration::from_secs(1), Duration::from_secs(60));
/// Longest wait for an answer of the responder.
const ANSWER: Duration = Duration::from_secs(5);
/// Time without an announcement after which the operator is warned.
const SILENCE: Duration = Duration::from_secs(15);
/// Records of others after which a responder is replaced. It keeps those that it did not ask for until they expire,
/// which may take years, or for good, so that anyone in the network could fill the memory.
pub(crate) const RECORDS_MAX: i64 = 4_096;
/// Timers after which a responder is replaced. Each record that is received, also one that it has, adds two, which it
/// keeps until the record expires.
pub(crate) const TIMERS_MAX: i64 = 65_536;

/// A responder with its reports.
pub(crate) type Started = (ServiceDaemon, Receiver<DaemonEvent>);

/// The responder of the moment, which a thread replaces until the end.
#[derive(Clone, Default)]
pub(crate) struct Shared(Arc<(Mutex<State>, Condvar)>);

#[derive(Default)]
struct State {
    responder: Option<ServiceDaemon>,
    ended: bool,
}

/// Why a responder is not followed any more.
#[derive(Debug, PartialEq)]
pub(crate) enum End {
    /// It does not answer, or its thread has ended.
    Gone,
    /// It keeps this number of records.
    Full(i64),
    /// It keeps this number of timers.
    Timers(i64),
}

impl Shared {
    /// Starts a thread that starts a responder, and tries again while that fails.
    ///
    /// # Errors
    /// The thread does not start.
    pub(crate) fn start(records: Records) -> io::Result<Self> {
        let shared = Self::default();
        let followed = shared.clone();
        let thread = std::thread::Builder::new().name("discovery".to_owned());
        thread.spawn(move || followed.follow(|| respond(&records)))?;
        Ok(shared)
    }

    /// Ends the responder, which says goodbye.
    pub(crate) fn end(&self) {
        let responder = {
            let mut state = self.state();
            state.ended = true;
            state.responder.take()
        };
        self.0.1.notify_all();
        if let Some(responder) = responder {
            shut_down(&responder);
        }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Follows one responder after the other, until the end.
    pub(crate) fn follow(&self, mut start: impl FnMut() -> mdns_sd::Result<Started>) {
        let mut silence = Silence::begin(Instant::now());
        let mut failures = 0;
        loop {
            // Under the lock, so that `end` finds the responder.
            let mut state = self.state();
            if state.ended {
                return;
            }
            let started = start();
            state.responder = started.as_ref().ok().map(|(responder, _)| responder.clone());
            drop(state);
            let goes_on = match started {
                Ok((responder, events)) => {
                    failures = 0;
                    let end = watch(&responder, &events, &mut silence);
                    if !self.state().ended {
                        tracing::warn!("the responder of the local network is replaced: {end:?}");
                    }
                    self.outlast(&responder, &events)
                }
                Err(error) => {
                    failures += 1;
                    let pause = pause_after(failures);
                    tracing::warn!(%error, "the robot is not announced; next attempt in {pause:?}");
                    self.pause(pause)
                }
            };
            if !goes_on {
                return;
            }
        }
    }

    /// Shuts a responder down and waits until its thread has ended, so that there are never two. Returns whether
    /// another one is wanted.
    pub(crate) fn outlast(
        &self,
        responder: &ServiceDaemon,
        events: &Receiver<DaemonEvent>,
    ) -> bool {
        shut_down(responder);
        while self.pause(PAUSE.0) {
            // One whose queue was full has not taken the order yet.
            if shut_down(responder) && events.is_disconnected() {
                return true;
            }
        }
        false
    }

    /// Pauses until the end at most. Returns whether it has not come.
    fn pause(&self, longest: Duration) -> bool {
        let waited = self.0.1.wait_timeout_while(self.state(), longest, |state| !state.ended);
        !waited.unwrap_or_else(PoisonError::into_inner).0.ended
    }
}

/// Pause after this many failed starts in succession.
pub(crate) fn pause_after(failures: u32) -> Duration {
    let factor = 2_u32.saturating_pow(failures.saturating_sub(1));
    PAUSE.0.saturating_mul(factor).min(PAUSE.1)
}

/// Starts a responder.
fn respond(records: &Records) -> mdns_sd::Result<Started> {
    let responder = ServiceDaemon::new()?;
    // Its thread outlives what is dropped here.
    let events = register(&responder, records).inspect_err(|_| {
        shut_down(&responder);
    })?;
    Ok((responder, events))
}

fn register(
    responder: &ServiceDaemon,
    records: &Records,
) -> mdns_sd::Result<Receiver<DaemonEvent>> {
    let events = responder.monitor()?;
    // The last selection that fits an interface counts.
    responder.disable_interface(IfKind::All)?;
    responder.enable_interface(records.networks.clone())?;
    responder.disable_interface(vec![IfKind::LoopbackV4, IfKind::LoopbackV6])?;
    responder.register(records.service.clone())?;
    Ok(events)
}

/// Returns whether the responder had ended before.
fn shut_down(responder: &ServiceDaemon) -> bool {
    match responder.shutdown() {
        Ok(ended) => {
            // It confirms after its goodbye, a packet for each network.
            let _ = ended.recv_timeout(GOODBYE);
            false
        }
        Err(error) => matches!(error, Error::DaemonShutdown),
    }
}

/// Logs what a responder reports, until it has ended or keeps too much.
pub(crate) fn watch(
    responder: &ServiceDaemon,
    events: &Receiver<DaemonEvent>,
    silence: &mut Silence,
) -> End {
    let mut looked = Instant::now();
    loop {
        match events.recv_timeout(LOOK_EVERY) {
            Ok(event) => record(event, silence),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return End::Gone,
        }
        if looked.elapsed() >= LOOK_EVERY {
            looked = Instant::now();
            if silence.is_too_long(looked) {
                tracing::warn!("{UNHEARD}");
            }
            let metrics = responder.get_metrics().ok();
            // One that does not answer is replaced as well.
            let metrics = metrics.and_then(|answer| answer.recv_timeout(ANSWER).ok());
            let Some(metrics) = metrics else { return End::Gone };
            if let Some(end) = excess(&metrics) {
                return end;
            }
        }
    }
}

/// Returns what a responder keeps too much of.
fn excess(metrics: &Metrics) -> Option<End> {
    let cached = metrics.iter().filter(|(name, _)| name.starts_with("cached-"));
    let records: i64 = cached.map(|(_, count)| count).sum();
    let timers = metrics.get("timer").copied().unwrap_or_default();
    let full = (records > RECORDS_MAX).then_some(End::Full(records));
    full.or((timers > TIMERS_MAX).then_some(End::Timers(timers)))
}

const UNHEARD: &str = "the robot is not announced yet: expected a network and UDP port 5353, found none free; \
    help: `ip address` shows the networks, `ss -ulpn sport = :5353` the programs that have the port";

/// The time without an announcement: a responder that has no network or no port reports nothing.
pub(crate) struct Silence(Option<Instant>);

impl Silence {
    pub(crate) fn begin(now: Instant) -> Self {
        Self(Some(now + SILENCE))
    }

    /// Returns whether there has been none for too long, once.
    pub(crate) fn is_too_long(&mut self, now: Instant) -> bool {
        self.0.take_if(|until| now >= *until).is_some()
    }
}

pub(crate) fn record(event: DaemonEvent, silence: &mut Silence) {
    match event {
        DaemonEvent::Announce(name, place) => {
            silence.0 = None;
            tracing::info!(name, place, "the robot is announced in the local network");
        }
        DaemonEvent::NameChange(change) => {
            let (taken, name) = (change.original, change.new_name);
            tracing::warn!(taken, name, "another robot in the local network has this name");
        }
        DaemonEvent::Error(error) => tracing::warn!(%error, "the robot is not announced"),
        _ => {}
    }
}
