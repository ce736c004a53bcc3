//! A thread that owns a device, and work that gives way to all else.

use std::panic;
use std::thread::{self, JoinHandle};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};

/// A thread with a bounded queue of work. Dropping it closes the queue and waits for the thread.
pub struct WorkerThread<T> {
    queue: Option<Sender<T>>,
    thread: Option<JoinHandle<()>>,
}

/// Niceness of loading beside starting services: a third of their share of a contended processor.
const LOADING: i32 = 5;

/// Lowers the priority of this thread, and of the threads and processes that it starts from now on.
pub fn lower_priority(niceness: i32) {
    // A thread may always do so for itself.
    let _ = rustix::process::nice(niceness);
}

/// Runs `work` at a lower priority and returns its result. It must start no lasting thread or
/// process: a priority is not raised again.
pub fn in_background<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let quietly = || {
        lower_priority(LOADING);
        work()
    };
    let done = thread::scope(|scope| scope.spawn(quietly).join());
    done.unwrap_or_else(|cause| panic::resume_unwind(cause))
}

/// Error of queueing work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum QueueError {
    /// The queue is full.
    #[error("busy already")]
    Full,
    /// The thread has panicked.
    #[error("out of service: its thread has crashed")]
    Closed,
}

impl<T> From<TrySendError<T>> for QueueError {
    fn from(error: TrySendError<T>) -> Self {
        match error {
            TrySendError::Full(_) => Self::Full,
            TrySendError::Disconnected(_) => Self::Closed,
        }
    }
}

impl<T: Send + 'static> WorkerThread<T> {
    /// Starts the thread, which runs until its queue is closed.
    pub fn start(capacity: usize, run: impl FnOnce(&Receiver<T>) + Send + 'static) -> Self {
        let (queue, work) = bounded(capacity);
        Self { queue: Some(queue), thread: Some(thread::spawn(move || run(&work))) }
    }

    /// Queues work, if the queue has room.
    ///
    /// # Errors
    /// If there is none, or the thread is gone.
    pub fn offer(&self, work: T) -> Result<(), QueueError> {
        let queue = self.queue.as_ref().ok_or(QueueError::Closed)?;
        Ok(queue.try_send(work)?)
    }

    /// Returns the number of requests that wait.
    #[cfg(test)]
    pub fn waiting(&self) -> usize {
        self.queue.as_ref().map_or(0, Sender::len)
    }
}

impl<T> Drop for WorkerThread<T> {
    fn drop(&mut self) {
        self.queue = None;
        if let Some(thread) = self.thread.take() {
            // A panic of the thread has been logged.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn niceness() -> i32 {
        rustix::process::getpriority_process(Some(rustix::thread::gettid())).unwrap()
    }

    #[test]
    fn work_in_background_lowers_its_own_priority_only() {
        let own = niceness();
        assert_eq!(in_background(niceness), (own + LOADING).min(19));
        assert_eq!(niceness(), own);
        let failed = panic::catch_unwind(|| in_background(|| panic!("by the test")));
        assert_eq!(failed.unwrap_err().downcast_ref(), Some(&"by the test"));
    }
}
