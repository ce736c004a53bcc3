//! `stop-motion` and `resume-motion`.

use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::Duration;

use messages::{MotionInhibit, MotionOrder, Service};
use serde::Serialize;
use service::Span;
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::stop_socket::{self, StopError, StopState};

use super::availability::Availability;
use crate::Outcome;
use crate::output::{Output, note};

/// The service that carries out the orders.
const ARM: &[Service] = &[Service::Arm];

/// Note on a stop that the disk does not hold yet.
pub(super) const NOT_DURABLE: &str = "the stop is not on the disk yet: it holds as long as the arm's service runs; \
     help: free some space on the disk of the group's folder";

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
    timeout: Duration,
    out: &mut Output<'_>,
) -> Outcome {
    let StopState { stopped, at_rest, durable, .. } = give(paths, order, timeout, note)?;
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

/// Latches or releases the motion stop, waits until the arm has confirmed it, and calls `report` if that
/// takes long.
pub(super) fn give(
    paths: &GroupPaths,
    order: MotionOrder,
    timeout: Duration,
    report: impl Fn(String),
) -> Result<StopState, Failure> {
    let patience = Span::from_s(timeout.as_secs_f64());
    let mut pending = Pending { paths, report, why: None };
    let state = stop_socket::give(paths, order, patience, &mut |late| pending.keep_trying(late));
    let state = state.map_err(|error| with_reason(error, paths))?;
    if order == MotionOrder::Stop {
        believe(&state)?;
    }
    Ok(state)
}

/// An order that the arm has not answered.
struct Pending<'a, R> {
    paths: &'a GroupPaths,
    report: R,
    /// Receives why the arm's service does not run, or an end where it soon will.
    why: Option<Receiver<String>>,
}

impl<R: Fn(String)> Pending<'_, R> {
    /// Notifies the user once; returns false as soon as the supervisor says that the service stays away.
    /// It is asked on a thread of its own: one that hangs must not delay the order's repetitions.
    fn keep_trying(&mut self, late: &StopError) -> bool {
        let why = self.why.get_or_insert_with(|| {
            (self.report)(format!("{late}; trying again"));
            let (sender, why) = channel();
            let paths = self.paths.clone();
            thread::spawn(move || {
                Availability::now(&paths).first_missing(ARM, |_| true).map(|why| sender.send(why))
            });
            why
        });
        *late != StopError::Absent || why.try_recv().is_err()
    }
}

/// Adds why the arm's service does not run, where the supervisor says so at once.
fn with_reason(error: StopError, paths: &GroupPaths) -> Failure {
    let reason = match error {
        StopError::Absent => Availability::now(paths).first_missing(ARM, |_| true),
        _ => None,
    };
    let reason = reason.map_or(String::new(), |reason| format!(" ({reason})"));
    Failure::new(Exit::NotReached, format!("{error}{reason}"))
}

/// Refuses to call an arm stopped whose robot is not heard.
fn believe(state: &StopState) -> Result<(), Failure> {
    match state.inhibit {
        MotionInhibit::Unheard | MotionInhibit::Stale => {
            let what = "the stop is latched, but the robot is not heard and may still move; \
                        help: use the robot's own emergency stop";
            Err(Failure::new(Exit::NotReached, what))
        }
        _ => Ok(()),
    }
}
