//! The responder's life: a thread logs what it reports, bounds what it keeps, and starts it again if it fails.

use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use mdns_sd::{DaemonEvent, IfKind, Metrics, Receiver, RecvTimeoutError, ServiceDaemon};

use crate::records::Records;

/// Longest wait for the last packet.
const GOODBYE: Duration = Duration::from_millis(500);
/// Interval of looks at what the responder keeps.
const LOOK_EVERY: Duration = Duration::from_secs(1);
/// Pause before a responder is replaced.
const PAUSE: Duration = Duration::from_secs(1);
/// Longest wait for an answer of the responder.
const ANSWER: Duration = Duration::from_secs(5);
/// Records of others after which a responder is replaced. It keeps those that it did not ask for until they expire,
/// which may take years, so that anyone in the network could fill the memory.
const RECORDS_MAX: i64 = 4_096;

/// The responder of the moment; `None` after the end.
#[derive(Clone)]
pub(crate) struct Shared(Arc<Mutex<Option<ServiceDaemon>>>);

/// Why a responder is not followed any more.
#[derive(Debug, PartialEq)]
enum End {
    /// Its thread has ended.
    Gone,
    /// It keeps this number of records.
    Full(i64),
}

impl Shared {
    /// Starts a responder with its thread.
    ///
    /// # Errors
    /// A thread does not start.
    pub(crate) fn start(records: Records) -> Result<Self, crate::Unannounced> {
        let (responder, events) = respond(&records)?;
        let shared = Self(Arc::new(Mutex::new(Some(responder))));
        let followed = shared.clone();
        let thread = std::thread::Builder::new().name("discovery".to_owned());
        let spawned = thread.spawn(move || followed.follow(&records, events));
        spawned.map(|_| shared.clone()).map_err(|error: io::Error| {
            shared.end();
            error.into()
        })
    }

    /// Ends the responder, which says goodbye.
    pub(crate) fn end(&self) {
        if let Some(responder) = self.current().take() {
            shut_down(&responder);
        }
    }

    fn current(&self) -> MutexGuard<'_, Option<ServiceDaemon>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Follows the responder, and replaces it where it fails, until the end.
    fn follow(&self, records: &Records, mut events: Receiver<DaemonEvent>) {
        loop {
            let Some(responder) = self.current().clone() else { return };
            let end = watch(&responder, &events);
            if self.current().is_none() {
                return;
            }
            tracing::warn!("the responder of the local network is replaced: {end:?}");
            shut_down(&responder);
            std::thread::sleep(PAUSE);
            let mut current = self.current();
            if current.is_none() {
                return;
            }
            match respond(records) {
                Ok((next, its_events)) => (*current, events) = (Some(next), its_events),
                Err(error) => {
                    tracing::error!(%error, "the robot is not announced any more");
                    *current = None;
                }
            }
        }
    }
}

/// Starts a responder.
fn respond(records: &Records) -> mdns_sd::Result<(ServiceDaemon, Receiver<DaemonEvent>)> {
    let responder = ServiceDaemon::new()?;
    let events = responder.monitor()?;
    // The last selection that fits an interface counts.
    responder.disable_interface(IfKind::All)?;
    responder.enable_interface(records.networks.clone())?;
    responder.disable_interface(vec![IfKind::LoopbackV4, IfKind::LoopbackV6])?;
    responder.register(records.service.clone())?;
    Ok((responder, events))
}

fn shut_down(responder: &ServiceDaemon) {
    // It confirms after its goodbye, a packet for each network.
    if let Ok(ended) = responder.shutdown() {
        let _ = ended.recv_timeout(GOODBYE);
    }
}

/// Logs what a responder reports, until it has ended or keeps too much.
fn watch(responder: &ServiceDaemon, events: &Receiver<DaemonEvent>) -> End {
    let mut looked = Instant::now();
    loop {
        match events.recv_timeout(LOOK_EVERY) {
            Ok(event) => record(event),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => return End::Gone,
        }
        if looked.elapsed() >= LOOK_EVERY {
            looked = Instant::now();
            let metrics = responder.get_metrics().ok();
            // One that does not answer is replaced as well.
            let metrics = metrics.and_then(|answer| answer.recv_timeout(ANSWER).ok());
            let Some(metrics) = metrics else { return End::Gone };
            let kept = records_of_others(&metrics);
            if kept > RECORDS_MAX {
                return End::Full(kept);
            }
        }
    }
}

/// Number of records in the responder's cache.
fn records_of_others(metrics: &Metrics) -> i64 {
    let cached = metrics.iter().filter(|(name, _)| name.starts_with("cached-"));
    cached.map(|(_, count)| count).sum()
}

fn record(event: DaemonEvent) {
    match event {
        DaemonEvent::Announce(name, place) => {
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
