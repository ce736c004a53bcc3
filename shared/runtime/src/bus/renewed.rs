//! A port that is made again when iceoryx2 could not connect it.
//!
//! iceoryx2 tries each connection between two ports once: if memory or descriptors were short at
//! that moment, the two stay disconnected although both live. A new port is a new try.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use iceoryx2::port::{DegradationAction, DegradationCause, DegradationInfo};

use super::{BusError, PortError};
use crate::{Span, Time, clock};

/// Shortest pause between two tries. A peer that was killed fails until the supervisor cleans up.
const PAUSE_MIN: Span = Span::from_ms(100);
/// Longest pause between two tries.
const PAUSE_MAX: Span = Span::from_ms(2_000);

/// Notes of iceoryx2 that a connection has failed.
#[derive(Clone, Debug, Default)]
pub(super) struct Failing(Arc<AtomicBool>);

impl Failing {
    fn note(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    fn is_noted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    /// The handler for a port's builder.
    pub(super) fn handler(
        &self,
    ) -> impl Fn(DegradationCause, &DegradationInfo) -> DegradationAction + Send + 'static {
        let failing = self.clone();
        move |_, _| {
            failing.note();
            DegradationAction::Ignore
        }
    }
}

/// Creates the port of a topic with the handler of its failures.
type Create<P> = Box<dyn Fn(&Failing) -> Result<P, BusError>>;

/// A reading or writing port of one topic.
pub(super) struct Renewed<P> {
    topic: &'static str,
    create: Create<P>,
    /// `None` after a failed try.
    port: RefCell<Option<P>>,
    failing: Failing,
    /// Time of the last try, and the pause after it.
    tried: Cell<(Time, Span)>,
}

impl<P> Renewed<P> {
    /// Creates the port for the first time.
    pub(super) fn new(
        topic: &'static str,
        create: impl Fn(&Failing) -> Result<P, BusError> + 'static,
    ) -> Result<Self, BusError> {
        let failing = Failing::default();
        let port = RefCell::new(Some(create(&failing)?));
        let tried = Cell::new((clock::now(), PAUSE_MIN));
        Ok(Self { topic, create: Box::new(create), port, failing, tried })
    }

    /// Uses the port, after another try to connect it if one is due.
    ///
    /// # Errors
    /// The port could not be made again, or `act` fails.
    pub(super) fn with<T>(
        &self,
        act: impl FnOnce(&P) -> Result<T, PortError>,
    ) -> Result<T, PortError> {
        if self.failing.is_noted() {
            self.renew()?;
        }
        match &*self.port.borrow() {
            Some(port) => act(port),
            None => Err(PortError::new(self.topic, "not connected; trying again".to_owned())),
        }
    }

    fn renew(&self) -> Result<(), PortError> {
        let (now, (tried, pause)) = (clock::now(), self.tried.get());
        if now < tried + pause {
            return Ok(());
        }
        // After a long time without a failure it is another one.
        let is_new = now > tried + PAUSE_MAX + PAUSE_MAX;
        let next = if is_new { PAUSE_MIN } else { Span(2 * pause.0).min(PAUSE_MAX) };
        self.tried.set((now, next));
        tracing::warn!(topic = self.topic, "a connection failed; connecting again");
        // The old one first: a topic may have one writer only.
        self.port.replace(None);
        self.failing.0.store(false, Ordering::Relaxed);
        let made = (self.create)(&self.failing);
        let port = made.map_err(|error| {
            self.failing.note();
            PortError::new(self.topic, error.to_string())
        })?;
        self.port.replace(Some(port));
        Ok(())
    }
}

impl<P> fmt::Debug for Renewed<P> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Renewed").field("topic", &self.topic).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn port_whose_connection_failed_is_created_until_it_connects() {
        let tries = Arc::new(std::sync::atomic::AtomicU32::new(0));
        let counted = Arc::clone(&tries);
        let port = Renewed::new("topic", move |failing| {
            let number = counted.fetch_add(1, Ordering::Relaxed) + 1;
            match number {
                1 => failing.note(),
                2 => return Err(BusError::ipc("topic", "no descriptor is free".to_owned())),
                _ => {}
            }
            Ok(number)
        });
        let port = port.unwrap();
        let number = || port.with(|number| Ok(*number));
        assert_eq!(number(), Ok(1), "no other try at once");
        let mut failures = 0;
        while number() != Ok(3) {
            failures += u32::from(number().is_err());
            assert!(tries.load(Ordering::Relaxed) <= 3);
            std::thread::yield_now();
        }
        assert!(failures > 0, "a port that could not be created is an error");
        assert_eq!(number(), Ok(3));
    }
}
