//! Orders to the motion stop: a thread of its own, for orders and the arm's answers alone.

use std::sync::mpsc::SyncSender;
use std::thread;

use messages::{MotionOrder, StopId};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use service::group::GroupPaths;
use service::stop_socket::{LOOK, StopClient, StopOrder, StopState};
use service::worker_channel::{self, DeviceReceiver, DeviceSender};
use service::{Span, Time, clock};
use zenoh::query::Query;

use super::senders::{Answer, Outlet};
use crate::motion::{self, Order, Register, Request, Seen, Stamped, StandingStop};
use crate::names::Call;

/// Interval of repeating an order to the arm while its request waits; a stop continues after.
const RESEND_EVERY: Span = Span::from_ms(10);
/// Requests of one pass, and requests that wait for the arm.
const REQUESTS_MAX: usize = 64;
/// Time for the arm to be at rest, before a request is answered with the present state.
const ANSWER_WITHIN: Span = Span::from_ms(400);
/// Interval at which the arm is asked for its state while watched.
const LOOK_EVERY: Span = Span::from_ms(500);

/// Starts the thread; returns the channel for requests.
pub(super) fn start(
    paths: &GroupPaths,
    states: Outlet,
    answers: SyncSender<Answer>,
) -> std::io::Result<DeviceSender<Query>> {
    let (sender, requests) = worker_channel::channel()?;
    let stop_client = StopClient::open(paths)?;
    let worker = Worker {
        stop_client,
        requests,
        states,
        answers,
        register: Register::default(),
        waiting: Vec::new(),
        standing: StandingStop::default(),
        looked: Time(0),
    };
    thread::Builder::new().name("stop".into()).spawn(move || worker.run())?;
    Ok(sender)
}

/// A request whose order the arm has not carried out yet.
struct Waiting {
    query: Query,
    order: StopOrder,
    since: Time,
    sent: Option<Time>,
    state: Option<StopState>,
}

struct Worker {
    stop_client: StopClient,
    requests: DeviceReceiver<Query>,
    states: Outlet,
    answers: SyncSender<Answer>,
    register: Register,
    waiting: Vec<Waiting>,
    standing: StandingStop,
    looked: Time,
}

impl Worker {
    fn run(mut self) {
        loop {
            self.wait();
            self.requests.clear();
            for _ in 0..REQUESTS_MAX {
                let Some(query) = self.requests.take() else { break };
                self.on_request(query);
            }
            self.advance(clock::now());
        }
    }

    fn wait(&self) {
        let is_idle = self.waiting.is_empty() && !self.standing.is_open();
        let longest = if is_idle { LOOK_EVERY } else { RESEND_EVERY };
        let timeout = Timespec { tv_sec: 0, tv_nsec: longest.0 as i64 };
        let mut sources = [self.requests.fd(), self.stop_client.fd()]
            .map(|fd| PollFd::from_borrowed_fd(fd, PollFlags::IN));
        // Interrupted or not: everything is looked at.
        let _ = poll(&mut sources, Some(&timeout));
    }

    fn on_request(&mut self, query: Query) {
        let payload = query.payload().map(|payload| payload.to_bytes().into_owned());
        let request = payload.and_then(|bytes| postcard::from_bytes::<Request>(&bytes).ok());
        let Some(request) = request else {
            return tracing::warn!("unintelligible order to the motion stop ignored");
        };
        let now = clock::now();
        match self.register.stamp(&request, now) {
            Ok((order, stamp)) => {
                tracing::info!(?order, stamp = stamp.ns(), "motion stop, over the link");
                self.standing.take(order, stamp);
                let stop = match request.order {
                    Order::Stop => StopId(0),
                    Order::Release(seen) => seen.stop,
                };
                let order = StopOrder { stop, ..StopOrder::new(order, stamp) };
                if self.waiting.len() >= REQUESTS_MAX {
                    // Carried out without an answer: it is asked again.
                    let _ = self.stop_client.send(&order);
                    return;
                }
                let (sent, state) = (None, None);
                self.waiting.push(Waiting { query, order, since: now, sent, state });
            }
            Err(why) => {
                tracing::warn!(why, "release refused");
                self.answer(query, &motion::Answer::Refused(why));
            }
        }
    }

    fn advance(&mut self, now: Time) {
        self.standing.advance(&self.stop_client, now);
        let is_own = |waiting: &&mut Waiting| !self.standing.repeats(Time(waiting.order.given_ns));
        for waiting in self.waiting.iter_mut().filter(is_own) {
            if waiting.sent.is_none_or(|sent| now >= sent + RESEND_EVERY) {
                waiting.sent = Some(now);
                // An arm that is absent is asked again.
                let _ = self.stop_client.send(&waiting.order);
            }
        }
        if self.states.is_motion_watched() && now >= self.looked + LOOK_EVERY {
            self.looked = now;
            let _ = self.stop_client.send(&LOOK);
        }
        while let Some(state) = self.stop_client.take() {
            self.on_state(state);
        }
        self.finish(now);
    }

    fn on_state(&mut self, state: StopState) {
        self.standing.on_answer(state, clock::now());
        for waiting in &mut self.waiting {
            if waiting.order.given_ns == state.given_ns {
                waiting.state = Some(state);
            }
        }
        if self.states.is_motion_watched() {
            let at_ns = clock::now().ns();
            let StopState { in_force_ns, stopped, stop, .. } = state;
            let seen = Seen { at_ns, in_force_ns, stopped, stop };
            self.states.motion(postcard::to_stdvec(&seen).unwrap_or_default());
        }
    }

    /// Answers orders that are carried out, or have waited long enough.
    fn finish(&mut self, now: Time) {
        let is_over = |waiting: &mut Waiting| {
            let is_late = now >= waiting.since + ANSWER_WITHIN;
            let wants_stop = waiting.order.order == MotionOrder::Stop;
            let is_done = waiting.state.is_some_and(|state| {
                let is_overruled = state.in_force_ns > waiting.order.given_ns;
                let is_carried_out = match wants_stop {
                    true => state.stopped && state.at_rest && state.durable,
                    false => !state.stopped,
                };
                is_carried_out || is_overruled
            });
            is_done || is_late
        };
        let over: Vec<Waiting> = self.waiting.extract_if(.., is_over).collect();
        for Waiting { query, state, .. } in over {
            let answer = state.map(|state| motion::Answer::State(Stamped(state)));
            self.answer(query, &answer.unwrap_or(motion::Answer::Silent));
        }
    }

    fn answer(&self, query: Query, answer: &motion::Answer) {
        let bytes = postcard::to_stdvec(answer).unwrap_or_default();
        if self.answers.try_send((Call::Motion, query, bytes)).is_err() {
            tracing::debug!("no room for an answer; it is asked again");
        }
    }
}
