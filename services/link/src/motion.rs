//! Orders to the motion stop over a link, exactly as safe as on the robot.
//!
//! A stop is stamped with the robot's own clock when it first arrives there, and keeps that stamp however often it is
//! repeated; so is a release. A release names the stop that it lifts, by that stop's stamp, and the state that the person
//! saw, which is younger than [`RELEASE_AGE_MAX`]: a later stop is younger still, and the arm ignores a release that was
//! stamped less than [`RESUME_AFTER`] after a stop, and orders older than the last one obeyed. So no release lifts another
//! stop than the one it names, whichever order messages arrive in. Both machines' clocks are never compared: how
//! old the seen state is, is the robot's own time since it sent it.

use std::collections::VecDeque;

use messages::MotionOrder;
use serde::{Deserialize, Serialize};
use service::stop_socket::{
    Progress, RESUME_AFTER, StopClient, StopError, StopState, default_patience,
};
use service::{Span, Time};

/// Greatest age of the state that a release is based on.
pub const RELEASE_AGE_MAX: Span = RESUME_AFTER;
/// Most requests of each kind that are remembered. An older stop that is repeated stops again.
const KNOWN_MAX: usize = 64;

/// The motion stop's state as the robot sends it, in the robot's time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Seen {
    /// When it was sent.
    pub at_ns: u64,
    /// Stamp of the order in force; 0 for none yet.
    pub in_force_ns: u64,
    /// Whether the stop is latched.
    pub stopped: bool,
}

/// What a person orders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Order {
    /// Halt and latch.
    Stop,
    /// Release the stop that was seen.
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
    /// What the arm answered, and the stamp that the order was given.
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
    /// The answer to the same order that was given at `given_ns` of the reader's clock. An order that
    /// overrules it comes right after.
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
                    remember(&mut self.too_soon, request.key);
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
        remember(&mut self.known, (key, stamp));
        stamp
    }
}

/// Adds an entry, and forgets the oldest one where there are too many.
fn remember<T>(entries: &mut VecDeque<T>, entry: T) {
    entries.push_back(entry);
    if entries.len() > KNOWN_MAX {
        entries.pop_front();
    }
}

/// The robot's side: the latest stop, which is repeated to the arm until it is confirmed or overruled, even if the
/// network is gone meanwhile and the operator's machine repeats nothing.
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

    /// Repeats the stop where that is due; logs if it is late, and its end.
    pub fn advance(&mut self, client: &StopClient, now: Time) {
        let Some(progress) = &mut self.progress else { return };
        if progress.due(now) {
            progress.on_sent(&client.send(progress.order(), progress.given()));
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
/// Time after which each repetition goes out once more, on the other way: longer than what is put into one packet, much
/// shorter than the time in which the network finds out that a packet was lost.
const COPY_AFTER: Span = Span::from_ms(10);
/// Time after which an order that its client no longer repeats is given up.
const GIVEN_UP: Span = Span::from_ms(1_000);

/// Priority under which a request travels. Each has a stream of its own, so that a lost packet holds up one of two copies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Ahead of everything.
    First,
    /// Its copy, ahead of everything else.
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
    /// Takes an order of a local client, given at `given_ns`, and each of its repetitions. Returns the answer to it if there is
    /// one already.
    ///
    /// # Errors
    /// A release of a robot whose state is not known.
    pub fn take(
        &mut self,
        (order, given_ns): (MotionOrder, u64),
        seen: Option<Seen>,
        key: [u8; 16],
        now: Time,
    ) -> Result<Option<StopState>, &'static str> {
        if let Some(current) = self.current.as_mut().filter(|current| current.given_ns == given_ns)
        {
            current.repeated = now;
            return Ok(current.answer.map(|answer| answer.here(given_ns)));
        }
        let is_overruled = self.current.as_ref().is_some_and(|current| current.given_ns > given_ns);
        if is_overruled {
            return Ok(None);
        }
        let order = match order {
            MotionOrder::Stop => Order::Stop,
            MotionOrder::Resume => Order::Release(seen.ok_or("the robot's state is not known")?),
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

    /// Returns the request that is due at `now`, and its way. A release is based on the newest state in which the stop
    /// that it lifts is still in force.
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
            *old = new;
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
mod tests {
    use super::*;
    use messages::MotionInhibit;

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    fn stop(key: u8) -> Request {
        Request { key: [key; 16], order: Order::Stop }
    }

    fn release(key: u8, at_ms: u64, in_force: Time) -> Request {
        let seen = Seen { at_ns: at(at_ms).ns(), in_force_ns: in_force.ns(), stopped: true };
        Request { key: [key; 16], order: Order::Release(seen) }
    }

    /// The arm's rules.
    #[derive(Default)]
    struct Arm {
        stopped: bool,
        obeyed: Time,
    }

    impl Arm {
        fn obey(&mut self, (order, given): (MotionOrder, Time)) {
            let is_too_soon = order == MotionOrder::Resume && given < self.obeyed + RESUME_AFTER;
            if given > self.obeyed && !(self.stopped && is_too_soon) {
                (self.stopped, self.obeyed) = (order == MotionOrder::Stop, given);
            }
        }
    }

    #[test]
    fn repeated_stop_keeps_the_stamp_of_its_first_arrival() {
        let mut register = Register::default();
        let first = register.stamp(&stop(1), at(100)).unwrap();
        assert_eq!(first, (MotionOrder::Stop, at(100)));
        assert_eq!(register.stamp(&stop(1), at(900)).unwrap(), first);
        let second = register.stamp(&stop(2), at(100)).unwrap();
        assert!(second.1 > first.1, "two stops at once have stamps of their own");
    }

    #[test]
    fn release_lifts_the_stop_that_it_names_and_no_later_one_in_every_order_of_arrival() {
        let one = at(1_000);
        let requests = [stop(1), release(3, 0, one), stop(2), release(4, 0, one), stop(1)];
        // Every sequence of five arrivals out of these, repeated and swapped as a network may.
        for word in 0..5_usize.pow(5) {
            let mut arm = Arm::default();
            let mut register = Register::default();
            arm.obey(register.stamp(&stop(1), one).unwrap());
            let mut is_stopped_again = false;
            for place in 0..5_u32 {
                let request = requests[word / 5_usize.pow(place) % 5];
                // The first half comes too soon to release anything.
                let now = at(2_600 + 200 * u64::from(place));
                is_stopped_again |= request.key == [2; 16];
                let request = match request.order {
                    Order::Stop => request,
                    Order::Release(seen) => {
                        let seen = Seen { at_ns: now.ns(), ..seen };
                        Request { order: Order::Release(seen), ..request }
                    }
                };
                match register.stamp(&request, now) {
                    Ok(order) => arm.obey(order),
                    Err(why) => assert!(why.contains("less than 2 s"), "{why}"),
                }
            }
            assert!(arm.stopped || !is_stopped_again, "{word}: a later stop was released");
        }
    }

    #[test]
    fn stop_is_repeated_at_the_robot_without_the_network() {
        use service::group::GroupPaths;
        use service::stop_socket::StopListener;
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
        std::fs::create_dir_all(paths.run()).unwrap();
        let (client, mut standing) = (StopClient::open(&paths).unwrap(), StandingStop::default());
        // One request arrives; the arm's service is away for an hour, and nothing else arrives.
        standing.take(MotionOrder::Stop, at(100));
        assert!(standing.repeats(at(100)));
        for ms in (100..3_600_000).step_by(1_000) {
            standing.advance(&client, at(ms));
            assert!(standing.is_open(), "after {ms} ms");
        }
        let arm = StopListener::bind(&paths).unwrap();
        standing.advance(&client, at(3_600_100));
        let mut heard = Vec::new();
        arm.drain(|command, _| heard.push((command.order, Time(command.given_ns))));
        assert_eq!(heard, [(MotionOrder::Stop, at(100))]);
        let state = StopState {
            given_ns: at(100).ns(),
            in_force_ns: at(100).ns(),
            stopped: true,
            at_rest: true,
            durable: true,
            inhibit: MotionInhibit::None,
        };
        standing.on_answer(state, at(3_600_101));
        standing.advance(&client, at(3_600_101));
        assert!(!standing.is_open());
        // A repetition of the request that was held up in the network, and a release.
        standing.take(MotionOrder::Stop, at(100));
        standing.take(MotionOrder::Resume, at(3_700_000));
        assert!(!standing.is_open());
    }

    #[test]
    fn old_release_is_refused() {
        let mut register = Register::default();
        assert!(register.stamp(&release(1, 1_000, at(900)), at(3_000)).is_ok());
        let error = register.stamp(&release(2, 1_000, at(900)), at(3_001)).unwrap_err();
        assert!(error.contains("2.0 s old"), "{error}");
        assert!(register.stamp(&release(3, 9_000, at(900)), at(3_000)).is_err(), "from the future");
    }

    #[test]
    fn release_that_came_too_soon_stays_refused_however_often_it_is_repeated() {
        let mut register = Register::default();
        assert!(register.stamp(&release(1, 2_800, at(900)), at(2_899)).is_err());
        assert!(register.stamp(&release(1, 2_950, at(900)), at(3_000)).is_err());
        let given_again = register.stamp(&release(2, 2_950, at(900)), at(3_000));
        assert_eq!(given_again, Ok((MotionOrder::Resume, at(3_000))));
    }

    #[test]
    fn request_is_repeated_under_one_key_while_its_client_wants_it() {
        let mut orders = Orders::default();
        let given = at(50).ns();
        let mut sent = Vec::new();
        for ms in (0..3_000).step_by(10) {
            if ms < 1_000 {
                let key = [ms as u8; 16];
                let taken = orders.take((MotionOrder::Stop, given), None, key, at(ms));
                assert_eq!(taken, Ok(None));
            }
            sent.extend(orders.due(None, at(ms)).map(|(request, way)| (ms, request.key[0], way)));
        }
        let both = |ms| [(ms, 0, Way::First), (ms + 10, 0, Way::Second)];
        let expected: Vec<_> = (0..2_000).step_by(250).flat_map(both).collect();
        assert_eq!(sent, expected);
    }

    #[test]
    fn answers_come_back_in_the_clients_time() {
        let mut orders = Orders::default();
        let given = at(50).ns();
        orders.take((MotionOrder::Stop, given), None, [1; 16], at(50)).unwrap();
        let state = StopState {
            given_ns: 900,
            in_force_ns: 900,
            stopped: true,
            at_rest: false,
            durable: false,
            inhibit: MotionInhibit::None,
        };
        assert_eq!(orders.on_answer([2; 16], &Answer::State(Stamped(state))), None);
        let here = orders.on_answer([1; 16], &Answer::State(Stamped(state))).unwrap();
        assert_eq!((here.given_ns, here.in_force_ns, here.at_rest), (given, given, false));
        let overruled = Stamped(StopState { in_force_ns: 901, ..state });
        assert_eq!(overruled.here(given).in_force_ns, given + 1);
        assert!(orders.due(None, at(60)).is_some(), "until it is at rest");
        let done = Stamped(StopState { at_rest: true, durable: true, ..state });
        orders.on_answer([1; 16], &Answer::State(done));
        assert_eq!(orders.due(None, at(900)), None);
    }

    #[test]
    fn release_needs_a_state_and_keeps_to_the_stop_that_was_seen() {
        let mut orders = Orders::default();
        let resume = (MotionOrder::Resume, at(50).ns());
        assert!(orders.take(resume, None, [1; 16], at(50)).is_err());
        let seen = Seen { at_ns: 10, in_force_ns: 5, stopped: true };
        orders.take(resume, Some(seen), [1; 16], at(50)).unwrap();
        let newer = Seen { at_ns: 20, ..seen };
        assert_eq!(orders.due(Some(newer), at(50)).unwrap().0.order, Order::Release(newer));
        let other_stop = Seen { at_ns: 30, in_force_ns: 25, stopped: true };
        assert_eq!(orders.due(Some(other_stop), at(400)).unwrap().0.order, Order::Release(newer));
    }
}
