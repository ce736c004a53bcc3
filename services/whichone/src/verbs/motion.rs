//! `stop-motion` and `resume-motion`, and the same orders within `watch` and `chat`.

use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread;
use std::time::Duration;

use command_line::Outcome;
use command_line::interrupt::Interrupt;
use command_line::output::{Output, note};
use messages::{MotionOrder, Service, StopId};
use serde::Serialize;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::stop_socket::{self, StopError, StopState, default_patience};
use service::{Span, Time, clock};

use super::availability::Availability;
use super::{up, words};

mod orders;

pub(super) use orders::{MotionOrders, News, ResumeGuard};

/// The service that carries out the orders.
const ARM: &[Service] = &[Service::Arm];

/// Time in which an arm that runs states which stop is in force.
const LOOK_WITHIN: Span = Span::from_ms(250);

/// Note on a stop that the disk does not hold yet.
const NOT_DURABLE: &str = "the stop is not on the disk yet: it holds as long as the arm's service runs; \
     help: free some space on the disk of the group's folder";

/// Note on a stop that its giver no longer repeats.
const KEPT: &str =
    "the stop is kept: the arm obeys it before it moves, as soon as its service runs again";

/// Reason for the lack of an arm where the group's supervisor was killed.
const NO_SUPERVISOR: &str = "the group has no supervisor; help: `whichone up`";

/// State of the motion stop.
#[derive(Serialize)]
struct MotionStop {
    stopped: bool,
    at_rest: bool,
    durable: bool,
}

/// Latches or releases the motion stop, and returns once the arm has confirmed it.
pub(super) fn motion(
    paths: &GroupPaths,
    order: MotionOrder,
    timeout: Option<Duration>,
    out: &mut Output<'_>,
) -> Outcome {
    let interrupt = Interrupt::listen()?;
    let patience = timeout.map(|timeout| Span::from_s(timeout.as_secs_f64()));
    let patience = patience.or(default_patience(order));
    let mut warnings = Warnings::new(paths);
    let keep_trying = &mut |why: Option<StopError>| {
        why.into_iter().for_each(|why| note(warnings.line(order, &why)));
        !interrupt.is_requested()
    };
    let state = match order {
        MotionOrder::Stop => stop_socket::give(paths, order, patience, keep_trying),
        MotionOrder::Resume => {
            stop_socket::release(paths, stop_in_force(paths), patience, keep_trying)
        }
    };
    let state = state.map_err(|error| {
        if order == MotionOrder::Stop && stop_socket::is_kept(paths) {
            note(KEPT);
        }
        warnings.failure(&error)
    })?;
    let StopState { stopped, at_rest, durable, .. } = state;
    if out.is_json() {
        out.json(&MotionStop { stopped, at_rest, durable })?;
    } else if stopped {
        out.line("the arm is stopped; release it with `whichone resume-motion`")?;
    } else {
        out.line("the arm may move")?;
    }
    if stopped && !durable {
        note(NOT_DURABLE);
    }
    Ok(Exit::Ok)
}

/// Returns the stop in force, and notes it for the user. If the arm does not answer, that is any stop: the release
/// itself reports why.
fn stop_in_force(paths: &GroupPaths) -> StopId {
    let Some(state) = stop_socket::look(paths, LOOK_WITHIN) else { return StopId(0) };
    // The age of one from before the machine's start is unknown.
    if state.stop > StopId(0) && state.in_force_ns > 0 {
        let age = words::time(clock::now().since(Time(state.in_force_ns)).s());
        note(format_args!("releasing the stop that was given {age} ago"));
    }
    state.stop
}

/// Warnings about an order that is not confirmed, with the supervisor's reason as soon as it has answered. It is
/// asked on threads of their own: one that hangs must not delay the order's repetitions.
struct Warnings {
    paths: GroupPaths,
    reasons: (Sender<Option<String>>, Receiver<Option<String>>),
    is_asked: bool,
    reason: Option<String>,
}

impl Warnings {
    fn new(paths: &GroupPaths) -> Self {
        Self { paths: paths.clone(), reasons: channel(), is_asked: false, reason: None }
    }

    /// Returns the failure of the order.
    fn failure(&mut self, why: &StopError) -> Failure {
        Failure::new(Exit::NotReached, format!("{why}{}", self.reason(why)))
    }

    /// Returns the line for the user.
    fn line(&mut self, order: MotionOrder, why: &StopError) -> String {
        let reason = self.reason(why);
        if !std::mem::replace(&mut self.is_asked, true) {
            let (paths, reasons) = (self.paths.clone(), self.reasons.0.clone());
            thread::spawn(move || {
                let found = Availability::now(&paths);
                let ended = || up::is_running(&paths).is_ok_and(|is_running| !is_running);
                let reason = found.first_missing(ARM, |_| true);
                let no_supervisor = || ended().then(|| NO_SUPERVISOR.to_owned());
                reasons.send(reason.or_else(no_supervisor))
            });
        }
        let order = match order {
            MotionOrder::Stop => "the stop",
            MotionOrder::Resume => "the release",
        };
        format!("not confirmed: {why}{reason}; {order} is repeated")
    }

    /// Returns why the arm's service does not run, where the supervisor has said so.
    fn reason(&mut self, why: &StopError) -> String {
        if let Some(reason) = self.reasons.1.try_iter().last() {
            (self.reason, self.is_asked) = (reason, false);
        }
        match (&self.reason, why) {
            (Some(reason), StopError::Absent) => format!(" ({reason})"),
            _ => String::new(),
        }
    }
}
