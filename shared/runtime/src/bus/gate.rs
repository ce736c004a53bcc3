//! Judgement of a message by its stamp: whose it is, and of which life.

use std::cell::Cell;
use std::sync::atomic::{AtomicU64, Ordering};

use messages::topics::Topic;
use messages::{Epoch, Incarnation, Service, Stamp};

use super::Bus;
use crate::group::GroupPaths;

/// Messages that this process has rejected as impossible.
static REJECTED: AtomicU64 = AtomicU64::new(0);

/// Returns how many messages of others this process has rejected as impossible.
pub fn rejected() -> u64 {
    REJECTED.load(Ordering::Relaxed)
}

/// Counts and logs a message that no service may see.
pub(super) fn reject(topic: &str, error: &dyn std::fmt::Display) {
    let rejected = REJECTED.fetch_add(1, Ordering::Relaxed).saturating_add(1);
    tracing::warn!(topic, %error, rejected, "message rejected");
}

/// Drops messages of another epoch, of an earlier incarnation of the writer than has already been
/// heard, and of one that was never started: believed, it would deafen the reader to the true one.
#[derive(Debug)]
pub(super) struct Gate {
    topic: &'static str,
    epoch: Epoch,
    /// `None` for several writing clients, which have no incarnation.
    writer: Option<Writer>,
}

/// The service that writes a topic.
#[derive(Debug)]
struct Writer {
    service: Service,
    /// Newest incarnation heard.
    newest: Cell<Incarnation>,
    paths: GroupPaths,
}

impl Gate {
    pub(super) fn new(bus: &Bus, topic: &Topic) -> Self {
        let paths = bus.paths.clone();
        let newest = Cell::default();
        let writer = topic.writer.map(|service| Writer { service, newest, paths });
        Self { topic: topic.name, epoch: bus.identity().epoch, writer }
    }

    pub(super) fn admits(&self, stamp: &Stamp) -> bool {
        if Epoch(stamp.epoch) != self.epoch {
            return false;
        }
        let Some(writer) = &self.writer else { return true };
        let incarnation = Incarnation(stamp.incarnation);
        if incarnation <= writer.newest.get() {
            return incarnation == writer.newest.get();
        }
        let is_started = writer.is_started(incarnation);
        if is_started {
            writer.newest.set(incarnation);
        } else {
            let name = writer.service.name();
            let found =
                format_args!("expected a running {name}, found one of start {}", incarnation.0);
            reject(self.topic, &found);
        }
        is_started
    }
}

impl Writer {
    /// Returns true if the supervisor has started this incarnation, whose socket exists from before
    /// its start to its end. Without a supervisor (in tests of topics) every one counts.
    fn is_started(&self, incarnation: Incarnation) -> bool {
        let socket = self.paths.notify_socket(self.service.name(), incarnation.0);
        socket.exists() || !self.paths.control_socket().exists()
    }
}
