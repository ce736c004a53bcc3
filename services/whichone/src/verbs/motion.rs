//! `stop-motion` and `resume-motion`.

use std::time::Duration;

use messages::MotionOrder;
use serde::Serialize;
use service::Span;
use service::client::Client;
use service::exit::Exit;
use service::group::GroupPaths;

use crate::Outcome;
use crate::output::Output;

/// State of the motion stop.
#[derive(Serialize)]
struct MotionStop {
    stopped: bool,
}

/// Latches or releases the motion stop, and returns once the arm has confirmed it.
pub(super) fn motion(
    paths: &GroupPaths,
    order: MotionOrder,
    timeout: Duration,
    out: &mut Output<'_>,
) -> Outcome {
    Client::join(paths)?.motion(order, Span::from_s(timeout.as_secs_f64()))?;
    let stopped = order == MotionOrder::Stop;
    if out.is_json() {
        out.json(&MotionStop { stopped })?;
    } else if stopped {
        out.line("the arm is stopped; release it with `whichone resume-motion`")?;
    } else {
        out.line("the arm may move")?;
    }
    Ok(Exit::Ok)
}
