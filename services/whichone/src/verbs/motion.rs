//! `stop-motion` and `resume-motion`.

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
    let patience = Span::from_s(timeout.as_secs_f64());
    let state = stop_socket::give(paths, order, patience, &mut |trouble| {
        note(format!("{trouble}; trying again"));
    });
    let state = state.map_err(|error| with_reason(error, paths))?;
    if order == MotionOrder::Stop {
        believe(&state)?;
    }
    let StopState { stopped, at_rest, durable, .. } = state;
    if out.is_json() {
        out.json(&MotionStop { stopped, at_rest, durable })?;
    } else if stopped {
        out.line("the arm is stopped; release it with `whichone resume-motion`")?;
    } else {
        out.line("the arm may move")?;
    }
    if stopped && !durable {
        note(
            "the stop is not on the disk yet: it holds as long as the arm's service runs; \
              help: free some space on the disk of the group's folder",
        );
    }
    Ok(Exit::Ok)
}

/// Adds why the arm's service does not run, where the supervisor says so at once.
fn with_reason(error: StopError, paths: &GroupPaths) -> Failure {
    let reason = match error {
        StopError::Absent => Availability::now(paths).first_missing(&[Service::Arm], |_| true),
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
