//! Wake-ups. An event says only "look": it may come once for many messages, or never if its
//! listener was dead, so the woken side always drains everything and also polls from time to time.

use super::{Bus, BusError, Ipc, create};
use crate::Span;
use iceoryx2::port::{listener::Listener, notifier::Notifier};
use iceoryx2::prelude::*;
use iceoryx2::service::port_factory::event::PortFactory;
use messages::Service;
use messages::topics::NODES_MAX;
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use std::cell::OnceCell;
use std::os::fd::BorrowedFd;
use std::rc::Rc;
use std::time::Duration;
use std::{array, iter};

/// Listens for wake-ups of one service.
#[derive(Debug)]
pub struct WakeListener {
    listener: Listener<Ipc>,
    _topic: PortFactory<Ipc>,
}

/// Reasons that have ended a sleep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Woken<const N: usize> {
    /// A wake-up.
    pub by_wake: bool,
    /// Whether each of the sources is readable.
    pub sources: [bool; N],
}

/// New members of the group, which ask writers for their latest messages.
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
        Ok(WakeListener { listener, _topic: topic })
    }
}

impl WakeListener {
    /// Sleeps until there is a wake-up, one of `sources` is readable, or `longest` has passed.
    /// After an interruption everything counts as ready.
    pub fn sleep<const N: usize>(
        &self,
        sources: &[Option<BorrowedFd<'_>>; N],
        longest: Span,
    ) -> Woken<N> {
        sleep(self.socket(), sources, longest)
    }

    fn socket(&self) -> BorrowedFd<'_> {
        let descriptor = self.listener.file_descriptor();
        // SAFETY: the listener holds the descriptor open as long as the result borrows it; it is
        // not closed through the result.
        #[allow(unsafe_code)]
        unsafe {
            BorrowedFd::borrow_raw(descriptor.native_handle())
        }
    }

    /// Takes all pending wake-ups, to be called before topics are read. Returns new members, if
    /// any: its readers wait for [`Bus::connect`].
    pub fn take(&self) -> Option<Joined> {
        let mut joined = None;
        let taken = self.listener.try_wait(|event| joined = joined.max(Joined::of_event(event.id)));
        if let Err(error) = taken {
            tracing::debug!(?error, "wake-ups not taken; the next pass takes them");
        }
        joined
    }
}

fn sleep<const N: usize>(
    socket: BorrowedFd<'_>,
    sources: &[Option<BorrowedFd<'_>>; N],
    longest: Span,
) -> Woken<N> {
    // A missing source is replaced by the socket, without events, so that each keeps its place.
    let source = |fd: &Option<_>| match fd {
        Some(fd) => PollFd::from_borrowed_fd(*fd, PollFlags::IN),
        None => PollFd::from_borrowed_fd(socket, PollFlags::empty()),
    };
    let own = PollFd::from_borrowed_fd(socket, PollFlags::IN);
    let mut polled: Vec<_> = iter::once(own).chain(sources.iter().map(source)).collect();
    // A span that no timeout can state is longer than any process lives.
    let longest = Timespec::try_from(Duration::from_nanos(longest.0)).ok();
    if poll(&mut polled, longest.as_ref()).is_err() {
        return Woken { by_wake: true, sources: [true; N] };
    }
    let is_ready = |n: usize| !polled[n].revents().is_empty();
    let sources = array::from_fn(|n| sources[n].is_some() && is_ready(n + 1));
    Woken { by_wake: is_ready(0), sources }
}

impl WakeNotifier {
    /// Opens the listener now.
    ///
    /// # Errors
    /// iceoryx2 fails.
    pub(super) fn open(bus: &Bus, service: Service) -> Result<Self, BusError> {
        let port = OnceCell::from(Port::open(&bus.node, service)?);
        Ok(Self { service, node: Rc::clone(&bus.node), port })
    }

    /// Opens the listener with its first wake-up.
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

    /// Asks the service for the latest messages of its topics. A failure is harmless: they come
    /// with its next ones.
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

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests {
    use super::*;
    use crate::clock;
    use std::os::fd::AsFd;
    use std::os::unix::net::UnixDatagram;

    #[test]
    fn sleep_ends_on_time_or_by_what_it_waits_for() {
        let (here, there) = UnixDatagram::pair().unwrap();
        let (source, other) = UnixDatagram::pair().unwrap();
        let sources = [None, Some(source.as_fd())];
        let asleep = |longest| sleep(here.as_fd(), &sources, longest);
        let woken = |by_wake, by_source| Woken { by_wake, sources: [false, by_source] };
        for ms in [20, 1, 0, 5] {
            let began = clock::now();
            assert_eq!(asleep(Span::from_ms(ms)), woken(false, false));
            assert!(clock::now().since(began) >= Span::from_ms(ms));
        }
        there.send(&[0]).unwrap();
        assert_eq!(asleep(Span(u64::MAX)), woken(true, false));
        other.send(&[0]).unwrap();
        assert_eq!(asleep(Span::from_ms(1_000)), woken(true, true));
    }
}
