//! Wake-ups. An event says only "look": it may come once for many messages, or never where its
//! listener was dead, so the woken side always drains everything and also polls from time to time.

use super::sleeper::{Sleeper, Woken};
use super::trigger::borrow;
use super::{Bus, BusError, Ipc, create};
use crate::Span;
use iceoryx2::port::{listener::Listener, notifier::Notifier};
use iceoryx2::prelude::*;
use iceoryx2::service::port_factory::event::PortFactory;
use messages::Service;
use messages::topics::NODES_MAX;
use std::cell::OnceCell;
use std::os::fd::BorrowedFd;
use std::rc::Rc;

/// Listens for wake-ups of one service.
#[derive(Debug)]
pub struct WakeListener {
    sleeper: Sleeper,
    listener: Listener<Ipc>,
    _topic: PortFactory<Ipc>,
}

/// Who has joined the group and asks writers for their latest messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Joined {
    /// A client, which polls.
    Client,
    /// A service, which is to be woken.
    Service,
}

impl Joined {
    /// The event that says so; messages are event 0.
    fn event(self) -> EventId {
        EventId::new(match self {
            Self::Client => 1,
            Self::Service => 2,
        })
    }

    fn of_event(event: EventId) -> Option<Self> {
        [Self::Client, Self::Service].into_iter().find(|joined| joined.event() == event)
    }
}

/// Wakes one service.
#[derive(Debug)]
pub struct WakeNotifier {
    service: Service,
    node: Rc<Node<Ipc>>,
    port: OnceCell<Port>,
}

/// An open notifier.
#[derive(Debug)]
struct Port {
    notifier: Notifier<Ipc>,
    _topic: PortFactory<Ipc>,
}

pub(super) fn open(node: &Node<Ipc>, service: Service) -> Result<PortFactory<Ipc>, BusError> {
    let name = format!("wake/{}", service.name());
    let service_name =
        ServiceName::new(&name).map_err(|e| BusError::ipc(&name, format!("{e:?}")))?;
    create(&name, || {
        node.service_builder(&service_name)
            .event()
            // Each wake-up looks at every number up to it.
            .event_id_max_value(Joined::Service.event().as_value())
            .max_nodes(NODES_MAX)
            .max_notifiers(4 * NODES_MAX)
            .max_listeners(2)
            .open_or_create()
    })
}

impl Bus {
    /// Returns the wake-up listener of `service`, for that service itself.
    ///
    /// # Errors
    /// iceoryx2 fails.
    pub fn wake_listener(&self, service: Service) -> Result<WakeListener, BusError> {
        let topic = open(&self.node, service)?;
        let listener = create(service.name(), || topic.listener_builder().create())?;
        let sleeper = create(service.name(), || Sleeper::new(borrow(listener.file_descriptor())))?;
        Ok(WakeListener { sleeper, listener, _topic: topic })
    }
}

impl WakeListener {
    /// Sleeps until there is a wake-up, one of `sources` is readable, or `longest` has passed. After an
    /// interruption everything counts as ready. A source is open from the first sleep on it to the last
    /// one of all.
    pub fn sleep<const N: usize>(
        &self,
        sources: &[Option<BorrowedFd<'_>>; N],
        longest: Span,
    ) -> Woken<N> {
        self.sleeper.sleep(sources, longest)
    }

    /// Takes all pending wake-ups, to be called before topics are read. Returns who has joined, if
    /// anybody: its readers wait for [`Bus::connect`].
    pub fn take(&self) -> Option<Joined> {
        self.sleeper.empty(borrow(self.listener.file_descriptor()));
        let mut joined = None;
        let taken = self.listener.try_wait(|event| joined = joined.max(Joined::of_event(event.id)));
        if let Err(error) = taken {
            tracing::debug!(?error, "wake-ups not taken; the next pass takes them");
        }
        joined
    }
}

impl WakeNotifier {
    /// Opens it now.
    ///
    /// # Errors
    /// iceoryx2 fails.
    pub(super) fn open(bus: &Bus, service: Service) -> Result<Self, BusError> {
        let port = OnceCell::from(Port::open(&bus.node, service)?);
        Ok(Self { service, node: Rc::clone(&bus.node), port })
    }

    /// Opens it with its first wake-up.
    pub(super) fn open_later(bus: &Bus, service: Service) -> Self {
        Self { service, node: Rc::clone(&bus.node), port: OnceCell::new() }
    }

    /// The open notifier. Each wake-up tries to open one that is not.
    fn notifier(&self) -> Option<&Notifier<Ipc>> {
        if self.port.get().is_none() {
            match Port::open(&self.node, self.service) {
                Ok(port) => self.port.set(port).ok()?,
                Err(error) => {
                    tracing::warn!(service = self.service.name(), %error, "not woken: it looks by itself");
                    return None;
                }
            }
        }
        self.port.get().map(|port| &port.notifier)
    }

    /// Wakes the service, if it is there. A failure is harmless: the service polls as well.
    pub(super) fn notify(&self) {
        if let Some(Err(error)) = self.notifier().map(Notifier::notify) {
            tracing::debug!(?error, "wake-up not delivered");
        }
    }

    /// Asks the service for the latest messages of its topics. A failure is harmless: they come with
    /// its next ones.
    pub(super) fn greet(&self, joins: Joined) {
        let greet = |it: &Notifier<Ipc>| it.notify_with_custom_event_id(joins.event());
        if let Some(Err(error)) = self.notifier().map(greet) {
            tracing::debug!(?error, "greeting not delivered");
        }
    }
}

impl Port {
    fn open(node: &Node<Ipc>, service: Service) -> Result<Self, BusError> {
        let topic = open(node, service)?;
        let notifier = create(service.name(), || topic.notifier_builder().create())?;
        Ok(Self { notifier, _topic: topic })
    }
}
