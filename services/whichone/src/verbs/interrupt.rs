//! Ending when the person says so.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use service::exit::Exit;

use crate::error::CliError;

/// Whether the person wants to end: Ctrl-C, or a request of the system's. Only for verbs that have
/// something to put back in order; others are simply ended.
#[derive(Clone, Debug)]
pub(super) struct Interrupt(Arc<AtomicBool>);

impl Interrupt {
    /// Takes over INT and TERM.
    ///
    /// # Errors
    /// The operating system refuses.
    pub(super) fn listen() -> Result<Self, CliError> {
        let told = Arc::new(AtomicBool::new(false));
        for signal in [signal_hook::consts::SIGINT, signal_hook::consts::SIGTERM] {
            signal_hook::flag::register(signal, Arc::clone(&told))
                .map_err(|error| CliError::new(Exit::NotReached, format!("signals: {error}")))?;
        }
        Ok(Self(told))
    }

    /// Whether it is time to end.
    pub(super) fn is_told(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
