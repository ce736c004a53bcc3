//! The sending end of a topic, whatever its messages: its port, and the wake-ups of its readers.

use super::open::{notifiers, open_topic};
use super::port::{Loan, SendPort};
use super::renewed::Renewed;
use super::wake::WakeNotifier;
use super::{Bus, BusError, Connect, PortError, Stamps, create, segment_error};
use iceoryx2::port::LoanError;
use iceoryx2::port::update_connections::UpdateConnections;
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy};
use messages::topics::Topic;
use std::fmt::Debug;
use std::mem::MaybeUninit;
use std::rc::Rc;

/// First guess at the size of an encoded payload, bytes; it grows as needed.
const BYTES: usize = 4096;
/// The same for clients, which mostly send a sentence and end: room for dozens of payloads.
const CLIENT_BYTES: usize = 1024;

/// The port of a writer, with the notifiers of the services that read its topic.
#[derive(Debug)]
pub(super) struct Sender {
    pub(super) topic: &'static str,
    port: Renewed<SendPort>,
    readers: Vec<Rc<WakeNotifier>>,
    stamps: Stamps,
}

impl Sender {
    /// Opens the topic for a writer, known to the bus from now on. If a message's maximum size is
    /// known, its memory never grows: growing costs both ends a table of 288 KiB at once.
    pub(super) fn open(
        bus: &Bus,
        topic: &Topic,
        bytes_max: Option<usize>,
    ) -> Result<Rc<Self>, BusError> {
        let service = open_topic(bus, topic)?;
        let name = topic.name;
        let (slots, strategy) = match ((topic.layout)(), bytes_max) {
            (Some(_), _) => (1, AllocationStrategy::Static),
            (None, Some(most)) => (most, AllocationStrategy::Static),
            (None, None) if topic.writer.is_some() => (BYTES, AllocationStrategy::PowerOfTwo),
            (None, None) => (CLIENT_BYTES, AllocationStrategy::PowerOfTwo),
        };
        let port = Renewed::new(name, move |failing| {
            create(name, || {
                service
                    .publisher_builder()
                    .max_loaned_samples(1)
                    .initial_max_slice_len(slots)
                    .allocation_strategy(strategy)
                    .backpressure_strategy(BackpressureStrategy::DiscardData)
                    .set_degradation_handler(failing.handler())
                    .create()
            })
        })?;
        let readers = notifiers(bus, topic)?;
        let sender = Rc::new(Self { topic: name, port, readers, stamps: bus.stamps() });
        let known: Rc<dyn Connect> = Rc::clone(&sender) as _;
        bus.writers.borrow_mut().push(Rc::downgrade(&known));
        Ok(sender)
    }

    /// Returns whether a service is woken by a message.
    pub(super) fn wakes(&self) -> bool {
        !self.readers.is_empty()
    }

    /// Sends a message of `slots` bytes, which `fill` writes in place; one of fixed layout is one
    /// slot. Wakes no reader.
    ///
    /// # Errors
    /// The port cannot be made again, `fill` fails, or iceoryx2 cannot send; inner: no memory.
    ///
    /// # Safety
    /// `fill` writes every byte, or fails.
    #[allow(unsafe_code)]
    pub(super) unsafe fn send(
        &self,
        slots: usize,
        fill: impl FnOnce(&mut [MaybeUninit<u8>]) -> Result<(), PortError>,
    ) -> Result<Result<(), LoanError>, PortError> {
        self.port.with(|port| {
            segment_error::take();
            let mut loan = match Loan::take(port, slots) {
                Ok(loan) => loan,
                Err(error) => return Ok(Err(error)),
            };
            loan.stamp(self.stamps.next());
            fill(loan.memory())?;
            // SAFETY: filled without an error, every byte has been written, as the caller promises.
            let sent = unsafe { loan.send() };
            sent.map(|_| Ok(())).map_err(|e| PortError::new(self.topic, format!("{e:?}")))
        })
    }
}

impl Connect for Sender {
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
