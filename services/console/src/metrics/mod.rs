//! Metrics in the format of Prometheus.

use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::{Histogram, exponential_buckets};
use prometheus_client::registry::Registry;

#[derive(Clone, Debug)]
pub struct Metrics {
    pub viewers: Gauge,
    pub dropped: Counter,
    pub frames: Counter,
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
}

impl Default for Metrics {
    fn default() -> Self {
        Self {
            viewers: Gauge::default(),
            dropped: Counter::default(),
            frames: Counter::default(),
            bytes: Counter::default(),
            live_viewers: Gauge::default(),
            live_messages: Counter::default(),
            live_lost: Counter::default(),
            latency: Histogram::new(exponential_buckets(0.01, 2.0, 12)),
            pass: Histogram::new(exponential_buckets(0.000_01, 4.0, 10)),
        }
    }
}

impl Metrics {
    /// Returns the text that Prometheus fetches.
    pub fn text(&self) -> String {
        let mut registry = Registry::with_prefix("whichone_console");
        registry.register("viewers", "Pages that are open", self.viewers.clone());
        let dropped = "Pages disconnected because they did not read";
        registry.register("viewers_dropped", dropped, self.dropped.clone());
        registry.register("frames", "Frames sent to pages", self.frames.clone());
        registry.register("bytes", "Bytes of frames sent to pages", self.bytes.clone());
        let latency = "From the end of an utterance to the first sound of the answer";
        registry.register("answer_seconds", latency, self.latency.clone());
        let pass = "One pass of the main loop";
        registry.register("pass_seconds", pass, self.pass.clone());
        let mut text = String::new();
        // Writing into a string cannot fail.
        let _ = encode(&mut text, &registry);
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metrics_are_exported_under_their_names() {
        let metrics = Metrics::default();
        metrics.viewers.set(3);
        metrics.frames.inc_by(2);
        metrics.latency.observe(0.5);
        let text = metrics.text();
        for line in [
            "whichone_console_viewers 3",
            "whichone_console_frames_total 2",
            "whichone_console_answer_seconds_count 1",
        ] {
            assert!(text.lines().any(|printed| printed == line), "{line} in\n{text}");
        }
    }
}
