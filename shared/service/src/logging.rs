//! Structured logs on standard error, which the supervisor has pointed at the service's log file.

use crate::group::ENV_LOG;
use std::io::IsTerminal;
use tracing_subscriber::EnvFilter;

/// Begins logging. `WHICHONE_LOG` holds the filter (`info`, `policy=debug`, …) and
/// `WHICHONE_LOG_FORMAT=json` asks for one JSON object a line.
pub fn init() {
    let filter = EnvFilter::try_from_env(ENV_LOG).unwrap_or_else(|_| EnvFilter::new("info"));
    let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    let builder = tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(std::io::stderr)
        .with_ansi(colour)
        .with_target(true);
    let json = std::env::var("WHICHONE_LOG_FORMAT").is_ok_and(|format| format == "json");
    // A second call (tests in one process) leaves the first subscriber in place.
    let _ = if json { builder.json().try_init() } else { builder.try_init() };
}
