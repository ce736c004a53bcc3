//! Orders that a user of a terminal gives while it shows something else.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, SendError, Sender, TryRecvError, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::interrupt::Interrupt;
use command_line::output::note;
use messages::{MotionOrder, StopId};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::stop_socket::{
    self, Progress, RESUME_AFTER, StopClient, StopError, StopState, default_patience,
};
use service::{Span, Time, clock};

use super::{KEPT, NOT_DURABLE, Warnings};

/// Interval at which an order that is not confirmed is looked at.
const LOOK_EVERY: Span = Span::from_ms(10);
/// Interval at which the end of an order is waited for.
const WAIT_EVERY: Duration = Duration::from_millis(20);

/// Keeps the presses of a frightened user from releasing the motion stop, also where the arm has not heard of the stop
/// yet. Every stop prolongs the time in which nothing does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::verbs) struct ResumeGuard(Option<Time>);

impl ResumeGuard {
    /// Notes a stop, confirmed or not.
    pub(in crate::verbs) fn on_stop(&mut self, now: Time) {
        self.0 = Some(now);
    }

    /// Returns whether a release counts.
    pub(in crate::verbs) fn may_resume(self, now: Time) -> bool {
        self.0.is_none_or(|stopped| now >= stopped + RESUME_AFTER)
    }
}

/// News of an order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::verbs) struct News {
    /// The words.
    pub(in crate::verbs) text: String,
    /// Not as the user wants it.
    pub(in crate::verbs) is_bad: bool,
}

/// Gives orders to the motion stop on a thread of its own, so that neither a service that hangs nor a terminal that
/// is held up delays them. The latest is in force; a stop is repeated until it is confirmed.
///
/// At its end a stop that is not confirmed is kept for the arm's return.
pub(in crate::verbs) struct MotionOrders {
    /// None at the end.
    orders: Option<Sender<(MotionOrder, StopId)>>,
    news: Receiver<News>,
    state: Arc<State>,
    worker: Option<JoinHandle<()>>,
    paths: GroupPaths,
}

impl Drop for MotionOrders {
    fn drop(&mut self) {
        self.orders = None;
        self.worker.take().into_iter().for_each(|worker| drop(worker.join()));
        if self.state.open.load(Ordering::Relaxed) > 0 && stop_socket::is_kept(&self.paths) {
            note(KEPT);
        }
    }
}

/// State of the orders.
#[derive(Default)]
struct State {
    /// Number of orders without a result.
    open: AtomicUsize,
    /// The latest result is a failure.
    has_failed: AtomicBool,
}

impl MotionOrders {
    /// Opens the motion stop's path.
    pub(in crate::verbs) fn open(paths: &GroupPaths) -> Result<Self, Failure> {
        let failed = |error: std::io::Error| Failure::from(StopError::Socket(error.to_string()));
        let client = StopClient::open(paths).map_err(failed)?;
        let ((orders, given), (sender, news)) = (channel(), channel());
        let state = Arc::new(State::default());
        let worker = Worker {
            client,
            given,
            news: sender,
            current: None,
            warnings: Warnings::new(paths),
            taken: 0,
            state: Arc::clone(&state),
        };
        let worker = thread::Builder::new().name("stop".into()).spawn(move || worker.run());
        let worker = Some(worker.map_err(failed)?);
        Ok(Self { orders: Some(orders), news, state, worker, paths: paths.clone() })
    }

    /// Stops the arm; [`MotionOrders::news`] reports the outcome.
    pub(in crate::verbs) fn stop(&self) {
        self.give(MotionOrder::Stop, StopId(0));
    }

    /// Releases this stop, which the user saw; 0 stands for any.
    pub(in crate::verbs) fn release(&self, stop: StopId) {
        self.give(MotionOrder::Resume, stop);
    }

    fn give(&self, order: MotionOrder, stop: StopId) {
        self.state.open.fetch_add(1, Ordering::Relaxed);
        // The thread ends after this handle.
        let _ = self.orders.as_ref().map(|orders| orders.send((order, stop)));
    }

    /// Returns the next news.
    pub(in crate::verbs) fn news(&self) -> Option<News> {
        self.news.try_recv().ok()
    }

    /// Waits for the next news, and notes it.
    pub(in crate::verbs) fn await_news(&self, longest: Duration) {
        self.news.recv_timeout(longest).into_iter().for_each(|news| note(news.text));
    }

    /// Waits until no order is open, the user interrupts, or `patience` is over; notes the news. `outcome` is that of
    /// what was shown besides.
    pub(in crate::verbs) fn finish(
        &self,
        interrupt: &Interrupt,
        patience: Option<Duration>,
        outcome: Outcome,
    ) -> Outcome {
        let (is_open, began) = (|| self.state.open.load(Ordering::Relaxed) > 0, Instant::now());
        let is_late = || patience.is_some_and(|patience| began.elapsed() >= patience);
        let was_open = is_open();
        while is_open() && !interrupt.is_requested() && !is_late() {
            self.news().into_iter().for_each(|news| note(news.text));
            thread::sleep(WAIT_EVERY);
        }
        std::iter::from_fn(|| self.news()).for_each(|news| note(news.text));
        if is_open() {
            return outcome.and(Err(StopError::Ended.into()));
        }
        match was_open && self.state.has_failed.load(Ordering::Relaxed) {
            true => outcome.map(|_| Exit::NotReached),
            false => outcome,
        }
    }
}

struct Worker {
    client: StopClient,
    given: Receiver<(MotionOrder, StopId)>,
    news: Sender<News>,
    current: Option<Progress>,
    warnings: Warnings,
    /// Number of orders that have become `current`.
    taken: usize,
    state: Arc<State>,
}

impl Worker {
    /// Ends with the handle's end.
    fn run(mut self) {
        loop {
            if self.current.is_none() {
                let Ok(order) = self.given.recv() else { return };
                self.on_order(order);
            }
            let is_over = loop {
                match self.given.try_recv() {
                    Ok(order) => self.on_order(order),
                    Err(error) => break error == TryRecvError::Disconnected,
                }
            };
            if self.advance().is_err() || is_over {
                return self.current.iter().for_each(|order| self.leave(order));
            }
        }
    }

    /// Keeps a stop that is no longer repeated for the arm's return.
    fn leave(&self, order: &Progress) {
        if let Err(error) = order.leave(&self.client) {
            note(StopError::NotKept(error.to_string()));
        }
    }

    fn on_order(&mut self, (order, stop): (MotionOrder, StopId)) {
        let now = clock::now();
        self.taken += 1;
        match &mut self.current {
            Some(current) if current.order() == order => current.renew(now, stop),
            current => {
                *current = Some(Progress::new(order, now, default_patience(order)).of(stop));
            }
        }
    }

    /// Fails once the handle is gone.
    fn advance(&mut self) -> Result<(), SendError<News>> {
        let Some(current) = &mut self.current else { return Ok(()) };
        current.advance(&self.client, clock::now());
        let now = clock::now();
        if let Some(why) = current.warning(now) {
            let text = self.warnings.line(current.order(), &why);
            self.news.send(News { text, is_bad: true })?;
        }
        if let Some(result) = current.result(now) {
            let order = self.current.take();
            order.iter().filter(|_| result.is_err()).for_each(|order| self.leave(order));
            self.state.has_failed.store(result.is_err(), Ordering::Relaxed);
            self.news.send(outcome(result))?;
            self.state.open.fetch_sub(std::mem::take(&mut self.taken), Ordering::Relaxed);
            return Ok(());
        }
        let timeout = Timespec { tv_sec: 0, tv_nsec: LOOK_EVERY.0 as i64 };
        // Interrupted or not: everything is looked at.
        let _ = poll(&mut [PollFd::new(&self.client.fd(), PollFlags::IN)], Some(&timeout));
        Ok(())
    }
}

fn outcome(result: Result<StopState, StopError>) -> News {
    let (text, is_bad) = match result {
        Ok(state) if !state.stopped => ("the arm may move".to_owned(), false),
        Ok(state) if state.durable => ("the arm is stopped, at rest".to_owned(), false),
        Ok(_) => (format!("the arm is stopped, at rest; {NOT_DURABLE}"), true),
        Err(error) => (format!("not confirmed: {error}"), true),
    };
    News { text, is_bad }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_stop_prolongs_the_time_in_which_nothing_releases_it() {
        let at = |ms| Time(0) + Span::from_ms(ms);
        let mut guard = ResumeGuard::default();
        assert!(guard.may_resume(at(0)), "the stop was given elsewhere");
        for ms in [10_000, 11_900, 13_800] {
            guard.on_stop(at(ms));
            assert!(!guard.may_resume(at(ms)) && !guard.may_resume(at(ms + 1_999)));
        }
        assert!(guard.may_resume(at(15_800)));
    }
}
