//! Orders to the motion stop, on the stop's own path: no owner, no queue, no main loop is asked.

use std::sync::Arc;
use std::time::{Duration, Instant};

use messages::{MotionOrder, StopId};
use serde::Serialize;
use service::group::GroupPaths;
use service::stop_socket::{self, RELEASE_PATIENCE, StopError, StopState};
use tokio::sync::{Semaphore, oneshot, watch};
use tokio::time::timeout;

use crate::problem::Problem;

/// Time for the arm to confirm a stop before its giver is answered; the stop is repeated beyond it.
const STOP_PATIENCE: Duration = Duration::from_millis(1_500);
/// Stops that are repeated at a time until the arm confirms them. One beyond them is given up with its answer: the others
/// say the same.
const REPEATED_MAX: usize = 16;

/// The way to the arm.
#[derive(Debug)]
pub(crate) struct Motion {
    paths: GroupPaths,
    repeated: Arc<Semaphore>,
    ending: watch::Receiver<bool>,
}

/// A confirmed order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct Confirmed {
    /// The stop is latched.
    stopped: bool,
    /// No joint moves.
    at_rest: bool,
    /// The latch outlives a restart of the arm's service.
    durable: bool,
}

impl From<StopState> for Confirmed {
    fn from(StopState { stopped, at_rest, durable, .. }: StopState) -> Self {
        Self { stopped, at_rest, durable }
    }
}

type Outcome = Result<StopState, StopError>;

impl Motion {
    pub(crate) fn new(paths: GroupPaths, ending: watch::Receiver<bool>) -> Self {
        Self { paths, repeated: Arc::new(Semaphore::new(REPEATED_MAX)), ending }
    }

    /// Stops the arm; returns once it is latched and at rest. A stop that is not confirmed in time is repeated until it is,
    /// until a later order overrules it, or until the console ends, which leaves it to the arm's return.
    pub(crate) async fn stop(&self) -> Result<Confirmed, Problem> {
        let answer = self.begin_stop();
        match timeout(STOP_PATIENCE + Duration::from_millis(500), answer).await {
            Ok(Ok(Ok(state))) => Ok(state.into()),
            Ok(Ok(Err(why @ StopError::NoGroup(_)))) => Err(Problem::unavailable(why.to_string())),
            Ok(Ok(Err(why @ StopError::Overruled))) => {
                Err(Problem::conflict("overruled", why.to_string()))
            }
            Ok(Ok(Err(why))) => Err(Problem::not_confirmed(why.to_string())),
            Ok(Err(_)) | Err(_) => Err(Problem::not_confirmed(StopError::Ended.to_string())),
        }
    }

    /// Gives the stop on a thread of its own. The answer comes with the confirmation, or once the patience is over.
    fn begin_stop(&self) -> oneshot::Receiver<Outcome> {
        let (answer, answered) = oneshot::channel();
        let (paths, ending) = (self.paths.clone(), self.ending.clone());
        let permit = Arc::clone(&self.repeated).try_acquire_owned().ok();
        tokio::task::spawn_blocking(move || {
            let (mut answer, began) = (Some(answer), Instant::now());
            let mut latest = StopError::Ended;
            let outcome = stop_socket::give(&paths, MotionOrder::Stop, None, &mut |why| {
                let is_late = began.elapsed() >= STOP_PATIENCE;
                why.into_iter().for_each(|why| latest = why);
                if let Some(answer) = answer.take_if(|_| is_late) {
                    // Who asked may have gone.
                    let _ = answer.send(Err(latest.clone()));
                }
                !*ending.borrow() && (permit.is_some() || !is_late)
            });
            if let Err(error) = &outcome {
                tracing::warn!(%error, "a stop is not confirmed");
            }
            let _ = answer.take().map(|answer| answer.send(outcome));
        });
        answered
    }

    /// Releases this stop, 0 for any.
    pub(crate) async fn resume(&self, stop: StopId) -> Result<Confirmed, Problem> {
        let paths = self.paths.clone();
        let give = move || stop_socket::release(&paths, stop, RELEASE_PATIENCE, &mut |_| true);
        match tokio::task::spawn_blocking(give).await {
            Ok(Ok(state)) => Ok(state.into()),
            Ok(Err(why)) => Err(not_released(&why)),
            Err(_) => Err(Problem::not_confirmed(StopError::Ended.to_string())),
        }
    }
}

fn not_released(why: &StopError) -> Problem {
    let text = why.to_string();
    match why {
        StopError::OtherStop => Problem::conflict("other_stop", text),
        StopError::TooSoon => Problem::conflict("too_soon", text),
        StopError::Overruled => Problem::conflict("overruled", text),
        StopError::NotTaken(..) => Problem::conflict("not_taken", text),
        StopError::NoGroup(_) => Problem::unavailable(text),
        _ => Problem::not_confirmed(text),
    }
}
