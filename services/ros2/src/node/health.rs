//! The group's health for ROS, and the node's own.

use super::Node;
use crate::clock::SystemClock;
use crate::diagnostics::statuses;
use crate::types::{DiagnosticArray, Header};
use service::control::{Watched, watch_supervisor};
use service::group::GroupPaths;
use service::worker_channel::DeviceSender;
use service::{Span, clock};
use std::time::Duration;

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
