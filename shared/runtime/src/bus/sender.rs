//! The sending end of a topic: its port, and the wake-ups of its readers.

use super::renewed::Renewed;
use super::wake::WakeNotifier;
use super::{Bus, Connect, PortError};
use iceoryx2::port::update_connections::UpdateConnections;
use std::fmt::Debug;
use std::rc::Rc;

/// The port of a writer, with the notifiers of the services that read its topic.
#[derive(Debug)]
pub(super) struct Sender<P> {
    topic: &'static str,
    port: Renewed<P>,
    readers: Vec<Rc<WakeNotifier>>,
}

impl<P: UpdateConnections + Debug + 'static> Sender<P> {
    /// Creates it, known to the bus from now on.
    pub(super) fn open(
        bus: &Bus,
        topic: &'static str,
        port: Renewed<P>,
        readers: Vec<Rc<WakeNotifier>>,
    ) -> Rc<Self> {
        let sender = Rc::new(Self { topic, port, readers });
        let known: Rc<dyn Connect> = Rc::clone(&sender) as _;
        bus.writers.borrow_mut().push(Rc::downgrade(&known));
        sender
    }

    /// Sends something through the port.
    ///
    /// # Errors
    /// The port could not be made again, or `send` fails.
    pub(super) fn with<T>(
        &self,
        send: impl FnOnce(&P) -> Result<T, PortError>,
    ) -> Result<T, PortError> {
        self.port.with(send)
    }
}

impl<P: UpdateConnections + Debug> Connect for Sender<P> {
    fn connect(&self) {
        let connected = self.port.with(|port| {
            let connected = port.update_connections();
            connected.map_err(|error| PortError::new(self.topic, format!("{error:?}")))
        });
        // The next message is another try.
        if let Err(error) = connected {
            tracing::debug!(%error, "new readers not connected");
        }
    }

    fn wake_readers(&self) {
        self.readers.iter().for_each(|reader| reader.notify());
    }
}
