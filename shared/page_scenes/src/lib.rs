//! The scene editor of the console's page: scene files of the group's configuration are read,
//! checked, written and put into force for operators.
//!
//! The console serves the [`routes`] and tells by [`Operators`] which page is the operator's. Checks
//! plan motions, which takes up to seconds, so that all of it runs on one thread of low priority.
//! Neither the main loop nor the server waits for it; abandoned requests are skipped.

mod desk;
mod http;

use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

use axum::http::StatusCode;
use crossbeam_channel::{Receiver, RecvError, Sender, bounded, select};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, oneshot};

pub use desk::Desk;
use desk::Refusal;
pub use http::routes;

/// Requests of one rank that wait for the one that is carried out.
const WAITING_MAX: usize = 8;
/// Requests with a body at a time, so that all of them together are bounded.
const BODIES_MAX: usize = 2;
/// Lower priority than the robot's services.
const NICENESS: i32 = 10;

/// Rank of a request: the operator's go ahead of viewers'.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rank {
    Operator,
    Viewer,
}

type Task = Box<dyn FnOnce(&mut Desk) + Send>;

/// The pages of the console.
pub trait Operators: Send + Sync {
    /// Checks that the page of a session is the operator's.
    ///
    /// # Errors
    /// It is not; the words are for its user.
    fn must_operate(&self, session: &str) -> Result<(), String>;
}

/// The thread that works on scenes.
#[derive(Debug)]
pub struct Scenes {
    operators: Sender<Task>,
    viewers: Sender<Task>,
    bodies: Arc<Semaphore>,
}

impl Scenes {
    /// Starts the thread; it ends when this is dropped.
    ///
    /// # Errors
    /// No thread is left.
    pub fn start(mut desk: Desk) -> io::Result<Self> {
        let (operators, first) = bounded::<Task>(WAITING_MAX);
        let (viewers, then) = bounded::<Task>(WAITING_MAX);
        std::thread::Builder::new().name("scenes".into()).spawn(move || {
            if let Err(error) = rustix::process::nice(NICENESS) {
                tracing::debug!(%error, "the scene editor runs with usual priority");
            }
            while let Ok(task) = next(&first, &then) {
                // The panic is in the log; the request gets no answer.
                let _ = catch_unwind(AssertUnwindSafe(|| task(&mut desk)));
            }
        })?;
        Ok(Self { operators, viewers, bodies: Arc::new(Semaphore::new(BODIES_MAX)) })
    }

    /// Waits for the place of a request with a body.
    async fn place(&self) -> Result<OwnedSemaphorePermit, Refusal> {
        let ends = |_| Refusal::new(StatusCode::SERVICE_UNAVAILABLE, "the console ends");
        Arc::clone(&self.bodies).acquire_owned().await.map_err(ends)
    }

    /// Has a request carried out.
    async fn ask<T: Send + 'static>(
        &self,
        rank: Rank,
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
        let queue = if rank == Rank::Operator { &self.operators } else { &self.viewers };
        queue.try_send(task).map_err(|_| Refusal::new(StatusCode::SERVICE_UNAVAILABLE, busy))?;
        let failed = "the request failed; help: see the console's log";
        answered.await.map_err(|_| Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, failed))?
    }
}

/// Waits for the next task, the operator's first; an error once no sender is left.
fn next(first: &Receiver<Task>, then: &Receiver<Task>) -> Result<Task, RecvError> {
    if let Ok(task) = first.try_recv() {
        return Ok(task);
    }
    select! {
        recv(first) -> task => task,
        recv(then) -> task => task,
    }
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use language::word_findings;

    use super::*;

    fn idle_desk() -> Desk {
        Desk::new(PathBuf::new(), String::new(), None, word_findings)
    }

    #[tokio::test]
    async fn panic_of_one_request_is_not_the_end_of_all() {
        let scenes = Scenes::start(idle_desk()).unwrap();
        let work = |_: &mut Desk| -> Result<(), Refusal> { panic!("as it was meant to") };
        let refused = scenes.ask(Rank::Viewer, work).await.unwrap_err();
        assert_eq!(refused.status, StatusCode::INTERNAL_SERVER_ERROR);
        assert_eq!(scenes.ask(Rank::Viewer, |_| Ok(7)).await.unwrap(), 7);
    }

    #[tokio::test]
    async fn viewers_do_not_keep_the_operator_from_the_editor() {
        let scenes = Arc::new(Scenes::start(idle_desk()).unwrap());
        let order = Arc::new(std::sync::Mutex::new(Vec::new()));
        let ((begin, begun), (release, released)) = (bounded::<()>(1), bounded::<()>(1));
        let ask = |rank, name: u32, wait: Option<(Sender<()>, Receiver<()>)>| {
            let (scenes, order) = (Arc::clone(&scenes), Arc::clone(&order));
            let work = move |_: &mut Desk| {
                if let Some((begin, released)) = wait {
                    begin.send(()).unwrap();
                    released.recv().unwrap();
                }
                order.lock().unwrap().push(name);
                Ok(())
            };
            tokio::spawn(async move { scenes.ask(rank, work).await })
        };
        let busy = ask(Rank::Viewer, 0, Some((begin, released)));
        while begun.try_recv().is_err() {
            tokio::task::yield_now().await;
        }
        let crowd: Vec<_> = (1..=20).map(|name| ask(Rank::Viewer, name, None)).collect();
        tokio::task::yield_now().await;
        let operator = ask(Rank::Operator, 99, None);
        tokio::task::yield_now().await;
        release.send(()).unwrap();
        busy.await.unwrap().unwrap();
        operator.await.unwrap().expect("there is a place for the operator");
        let mut refused = 0;
        for viewer in crowd {
            refused += usize::from(viewer.await.unwrap().is_err());
        }
        assert!(refused >= 20 - WAITING_MAX - 1, "{refused} refused");
        assert_eq!(order.lock().unwrap()[..2], [0, 99], "ahead of viewers who came first");
    }

    #[tokio::test]
    async fn requests_with_bodies_are_bounded() {
        let scenes = Scenes::start(idle_desk()).unwrap();
        let places = [scenes.place().await.unwrap(), scenes.place().await.unwrap()];
        assert_eq!((places.len(), scenes.bodies.available_permits()), (BODIES_MAX, 0));
        drop(places);
        assert_eq!(scenes.bodies.available_permits(), BODIES_MAX);
    }
}
