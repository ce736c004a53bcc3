//! Log lines on standard error, which the supervisor has pointed at the service's log. Less than the shipped services
//! have, which filter by target: one level for all, `WHICHONE_LOG`.

use std::fmt::{self, Write as _};
use std::io::Write as _;
use std::sync::atomic::{AtomicU64, Ordering};

use runtime::group::ENV_LOG;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Writes the events of `tracing` to standard error: those of this program, and of the SDK. A program that has a
/// subscriber of its own needs no call, and keeps that one.
pub fn init() {
    let most = level(&std::env::var(ENV_LOG).unwrap_or_default());
    // A second call leaves the first subscriber in place.
    let _ = tracing::subscriber::set_global_default(Stderr { most, spans: AtomicU64::new(1) });
}

/// The level for all targets in a filter such as `debug` or `warn,policy=debug`; none for `off`.
fn level(filter: &str) -> Option<Level> {
    let general = filter.split(',').map(str::trim).find(|part| !part.contains('='));
    match general.unwrap_or_default() {
        "off" => None,
        word => Some(word.parse().unwrap_or(Level::INFO)),
    }
}

struct Stderr {
    most: Option<Level>,
    spans: AtomicU64,
}

impl Subscriber for Stderr {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        self.most.is_some_and(|most| *metadata.level() <= most)
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(self.spans.fetch_add(1, Ordering::Relaxed))
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn event(&self, event: &Event<'_>) {
        let metadata = event.metadata();
        let mut line = Line::default();
        event.record(&mut line);
        let Line { message, fields } = line;
        let text = format!("{:>5} {}: {message}{fields}\n", metadata.level(), metadata.target());
        // A log that takes nothing must not end the service.
        let _ = std::io::stderr().write_all(text.as_bytes());
    }

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// The parts of a line.
#[derive(Default)]
struct Line {
    message: String,
    fields: String,
}

impl Visit for Line {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        let written = match field.name() {
            "message" => write!(self.message, "{value:?}"),
            name => write!(self.fields, " {name}={value:?}"),
        };
        debug_assert!(written.is_ok(), "a string takes everything");
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn general_level_of_a_filter_counts() {
        assert_eq!(level("debug"), Some(Level::DEBUG));
        assert_eq!(level("policy=trace,warn"), Some(Level::WARN));
        assert_eq!(level("off"), None);
        for nothing in ["", "policy=trace", "loud"] {
            assert_eq!(level(nothing), Some(Level::INFO), "{nothing}");
        }
    }
}
