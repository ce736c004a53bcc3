//! Readers and writers of fixed-layout topics.
//!
//! A writer never blocks: a slow or stopped reader loses the oldest message, and is sent again what
//! matters.

use super::gate::{Gate, reject};
use super::open::{notifiers, open_topic};
use super::renewed::Renewed;
use super::sender::Sender;
use super::{Bus, BusError, Connect, Ipc, PortError, Stamps, WireMessage, create};
use iceoryx2::port::{publisher::Publisher, subscriber::Subscriber};
use iceoryx2::prelude::{BackpressureStrategy, IceoryxSend};
use iceoryx2::sample_mut::SampleMut;
use iceoryx2::sample_mut_uninit::SampleMutUninit;
use iceoryx2::service::port_factory::publish_subscribe::PortFactory;
use messages::Stamp;
use messages::topics::Topic;
use std::cell::Cell;
use std::fmt::Debug;
use std::mem::MaybeUninit;
use std::rc::Rc;

impl Bus {
    /// Writes a fixed-layout topic.
    ///
    /// # Errors
    /// Another schema, too many writers, or an error of iceoryx2.
    pub fn writer<T: WireMessage>(&self, topic: &Topic) -> Result<Writer<T>, BusError> {
        let service = open_topic!(self, topic, T)?;
        let name = topic.name;
        let publisher = Renewed::new(name, move |failing| {
            create(name, || {
                service
                    .publisher_builder()
                    .max_loaned_samples(1)
                    .backpressure_strategy(BackpressureStrategy::DiscardData)
                    .set_degradation_handler(failing.handler())
                    .create()
            })
        })?;
        let readers = notifiers(self, topic)?;
        // A state of which only the latest message counts is repeated, and wakes when it has changed.
        let latest = (topic.buffer == 1 && !readers.is_empty()).then(Cell::default);
        let sender = Sender::open(self, name, publisher, readers);
        Ok(Writer { topic: name, sender, stamps: self.stamps(), latest })
    }

    /// Reads a fixed-layout topic.
    ///
    /// # Errors
    /// As [`Bus::writer`].
    pub fn reader<T: WireMessage>(&self, topic: &Topic) -> Result<Reader<T>, BusError> {
        self.buffered_reader(topic, topic.buffer)
    }

    pub(super) fn buffered_reader<T: WireMessage>(
        &self,
        topic: &Topic,
        buffer: usize,
    ) -> Result<Reader<T>, BusError> {
        let service = open_topic!(self, topic, T)?;
        let subscriber = subscribe(service, topic, buffer)?;
        self.greet(topic);
        let pending_max = buffer * topic.writers_max;
        Ok(Reader { topic: topic.name, pending_max, subscriber, gate: Gate::new(self, topic) })
    }
}

/// Creates the reading port of a topic, whatever its payload, which holds at most `buffer` unread messages.
pub(super) fn subscribe<P: IceoryxSend + Debug + ?Sized + 'static>(
    service: PortFactory<Ipc, P, Stamp>,
    topic: &Topic,
    buffer: usize,
) -> Result<Renewed<Subscriber<Ipc, P, Stamp>>, BusError> {
    let (name, history) = (topic.name, topic.history);
    Renewed::new(name, move |failing| {
        create(name, || {
            service
                .subscriber_builder()
                .buffer_size(buffer)
                .history_request(history)
                .set_degradation_handler(failing.handler())
                .create()
        })
    })
}

/// Shared memory for a message.
type Slot<T> = SampleMutUninit<Ipc, MaybeUninit<T>, Stamp>;

/// Writes a fixed-layout topic.
#[derive(Debug)]
pub struct Writer<T: WireMessage> {
    topic: &'static str,
    sender: Rc<Sender<Publisher<Ipc, T, Stamp>>>,
    stamps: Stamps,
    /// The message sent last, where the topic is a state that is repeated.
    latest: Option<Cell<Option<T>>>,
}

impl<T: WireMessage> Writer<T> {
    /// Sends a copy of the message, as [`Writer::send_with`] sends one that it fills in place.
    ///
    /// # Errors
    /// iceoryx2 is out of memory.
    pub fn send(&self, message: &T) -> Result<(), PortError> {
        self.send_filled(|slot| slot.write_payload(*message))
    }

    /// Fills a message in shared memory, from its default, sends it and wakes the topic's readers,
    /// unless it repeats a state: they take that with their next pass. That it was sent does not mean
    /// that it was received.
    ///
    /// # Errors
    /// iceoryx2 is out of memory.
    pub fn send_with(&self, fill: impl FnOnce(&mut T)) -> Result<(), PortError>
    where
        T: Default,
    {
        self.send_filled(|slot| {
            let mut sample = slot.write_payload(T::default());
            fill(sample.payload_mut());
            sample
        })
    }

    fn send_filled(
        &self,
        fill: impl FnOnce(Slot<T>) -> SampleMut<Ipc, T, Stamp>,
    ) -> Result<(), PortError> {
        let state = self.sender.with(|publisher| {
            let loan = publisher.loan_uninit();
            let mut slot = loan.map_err(|e| PortError::new(self.topic, format!("{e:?}")))?;
            *slot.user_header_mut() = self.stamps.next();
            let sample = fill(slot);
            let state = self.latest.as_ref().map(|_| *sample.payload());
            let sent = sample.send();
            sent.map(|_| state).map_err(|e| PortError::new(self.topic, format!("{e:?}")))
        })?;
        if self.is_news(state) {
            self.sender.wake_readers();
        }
        Ok(())
    }

    /// Returns whether what was sent differs from the last message, where the topic is a `state`.
    fn is_news(&self, state: Option<T>) -> bool {
        let Some(latest) = &self.latest else { return true };
        state != latest.replace(state)
    }
}

/// Reads a fixed-layout topic.
#[derive(Debug)]
pub struct Reader<T: WireMessage> {
    topic: &'static str,
    /// Messages that may be pending at a time.
    pending_max: usize,
    subscriber: Renewed<Subscriber<Ipc, T, Stamp>>,
    gate: Gate,
}

impl<T: WireMessage> Reader<T> {
    /// Returns the next message without copying it, if one is pending.
    ///
    /// # Errors
    /// iceoryx2 lost its connection to a writer.
    pub fn take<R>(&self, read: impl FnOnce(&T) -> R) -> Result<Option<R>, PortError> {
        self.take_stamped(|message, _| read(message))
    }

    pub(super) fn take_stamped<R>(
        &self,
        read: impl FnOnce(&T, &Stamp) -> R,
    ) -> Result<Option<R>, PortError> {
        self.subscriber.with(|subscriber| {
            loop {
                let received = subscriber.receive();
                match received.map_err(|e| PortError::new(self.topic, format!("{e:?}")))? {
                    None => return Ok(None),
                    Some(sample) if self.gate.admits(sample.user_header()) => {
                        match sample.payload().check() {
                            Ok(()) => {
                                return Ok(Some(read(sample.payload(), sample.user_header())));
                            }
                            Err(error) => reject(self.topic, &error),
                        }
                    }
                    Some(_) => {}
                }
            }
        })
    }

    /// Returns every pending message, in order. It ends even where a writer sends as fast as it is read: what
    /// arrives meanwhile wakes the reader again.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn drain(&self, mut read: impl FnMut(&T)) -> Result<(), PortError> {
        self.drain_stamped(|message, _| read(message))
    }

    /// As [`Reader::drain`], with who sent each message and when.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn drain_stamped(&self, mut read: impl FnMut(&T, &Stamp)) -> Result<(), PortError> {
        for _ in 0..self.pending_max {
            if self.take_stamped(&mut read)?.is_none() {
                break;
            }
        }
        Ok(())
    }

    /// Returns the newest pending message.
    ///
    /// # Errors
    /// As [`Reader::take`].
    pub fn latest(&self) -> Result<Option<T>, PortError> {
        let mut latest = None;
        self.drain(|message| latest = Some(*message))?;
        Ok(latest)
    }
}
