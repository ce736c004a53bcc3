//! Orders to the motion stop over a link, exactly as safe as on the robot.
//!
//! A stop is stamped with the robot's clock when it first arrives there, and keeps that stamp; so
//! is a release. A release names the stop that it lifts, for the arm to compare, and the state that
//! the person saw, which is younger than [`RELEASE_AGE_MAX`]: a later stop is younger still, and
//! the arm ignores a release that was stamped less than [`RESUME_AFTER`] after a stop, and orders
//! older than the last one obeyed. So a release lifts only the stop it names, in any order of
//! messages. Clocks are never compared: the seen state's age is the robot's time since it sent it.

use std::collections::VecDeque;

use messages::{MotionInhibit, MotionOrder, StopId};
use serde::{Deserialize, Serialize};
use service::bounded::push_bounded;
use service::stop_socket::{
    LOOK, Progress, RESUME_AFTER, StopClient, StopError, StopOrder, StopState, default_patience,
};
use service::{Span, Time};

/// Greatest age of the state that a release is based on.
pub const RELEASE_AGE_MAX: Span = RESUME_AFTER;
/// Most requests of each kind that are remembered. An older stop that is repeated stops again.
const KNOWN_MAX: usize = 64;

/// The motion stop's state as the robot sends it, in the robot's time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seen {
    /// Time of sending.
    pub at_ns: u64,
    /// Stamp of the order in force; 0 for none yet.
    pub in_force_ns: u64,
    /// Whether the stop is latched.
    pub stopped: bool,
    /// The stop in force, 0 for none; in a release the one that it lifts.
    pub stop: StopId,
}

impl Seen {
    /// Returns the answer to a local client that asks for the state. Rest is unknown.
    fn state(&self, now: Time) -> StopState {
        // The time of a stop from before the robot's start is unknown.
        let age = Time(self.at_ns).since(Time(self.in_force_ns));
        let in_force_ns = if self.in_force_ns == 0 { 0 } else { (now - age).ns() };
        StopState {
            given_ns: 0,
            in_force_ns,
            stopped: self.stopped,
            at_rest: false,
            durable: false,
            inhibit: MotionInhibit::None,
            stop: self.stop,
        }
    }
}

/// An order by a person.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Order {
    /// Halt and latch.
    Stop,
    /// Release the stop that the person saw.
    Release(Seen),
}

/// An order on its way to the robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Request {
    /// Made by the person's machine at random, kept through repetitions.
    pub key: [u8; 16],
    /// The order.
    pub order: Order,
}

/// The robot's answer to a request.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Answer {
    /// The arm's answer, and the stamp given to the order.
    State(Stamped),
    /// The release is refused, for this reason.
    Refused(String),
    /// The arm has not answered.
    Silent,
}

/// The arm's answer in the robot's time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stamped(pub StopState);

impl Stamped {
    /// The answer to the same order that was given at `given_ns` of the reader's clock. An order
    /// that overrules it comes right after.
    pub fn here(&self, given_ns: u64) -> StopState {
        let in_force_ns = match self.0.in_force_ns.cmp(&self.0.given_ns) {
            std::cmp::Ordering::Less => given_ns.saturating_sub(RESUME_AFTER.0),
            std::cmp::Ordering::Equal => given_ns,
            std::cmp::Ordering::Greater => given_ns.saturating_add(1),
        };
        StopState { given_ns, in_force_ns, ..self.0 }
    }
}

/// The robot's side: gives orders their stamps.
#[derive(Debug, Default)]
pub struct Register {
    known: VecDeque<([u8; 16], Time)>,
    latest: Time,
    /// Releases that came too soon after a stop: no repetition of one may be late enough.
    too_soon: VecDeque<[u8; 16]>,
}

impl Register {
    /// Returns the order for the arm and its stamp.
    ///
    /// # Errors
    /// Why a release is refused.
    pub fn stamp(&mut self, request: &Request, now: Time) -> Result<(MotionOrder, Time), String> {
        match request.order {
            Order::Stop => {
                let known = self.known(request.key);
                let stamp = known.unwrap_or_else(|| self.stamp_first(request.key, now));
                Ok((MotionOrder::Stop, stamp))
            }
            Order::Release(seen) => {
                if let Some(stamp) = self.known(request.key) {
                    return Ok((MotionOrder::Resume, stamp));
                }
                let age = now.since(Time(seen.at_ns));
                if seen.at_ns > now.ns() || age > RELEASE_AGE_MAX {
                    return Err(format!(
                        "the state that the release is based on is {:.1} s old, at most {:.0} s are allowed; \
                         help: give the order again",
                        age.s(),
                        RELEASE_AGE_MAX.s()
                    ));
                }
                let is_too_soon = now < Time(seen.in_force_ns) + RESUME_AFTER;
                if is_too_soon && !self.too_soon.contains(&request.key) {
                    push_bounded(&mut self.too_soon, KNOWN_MAX, request.key);
                }
                match self.too_soon.contains(&request.key) {
                    true => Err(StopError::TooSoon.to_string()),
                    false => Ok((MotionOrder::Resume, self.stamp_first(request.key, now))),
                }
            }
        }
    }

    fn known(&self, key: [u8; 16]) -> Option<Time> {
        self.known.iter().find(|(known, _)| *known == key).map(|(_, stamp)| *stamp)
    }

    fn stamp_first(&mut self, key: [u8; 16], now: Time) -> Time {
        // Each has a stamp of its own, so that each can be named.
        let stamp = now.max(self.latest + Span(1));
        self.latest = stamp;
        push_bounded(&mut self.known, KNOWN_MAX, (key, stamp));
        stamp
    }
}

/// The robot's side: the latest stop, which is repeated to the arm until it is confirmed or
/// overruled, even if the network is gone meanwhile and the operator's machine repeats nothing.
#[derive(Debug, Default)]
pub struct StandingStop {
    /// Stamp of the latest stop; a repetition of it is not given again.
    latest: Time,
    progress: Option<Progress>,
}

impl StandingStop {
    /// Takes in a request's order.
    pub fn take(&mut self, order: MotionOrder, stamp: Time) {
        if order == MotionOrder::Stop && stamp > self.latest {
            self.latest = stamp;
            self.progress = Some(Progress::new(order, stamp, default_patience(order)));
        }
    }

    /// Returns whether this stop is repeated here.
    pub fn repeats(&self, stamp: Time) -> bool {
        self.progress.as_ref().is_some_and(|progress| progress.given() == stamp)
    }

    /// Returns whether a stop is not confirmed.
    pub fn is_open(&self) -> bool {
        self.progress.is_some()
    }

    /// Repeats the stop if due; logs if it is late, and its end.
    pub fn advance(&mut self, client: &StopClient, now: Time) {
        let Some(progress) = &mut self.progress else { return };
        if progress.due(now) {
            let order = StopOrder::new(progress.order(), progress.given());
            progress.on_sent(&client.send(&order));
        }
        if let Some(why) = progress.warning(now) {
            tracing::warn!(%why, "stop over the link not confirmed; it is repeated");
        }
        match progress.result(now) {
            None => return,
            Some(Ok(_)) => tracing::info!("stop over the link confirmed"),
            Some(Err(why)) => tracing::warn!(%why, "stop over the link ended"),
        }
        self.progress = None;
    }

    /// Takes in an answer of the arm.
    pub fn on_answer(&mut self, state: StopState, now: Time) {
        self.progress.iter_mut().for_each(|progress| progress.on_answer(state, now));
    }
}

/// Interval at which the mirror repeats a request without an answer.
const ASK_EVERY: Span = Span::from_ms(250);
/// Time after which each repetition goes out once more, on the other way: longer than the time of
/// filling one packet, much shorter than the time in which the network notices a lost packet.
const COPY_AFTER: Span = Span::from_ms(10);
/// Time after which an order that its client no longer repeats is given up.
const GIVEN_UP: Span = Span::from_ms(1_000);

/// Priority of a request. Each has its own stream: a lost packet delays one of two copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Ahead of everything.
    First,
    /// Copy of an order, ahead of everything else.
    Second,
}

/// The mirror's side: one order at a time, the latest.
#[derive(Debug, Default)]
pub struct Orders {
    current: Option<Current>,
}

#[derive(Debug)]
struct Current {
    given_ns: u64,
    request: Request,
    /// When it goes out next, and on which way.
    due: Time,
    way: Way,
    repeated: Time,
    answer: Option<Stamped>,
}

impl Orders {
    /// Takes an order of a local client and each of its repetitions, or its question for the state.
    /// Returns the answer to it if there is one already.
    ///
    /// # Errors
    /// A release of a robot whose state is not known.
    pub fn take(
        &mut self,
        order: &StopOrder,
        seen: Option<Seen>,
        key: [u8; 16],
        now: Time,
    ) -> Result<Option<StopState>, &'static str> {
        let StopOrder { given_ns, stop, .. } = *order;
        if *order == LOOK {
            return Ok(seen.map(|seen| seen.state(now)));
        }
        if let Some(current) = self.current.as_mut().filter(|current| current.given_ns == given_ns)
        {
            current.repeated = now;
            return Ok(current.answer.map(|answer| answer.here(given_ns)));
        }
        let is_overruled = self.current.as_ref().is_some_and(|current| current.given_ns > given_ns);
        if is_overruled {
            return Ok(None);
        }
        let order = match order.order {
            MotionOrder::Stop => Order::Stop,
            MotionOrder::Resume => {
                let seen = seen.ok_or("the robot's state is not known")?;
                let stop = if stop > StopId(0) { stop } else { seen.stop };
                Order::Release(Seen { stop, ..seen })
            }
        };
        let request = Request { key, order };
        self.current = Some(Current {
            given_ns,
            request,
            due: now,
            way: Way::First,
            repeated: now,
            answer: None,
        });
        Ok(None)
    }

    /// Returns the request that is due at `now`, and its way. A release is based on the newest
    /// state in which the stop that it lifts is still in force.
    pub fn due(&mut self, seen: Option<Seen>, now: Time) -> Option<(Request, Way)> {
        self.current.take_if(|current| now >= current.repeated + GIVEN_UP);
        let current = self.current.as_mut()?;
        let is_done = current.answer.is_some_and(|Stamped(state)| state.at_rest && state.durable);
        if now < current.due || is_done {
            return None;
        }
        if let (Order::Release(old), Some(new)) = (&mut current.request.order, seen)
            && old.in_force_ns == new.in_force_ns
        {
            *old = Seen { stop: old.stop, ..new };
        }
        let way = current.way;
        (current.due, current.way) = match way {
            Way::First => (now + COPY_AFTER, Way::Second),
            Way::Second => (now + ASK_EVERY - COPY_AFTER, Way::First),
        };
        Some((current.request, way))
    }

    /// When the next request is due.
    pub fn next(&self) -> Option<Time> {
        self.current.as_ref().map(|current| current.due)
    }

    /// Takes the robot's answer to the request with `key`; returns it for the local client.
    pub fn on_answer(&mut self, key: [u8; 16], answer: &Answer) -> Option<StopState> {
        let current = self.current.as_mut().filter(|current| current.request.key == key)?;
        let Answer::State(stamped) = answer else { return None };
        current.answer = Some(*stamped);
        Some(stamped.here(current.given_ns))
    }
}

#[cfg(test)]
mod tests;
