//! Metrics of a group in the format of Prometheus (OpenMetrics text), which the console serves.
//!
//! [`dialogue`] folds the topics' messages into counters and histograms that begin with the
//! console. [`group`] exports the supervisor's report, and the recordings, at each scrape.

mod dialogue;
mod group;

use std::path::PathBuf;

use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets};
use prometheus_client::registry::Registry;
use service::status::GroupStatus;

pub use dialogue::{DialogueMetrics, Tally};
use group::GroupMetrics;

/// All exported metrics.
#[derive(Debug)]
pub struct Metrics {
    /// Pages and live views that are open.
    pub viewers: Gauge,
    /// Pages and live views disconnected because they did not read.
    pub dropped: Counter,
    /// Frames sent to pages and live views.
    pub frames: Counter,
    /// Bytes of these frames.
    pub bytes: Counter,
    /// Live views that are open.
    pub live_viewers: Gauge,
    /// Messages that were read for live views.
    pub live_messages: Counter,
    /// Messages that live views lost because they did not read them in time.
    pub live_lost: Counter,
    /// Seconds from the end of an utterance to the first sound of the answer.
    pub latency: Histogram,
    /// Seconds that the main loop takes for one pass.
    pub pass: Histogram,
    /// Metrics of dialogue, arm and hearing, counted by a [`Tally`].
    pub dialogue: DialogueMetrics,
    group: GroupMetrics,
    registry: Registry,
}

impl Metrics {
    /// Makes the metrics of a group whose recordings are in this folder.
    pub fn new(recordings: PathBuf) -> Self {
        let mut metrics = Self {
            viewers: Gauge::default(),
            dropped: Counter::default(),
            frames: Counter::default(),
            bytes: Counter::default(),
            live_viewers: Gauge::default(),
            live_messages: Counter::default(),
            live_lost: Counter::default(),
            latency: Histogram::new(exponential_buckets(0.01, 2.0, 12)),
            pass: Histogram::new(exponential_buckets(0.000_01, 4.0, 10)),
            dialogue: DialogueMetrics::default(),
            group: GroupMetrics::new(recordings),
            registry: Registry::default(),
        };
        let mut registry = Registry::with_prefix("whichone");
        metrics.dialogue.register(&mut registry);
        registry.register_collector(Box::new(metrics.group.clone()));
        metrics.register_console(registry.sub_registry_with_prefix("console"));
        metrics.registry = registry;
        metrics
    }

    fn register_console(&self, registry: &mut Registry) {
        let viewers = "Pages and live views that are open";
        registry.register("viewers", viewers, self.viewers.clone());
        let dropped = "Pages and live views disconnected because they did not read";
        registry.register("viewers_dropped", dropped, self.dropped.clone());
        registry.register("frames", "Frames sent to pages and live views", self.frames.clone());
        registry.register("bytes", "Bytes of these frames", self.bytes.clone());
        registry.register("live_viewers", "Live views that are open", self.live_viewers.clone());
        let messages = "Messages read for live views";
        registry.register("live_messages", messages, self.live_messages.clone());
        let lost = "Messages that live views lost because they read too slowly";
        registry.register("live_lost_messages", lost, self.live_lost.clone());
        let latency = "From the end of an utterance to the first sound of the answer";
        registry.register("answer_seconds", latency, self.latency.clone());
        let pass = "One pass of the main loop";
        registry.register("pass_seconds", pass, self.pass.clone());
    }

    /// Takes over the supervisor's status; `None` while it does not answer.
    pub fn set_group(&self, status: Option<&GroupStatus>) {
        self.group.set(status.cloned());
    }

    /// Returns the text that Prometheus fetches. Looks at the folder of the recordings.
    pub fn text(&self) -> String {
        let mut text = String::new();
        // Writing into a string cannot fail.
        let _ = encode(&mut text, &self.registry);
        text
    }
}

#[cfg(test)]
mod tests;
