//! The scene editor's half in the console: scene files of the group's configuration are read, checked, written
//! and put into force for operators.
//!
//! Checks plan motions, which takes up to seconds, so that all of it runs on one thread of low priority. Neither
//! the main loop nor the server waits for it; a request that its page has given up is skipped.

mod desk;
mod http;

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};

use axum::http::StatusCode;
use crossbeam_channel::{Sender, bounded};
use tokio::sync::oneshot;

pub use desk::Desk;
use desk::Refusal;
pub use http::routes;

/// Requests that wait for the one that is carried out.
const WAITING_MAX: usize = 8;
/// Lower priority than the robot's services.
const NICENESS: i32 = 10;

type Task = Box<dyn FnOnce(&mut Desk) + Send>;

/// The thread that works on scenes.
#[derive(Debug)]
pub struct Scenes {
    tasks: Sender<Task>,
}

impl Scenes {
    /// Starts the thread; it ends when this is dropped.
    ///
    /// # Errors
    /// No thread is left.
    pub fn start(mut desk: Desk) -> io::Result<Self> {
        let (tasks, to_do) = bounded::<Task>(WAITING_MAX);
        std::thread::Builder::new().name("scenes".into()).spawn(move || {
            if let Err(error) = rustix::process::nice(NICENESS) {
                tracing::debug!(%error, "the scene editor runs with usual priority");
            }
            for task in to_do {
                // The panic is in the log; the request gets no answer.
                let _ = catch_unwind(AssertUnwindSafe(|| task(&mut desk)));
            }
        })?;
        Ok(Self { tasks })
    }

    /// Has a request carried out.
    async fn ask<T: Send + 'static>(
        &self,
        work: impl FnOnce(&mut Desk) -> Result<T, Refusal> + Send + 'static,
    ) -> Result<T, Refusal> {
        let (answer, answered) = oneshot::channel();
        let task: Task = Box::new(move |desk| {
            if !answer.is_closed() {
                // It may be given up meanwhile.
                let _ = answer.send(work(desk));
            }
        });
        let busy = "the scene editor is busy; help: try again";
        self.tasks
            .try_send(task)
            .map_err(|_| Refusal::new(StatusCode::SERVICE_UNAVAILABLE, busy))?;
        let failed = "the request failed; help: see the console's log";
        answered.await.map_err(|_| Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, failed))?
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;

    #[tokio::test]
    async fn panic_of_one_request_is_not_the_end_of_all() {
        let scenes = Scenes::start(Desk::new(PathBuf::new(), String::new(), None)).unwrap();
        let work = |_: &mut Desk| -> Result<(), Refusal> { panic!("as it was meant to") };
        let refused = scenes.ask(work).await.unwrap_err();
        assert_eq!(refused.status, StatusCode::INTERNAL_SERVER_ERROR);
        assert_eq!(scenes.ask(|_| Ok(7)).await.unwrap(), 7);
    }
}
