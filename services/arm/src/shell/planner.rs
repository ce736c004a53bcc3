//! The thread that plans motions, so that the main loop publishes joints and obeys stops meanwhile.

use crate::In;
use crate::plan::PlanRequest;
use service::exit::Exit;
use service::worker_channel::DeviceSender;
use std::io;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;

/// The main loop's side.
#[derive(Debug)]
pub(super) struct PlannerThread {
    requests: Sender<Box<PlanRequest>>,
}

impl PlannerThread {
    /// Starts the thread, which sends each result to `results`.
    ///
    /// # Errors
    /// No thread is left.
    pub(super) fn start(results: DeviceSender<In<'static>>) -> io::Result<Self> {
        let (requests, waiting) = mpsc::channel();
        let work = move || solve_all(&waiting, &results);
        thread::Builder::new().name("planner".into()).spawn(work)?;
        Ok(Self { requests })
    }

    pub(super) fn submit(&self, request: Box<PlanRequest>) {
        // The thread ends with the process only.
        let _ = self.requests.send(request);
    }
}

fn solve_all(requests: &Receiver<Box<PlanRequest>>, results: &DeviceSender<In<'static>>) {
    let _panic_ends_service = PanicEndsService;
    while let Ok(next) = requests.recv() {
        // The latest request alone counts.
        let request = requests.try_iter().last().unwrap_or(next);
        if !results.send(In::Planned(Box::new(request.solve()))) {
            return;
        }
    }
}

/// Ends the process if its thread panics: the main loop would wait for the plan for ever.
struct PanicEndsService;

impl Drop for PanicEndsService {
    fn drop(&mut self) {
        if thread::panicking() {
            std::process::exit(Exit::Invariant as i32);
        }
    }
}
