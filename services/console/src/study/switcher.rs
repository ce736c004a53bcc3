//! Has the supervisor switch the policy's planner, on a thread of its own: it takes its time.

use std::io;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded};
use service::control::{Reply, Request, call};

use super::watch::Wish;

/// How long the supervisor may take: longer than it gives a service to come up and the old one to come
/// back.
const PATIENCE: Duration = Duration::from_secs(60);
/// … and how long the policy may take to become ready after a restart.
const READY_MS: u64 = 30_000;

/// An order that was carried out, or why it was not.
pub(super) type Done = (Wish, Result<(), String>);

/// The way to the supervisor.
#[derive(Debug)]
pub(super) struct Switcher {
    orders: Sender<Wish>,
    results: Receiver<Done>,
    is_busy: bool,
}

impl Switcher {
    /// A thread that talks to the supervisor at `socket`; the policy's program lies at `policy`.
    pub(super) fn start(socket: PathBuf, policy: PathBuf) -> io::Result<Self> {
        let (orders, to_do) = bounded::<Wish>(1);
        let (done, results) = bounded(1);
        let work = move || {
            for wish in to_do {
                let result = carry_out(&socket, &policy, &wish);
                if done.send((wish, result)).is_err() {
                    return;
                }
            }
        };
        std::thread::Builder::new().name("study".into()).spawn(work)?;
        Ok(Self { orders, results, is_busy: false })
    }

    /// Whether an order is under way.
    pub(super) fn is_busy(&self) -> bool {
        self.is_busy
    }

    /// Gives an order; only while none is under way.
    pub(super) fn order(&mut self, wish: Wish) {
        self.is_busy = self.orders.try_send(wish).is_ok();
    }

    /// What became of the order, once.
    pub(super) fn result(&mut self) -> Option<Done> {
        let result = self.results.try_recv().ok();
        self.is_busy &= result.is_none();
        result
    }
}

fn carry_out(socket: &Path, policy: &Path, wish: &Wish) -> Result<(), String> {
    let service = "policy".to_owned();
    let request = match wish {
        Wish::Cancel => return Ok(()),
        Wish::Switch(planner) => {
            let words = [policy.display().to_string(), "--planner".to_owned(), planner.clone()];
            let directory = std::env::current_dir().unwrap_or_else(|_| PathBuf::from("/"));
            Request::Swap { service, command: words.to_vec(), directory }
        }
        Wish::Restore(_) => Request::Restart { service, original: true, wait_ms: READY_MS },
    };
    match call(socket, &request, PATIENCE) {
        Ok(Reply::Refused(refusal)) => Err(refusal.message),
        Ok(_) => Ok(()),
        Err(error) => Err(error.to_string()),
    }
}
