//! The motion stop of a mirrored group: a thread of its own, so that an order waits for nothing.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use service::client::random_key;
use service::group::GroupPaths;
use service::stop_socket::{Caller, LOOK, StopListener, StopOrder};
use service::worker_channel::{self, DeviceReceiver, DeviceSender};
use service::{Span, clock};
use zenoh::Session;
use zenoh::qos::Priority;

use crate::motion::{Answer, Orders, Request, Seen, Way};
use crate::names::{Call, Keys};
use crate::session::request_at;

/// Longest sleep.
const LOOK_EVERY: Span = Span::from_ms(50);
/// Events of one pass.
const EVENTS_MAX: usize = 64;
/// Timeout of the robot's answer; a request is repeated much sooner.
const ANSWER_WITHIN: Duration = Duration::from_secs(2);

/// Events from other threads to this one.
pub(super) enum Event {
    /// The motion stop's state, as the robot shows it.
    Seen(Seen),
    /// The robot's answer to the request with this key.
    Answer([u8; 16], Answer),
}

/// The thread, which ends with this handle.
pub(super) struct Motion {
    pub(super) events: DeviceSender<Event>,
    is_ending: Arc<AtomicBool>,
    thread: Option<JoinHandle<()>>,
}

impl Motion {
    /// Listens on the group's stop socket.
    pub(super) fn start(
        paths: &GroupPaths,
        session: &Session,
        keys: &Keys,
    ) -> std::io::Result<Self> {
        let (events, inbox) = worker_channel::channel()?;
        let is_ending = Arc::new(AtomicBool::new(false));
        let worker = Worker {
            listener: StopListener::bind(paths)?,
            session: session.clone(),
            keys: keys.clone(),
            events: events.clone(),
            inbox,
            orders: Orders::default(),
            caller: None,
            seen: None,
        };
        let ending = Arc::clone(&is_ending);
        let thread =
            thread::Builder::new().name("stop".into()).spawn(move || worker.run(&ending))?;
        Ok(Self { events, is_ending, thread: Some(thread) })
    }
}

impl Drop for Motion {
    fn drop(&mut self) {
        self.is_ending.store(true, Ordering::Relaxed);
        self.thread.take().map(JoinHandle::join);
    }
}

struct Worker {
    listener: StopListener,
    session: Session,
    keys: Keys,
    events: DeviceSender<Event>,
    inbox: DeviceReceiver<Event>,
    orders: Orders,
    /// Caller of the order under way.
    caller: Option<(u64, Caller)>,
    seen: Option<Seen>,
}

impl Worker {
    fn run(mut self, is_ending: &AtomicBool) {
        while !is_ending.load(Ordering::Relaxed) {
            self.wait();
            self.inbox.clear();
            for _ in 0..EVENTS_MAX {
                let Some(event) = self.inbox.take() else { break };
                self.on_event(event);
            }
            let mut arrived = Vec::new();
            self.listener.drain(|command, caller| arrived.push((command, caller)));
            arrived.into_iter().for_each(|(command, caller)| self.on_order(&command, caller));
            if let Some((request, way)) = self.orders.due(self.seen, clock::now()) {
                self.ask(&request, way);
            }
        }
    }

    fn wait(&self) {
        let now = clock::now();
        let due = self.orders.next().map_or(LOOK_EVERY, |next| next.since(now).min(LOOK_EVERY));
        let timeout = Timespec { tv_sec: 0, tv_nsec: due.0 as i64 };
        let mut sources = [self.inbox.fd(), self.listener.fd()]
            .map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN));
        // Interrupted or not: everything is looked at.
        let _ = poll(&mut sources, Some(&timeout));
    }

    fn on_event(&mut self, event: Event) {
        match event {
            Event::Seen(seen) => self.seen = Some(seen),
            Event::Answer(key, answer) => {
                if let Answer::Refused(why) = &answer {
                    tracing::warn!(why, "the robot refuses the release");
                }
                let state = self.orders.on_answer(key, &answer);
                if let Some((state, (given_ns, caller))) = state.zip(self.caller.as_ref())
                    && state.given_ns == *given_ns
                {
                    self.listener.answer(caller, &state);
                }
            }
        }
    }

    fn on_order(&mut self, order: &StopOrder, caller: Caller) {
        // Nothing is known to answer with.
        if *order == LOOK && self.seen.is_none() {
            return;
        }
        let StopOrder { given_ns, .. } = *order;
        match self.orders.take(order, self.seen, random_key().0, clock::now()) {
            Ok(Some(state)) => self.listener.answer(&caller, &state),
            Ok(None) => {
                if self.caller.as_ref().is_none_or(|(given, _)| *given != given_ns) {
                    tracing::info!(order = ?order.order, "motion stop, to the robot");
                }
                self.caller = Some((given_ns, caller));
            }
            // The silence tells the client, which then advises its user.
            Err(why) => tracing::warn!(why, "order not passed on"),
        }
    }

    fn ask(&self, order: &Request, way: Way) {
        let (key, events) = (order.key, self.events.clone());
        let take = move |bytes: Vec<u8>| {
            if let Ok(answer) = postcard::from_bytes(&bytes) {
                let _ = events.offer(Event::Answer(key, answer));
            }
        };
        let payload = postcard::to_stdvec(order).unwrap_or_default();
        let priority = match way {
            Way::First => Priority::RealTime,
            Way::Second => Priority::InteractiveHigh,
        };
        let call = (Call::Motion, priority);
        request_at(&self.session, &self.keys, call, payload, ANSWER_WITHIN, take);
    }
}
