//! Switches the policy's planner through the supervisor, on a thread of its own: that takes a while.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded};
use service::control::{Request, call};

use super::trial_monitor::RobotRequest;

/// Deadline of the supervisor: longer than a failed swap with its rollback.
const PATIENCE: Duration = Duration::from_secs(60);
/// Deadline for the policy to become ready after a restart.
const READY_MS: u64 = 30_000;

pub(super) type Done = (RobotRequest, Result<(), String>);

#[derive(Debug)]
pub(super) struct PlannerSwitch {
    orders: Sender<RobotRequest>,
    results: Receiver<Done>,
    is_busy: bool,
}

impl PlannerSwitch {
    /// Starts a thread that calls the supervisor at `socket`; `policy` is the policy's program.
    pub(super) fn start(socket: PathBuf, policy: PathBuf) -> io::Result<Self> {
        let (orders, to_do) = bounded::<RobotRequest>(1);
        let (done, results) = bounded(1);
        let work = move || {
            for request in to_do {
                let result = carry_out(&socket, &policy, &request);
                if done.send((request, result)).is_err() {
                    return;
                }
            }
        };
        std::thread::Builder::new().name("study".into()).spawn(work)?;
        Ok(Self { orders, results, is_busy: false })
    }

    pub(super) fn is_busy(&self) -> bool {
        self.is_busy
    }

    /// Sends a request; only while none is under way.
    pub(super) fn order(&mut self, request: RobotRequest) {
        self.is_busy = self.orders.try_send(request).is_ok();
    }

    pub(super) fn result(&mut self) -> Option<Done> {
        let result = self.results.try_recv().ok();
        self.is_busy &= result.is_none();
        result
    }
}

fn carry_out(socket: &Path, policy: &Path, request: &RobotRequest) -> Result<(), String> {
    let service = "policy".to_owned();
    let order = match request {
        RobotRequest::Cancel => return Ok(()),
        RobotRequest::Switch(planner) => {
            let words = [policy.display().to_string(), "--planner".to_owned(), planner.clone()];
            let directory = std::env::current_dir().unwrap_or_else(|_| PathBuf::from("/"));
            Request::Swap { service, command: words.to_vec(), directory }
        }
        RobotRequest::Restore(_) => Request::Restart { service, original: true, wait_ms: READY_MS },
    };
    call(socket, &order, PATIENCE).map(drop).map_err(|error| error.to_string())
}
