//! The state machine of one service: its desired and actual state, and the single action
//! to take next.
//!
//! Pure: an event and the time go in, at most one [`Effect`] comes out. [`Effect::Spawn`] is only
//! ever given when no incarnation lives, every state in which an incarnation owes something has a
//! deadline, and the only way out of a live state is [`Event::Exited`].

use std::time::Duration;

use crate::Time;
use crate::configuration::Restart;
use crate::restart_limiter::{RestartLimiter, Verdict};
use service::exit::ProcessExit;

pub use service::status::{Actual, Failure, ServiceState, Wanted};
pub use vocabulary::{Effect, Event, HeldBecause, Limits};

use state::{State, Step, Why};

mod state;
mod vocabulary;

#[cfg(test)]
mod properties;
#[cfg(test)]
mod tests;

/// Time between an abort signal, or the stop of a service that failed, and the kill: enough to
/// write a backtrace, too short to be waited for.
pub const KILL_GRACE: Duration = Duration::from_millis(500);

/// A killed process that does not end sits in the kernel; it is killed again in this interval.
const KILL_AGAIN: Duration = Duration::from_secs(1);

/// A service may ask for more time (`EXTEND_TIMEOUT_USEC`), but not for more than this many times
/// its deadline, so that a stuck one cannot keep a stop waiting for ever.
const EXTENSIONS_MAX: u32 = 4;

/// Each start that was not ready in time doubles the time for the next one, up to so many times: on
/// a busy machine, services that are killed together would only compete with their successors.
const DOUBLINGS_MAX: u32 = 3;

/// One service's state.
#[derive(Clone, Debug)]
pub struct Machine {
    /// Its limits; a change applies from the next event on.
    pub limits: Limits,
    wanted: Wanted,
    state: State,
    incarnation: u32,
    deadline: Option<Time>,
    restart_limiter: RestartLimiter,
    failure: Option<Failure>,
    /// Starts in a row that were not ready in time.
    late: u32,
    /// True if the current or last incarnation has said that it is short of a resource.
    short: bool,
}

impl Machine {
    /// A service that has never run and is not wanted yet.
    pub fn new(limits: Limits) -> Self {
        Self {
            limits,
            wanted: Wanted::Down,
            state: State::Down,
            incarnation: 0,
            deadline: None,
            restart_limiter: RestartLimiter::default(),
            failure: None,
            late: 0,
            short: false,
        }
    }

    /// Handles one event at time `now` and returns the effect.
    ///
    /// The effect has to be carried out before the next event is given.
    pub fn on(&mut self, event: Event, now: Time) -> Option<Effect> {
        match event {
            Event::Start => self.start(),
            Event::Admit => self.admit(now),
            Event::Stop => self.stop(now),
            Event::Retire => self.retire(),
            Event::Restart => self.restart(now),
            Event::Hold => self.hold(now),
            Event::Release => self.release(),
            Event::Ready => self.ready(now),
            Event::Beat => self.beat(now),
            Event::Extend(by) => self.extend(by, now),
            Event::Short(short) => {
                self.short = short;
                None
            }
            Event::Exited(exit) => self.exited(exit, now),
            Event::Clock => self.clock(now),
        }
    }

    /// Desired state.
    pub fn wanted(&self) -> Wanted {
        self.wanted
    }

    /// Returns its current state.
    pub fn actual(&self) -> Actual {
        self.state.actual()
    }

    /// Returns true if a process of it exists.
    pub fn is_live(&self) -> bool {
        matches!(self.actual(), Actual::Starting | Actual::Ready | Actual::Stopping)
    }

    /// Returns the state in one word.
    pub fn state(&self) -> ServiceState {
        match self.state {
            State::Down if self.wanted == Wanted::Up => ServiceState::Waiting,
            State::Down => ServiceState::Down,
            State::Starting { .. } => ServiceState::Starting,
            State::Ready { .. } if self.short => ServiceState::Short,
            State::Ready { .. } => ServiceState::Ready,
            State::Stopping { .. } => ServiceState::Stopping,
            State::Backoff { short: true } => ServiceState::Short,
            State::Backoff { short: false } => ServiceState::Restarting,
            State::Held(HeldBecause::Operator) => ServiceState::Held,
            State::Held(_) => ServiceState::Failed,
        }
    }

    /// Returns the reason for holding it, if it is held.
    pub fn held_because(&self) -> Option<HeldBecause> {
        match self.state {
            State::Held(because) => Some(because),
            _ => None,
        }
    }

    /// Returns the failure for which the current or last incarnation was stopped.
    pub fn failure(&self) -> Option<Failure> {
        self.failure
    }

    /// Number of the current or last incarnation; 0 before the first.
    pub fn incarnation(&self) -> u32 {
        self.incarnation
    }

    /// Returns the time of the next [`Event::Clock`].
    pub fn deadline(&self) -> Option<Time> {
        self.deadline
    }

    /// Moves the deadline of a live incarnation: the supervisor itself stood still for `by`, and
    /// no service is judged by time in which its notifications were not read.
    pub fn postpone(&mut self, by: Duration) {
        if self.is_live() {
            self.deadline = self.deadline.map(|deadline| deadline + by);
        }
    }

    fn start(&mut self) -> Option<Effect> {
        self.wanted = Wanted::Up;
        match self.state {
            State::Held(_) | State::Backoff { .. } => self.rest(),
            State::Stopping { ref mut why, .. } if *why == Why::Hold => *why = Why::Asked,
            _ => {}
        }
        None
    }

    fn admit(&mut self, now: Time) -> Option<Effect> {
        (self.wanted == Wanted::Up && self.state == State::Down).then(|| self.spawn(now))
    }

    fn stop(&mut self, now: Time) -> Option<Effect> {
        self.wanted = Wanted::Down;
        self.end(Why::Asked, now)
    }

    fn retire(&mut self) -> Option<Effect> {
        self.wanted = Wanted::Down;
        if !self.is_live() {
            self.rest();
        }
        None
    }

    fn restart(&mut self, now: Time) -> Option<Effect> {
        self.wanted = Wanted::Up;
        self.restart_limiter.forget();
        self.late = 0;
        if self.is_live() {
            return self.end(Why::Asked, now);
        }
        Some(self.spawn(now))
    }

    fn hold(&mut self, now: Time) -> Option<Effect> {
        if self.is_live() {
            return self.end(Why::Hold, now);
        }
        self.keep_held(HeldBecause::Operator);
        None
    }

    fn release(&mut self) -> Option<Effect> {
        match self.state {
            State::Held(_) => self.rest(),
            State::Stopping { ref mut why, .. } if *why == Why::Hold => *why = Why::Asked,
            _ => {}
        }
        None
    }

    fn ready(&mut self, now: Time) -> Option<Effect> {
        if let State::Starting { .. } = self.state {
            self.state = State::Ready { since: now };
            self.late = 0;
            self.deadline = self.limits.watchdog.map(|period| now + period);
        }
        None
    }

    fn beat(&mut self, now: Time) -> Option<Effect> {
        if let (State::Ready { .. }, Some(period)) = (self.state, self.limits.watchdog) {
            // A beat never takes back time that was granted.
            self.deadline = self.deadline.max(Some(now + period));
        }
        None
    }

    fn extend(&mut self, by: Duration, now: Time) -> Option<Effect> {
        let latest = match self.state {
            State::Starting { since } => since + self.start_limit() * EXTENSIONS_MAX,
            State::Stopping {
                since, step: Step::Terminating, why: Why::Asked | Why::Hold, ..
            } => since + self.limits.stop * EXTENSIONS_MAX,
            State::Ready { .. } => now + self.limits.watchdog? * EXTENSIONS_MAX,
            _ => return None,
        };
        self.deadline = self.deadline.max(Some((now + by).min(latest)));
        None
    }

    fn exited(&mut self, exit: ProcessExit, now: Time) -> Option<Effect> {
        let (why, ready_for) = match self.state {
            State::Starting { .. } => (None, None),
            State::Ready { since } => (None, Some(now.saturating_sub(since))),
            State::Stopping { why, ready_for, .. } => (Some(why), ready_for),
            State::Down | State::Backoff { .. } | State::Held(_) => return None,
        };
        let lacks = self.short || exit.is_shortage();
        (self.state, self.deadline) = (State::Down, None);
        match why {
            Some(Why::Hold) => self.keep_held(HeldBecause::Operator),
            _ if self.wanted == Wanted::Down => self.rest(),
            Some(Why::Asked) => return Some(self.spawn(now)),
            _ if lacks && self.limits.restart != Restart::Never => self.retry(ready_for, now),
            // Starts that are given more time each are too far apart for the limiter.
            Some(Why::Failed) if self.late >= self.limits.restart_limits.exits_max => {
                self.keep_held(HeldBecause::NeverReady(self.late));
            }
            None if exit.is_permanent() => self.keep_held(HeldBecause::Permanent(exit)),
            Some(Why::Failed) => return self.again(false, ready_for, now),
            None => return self.again(exit.is_clean(), ready_for, now),
        }
        None
    }

    /// Handles an unrequested exit.
    fn again(&mut self, clean: bool, ready_for: Option<Duration>, now: Time) -> Option<Effect> {
        match self.limits.restart {
            Restart::Never | Restart::OnFailure if clean => {
                self.wanted = Wanted::Down;
                self.rest();
                return None;
            }
            Restart::Never => {
                self.keep_held(HeldBecause::Policy);
                return None;
            }
            Restart::Always | Restart::OnFailure => {}
        }
        match self.restart_limiter.count(&self.limits.restart_limits, ready_for, now) {
            Verdict::Again => return Some(self.spawn(now)),
            Verdict::After(pause) => {
                self.state = State::Backoff { short: false };
                self.deadline = Some(now + pause);
            }
            Verdict::GiveUp { exits } => self.keep_held(HeldBecause::TooOften(exits)),
        }
        None
    }

    /// Waits for the end of a shortage.
    fn retry(&mut self, ready_for: Option<Duration>, now: Time) {
        let pause = self.restart_limiter.pause(&self.limits.restart_limits, ready_for);
        self.state = State::Backoff { short: true };
        self.deadline = Some(now + pause);
    }

    fn clock(&mut self, now: Time) -> Option<Effect> {
        if self.deadline.is_none_or(|deadline| now < deadline) {
            return None;
        }
        match self.state {
            State::Starting { .. } => {
                self.late += u32::from(!self.short);
                self.fail(Failure::NotReady, now)
            }
            State::Ready { .. } => self.fail(Failure::NoBeat, now),
            State::Stopping { ref mut step, .. } => {
                *step = Step::Killing;
                self.deadline = Some(now + KILL_AGAIN);
                Some(Effect::Kill)
            }
            State::Backoff { .. } => Some(self.spawn(now)),
            State::Down | State::Held(_) => None,
        }
    }

    /// Stops a live incarnation because of a missed deadline.
    fn fail(&mut self, failure: Failure, now: Time) -> Option<Effect> {
        self.failure = Some(failure);
        let (step, effect) = match failure {
            Failure::NotReady => (Step::Terminating, Effect::Terminate),
            Failure::NoBeat => (Step::Aborting, Effect::Abort),
        };
        let ready_for = self.state.ready_for(now);
        self.state = State::Stopping { since: now, step, why: Why::Failed, ready_for };
        self.deadline = Some(now + KILL_GRACE);
        Some(effect)
    }

    /// Stops a live incarnation on request; one that is already stopping continues to do so.
    fn end(&mut self, reason: Why, now: Time) -> Option<Effect> {
        match self.state {
            State::Starting { .. } | State::Ready { .. } => {
                let (step, ready_for) = (Step::Terminating, self.state.ready_for(now));
                self.state = State::Stopping { since: now, step, why: reason, ready_for };
                self.deadline = Some(now + self.limits.stop);
                return Some(Effect::Terminate);
            }
            State::Stopping { ref mut why, .. } => *why = reason,
            State::Down | State::Backoff { .. } | State::Held(_) => self.rest(),
        }
        None
    }

    fn spawn(&mut self, now: Time) -> Effect {
        assert!(!self.is_live(), "an incarnation lives: {:?}", self.state);
        self.incarnation += 1;
        (self.failure, self.short) = (None, false);
        self.state = State::Starting { since: now };
        self.deadline = Some(now + self.start_limit());
        Effect::Spawn
    }

    /// The time that the present start may take.
    fn start_limit(&self) -> Duration {
        self.limits.start * 2_u32.pow(self.late.min(DOUBLINGS_MAX))
    }

    /// Resets it to down without a failure.
    fn rest(&mut self) {
        self.restart_limiter.forget();
        self.late = 0;
        self.state = State::Down;
        self.deadline = None;
    }

    fn keep_held(&mut self, because: HeldBecause) {
        self.state = State::Held(because);
        self.deadline = None;
    }
}
