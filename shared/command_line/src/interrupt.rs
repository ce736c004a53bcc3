//! Interruption by the user.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use service::exit::{Exit, Failure};

/// A request to end: Ctrl-C or SIGTERM. Only for verbs that have something to clean up; others are
/// simply terminated.
#[derive(Clone, Debug)]
pub struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Handles INT and TERM.
    pub fn listen() -> Result<Self, Failure> {
        let requested = Arc::new(AtomicBool::new(false));
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            signal_hook::flag::register(signal, Arc::clone(&requested))
                .map_err(|error| Failure::new(Exit::NotReached, format!("signals: {error}")))?;
        }
        Ok(Self(requested))
    }

    /// Returns true if an interruption was requested.
    pub fn is_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
