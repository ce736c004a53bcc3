//! The group's health for ROS, and the node's own.

use super::Node;
use crate::clock::SystemClock;
use crate::diagnostics::statuses;
use crate::threads;
use crate::types::{DiagnosticArray, Header};
use service::control::{Watched, watch_supervisor};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::worker_channel::DeviceSender;
use service::{Span, Time, clock};
use std::time::Duration;

/// Interval at which the threads of the DDS implementation are counted.
const COUNT_EVERY: Span = Span::from_ms(250);
/// Interval of the diagnostics.
const DIAGNOSE_EVERY: Span = Span::from_ms(1_000);

impl Node {
    /// Takes in the supervisor's status, which comes once a second, and publishes it.
    pub(super) fn diagnose(&mut self) {
        self.statuses.clear();
        let mut is_new = false;
        while let Some(status) = self.statuses.take() {
            (self.status, is_new) = (status, true);
        }
        if !is_new {
            return;
        }
        if self.counters.refused > self.reported {
            let new = self.counters.refused - self.reported;
            tracing::warn!(new, total = self.counters.refused, "utterances were refused");
            self.reported = self.counters.refused;
        }
        let header = Header { stamp: SystemClock::now().ros(clock::now()), ..Header::default() };
        let group = self.status.as_ref().map(Box::as_ref).map_err(String::as_str);
        let status = statuses(group, &self.counters);
        self.dds
            .diagnostics
            .publish(DiagnosticArray { header, status }, &mut self.counters.dropped);
    }

    /// Returns an error if a thread of the DDS implementation has ended: only a new process helps.
    pub(super) fn count_threads(&mut self, now: Time) -> Result<(), Failure> {
        if now < self.counted + COUNT_EVERY {
            return Ok(());
        }
        self.counted = now;
        let running = threads::running();
        self.threads = self.threads.max(running);
        if running == self.threads {
            return Ok(());
        }
        let what = format!(
            "{running} of {} DDS threads run: one has ended, as after a stop of the process or a \
             suspension of the machine; restarting",
            self.threads
        );
        Err(Failure::new(Exit::NotReached, what))
    }
}

/// Requests the group's status every second.
pub(super) fn watch(paths: &GroupPaths, main_loop: DeviceSender<Watched>) -> std::io::Result<()> {
    let every = Duration::from_secs_f64(DIAGNOSE_EVERY.s());
    // A full inbox gets the next status a second later.
    let take = move |status| drop(main_loop.offer(status));
    watch_supervisor(paths, take, move || {
        std::thread::sleep(every);
        true
    })
}
