//! A thread that owns a device.

use std::thread::{self, JoinHandle};

use crossbeam_channel::{Receiver, Sender, TrySendError, bounded};

/// A thread with a bounded queue of work. Dropping it closes the queue and waits for the thread.
pub(crate) struct WorkerThread<T> {
    queue: Option<Sender<T>>,
    thread: Option<JoinHandle<()>>,
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

impl QueueError {
    pub(crate) fn of<T>(error: TrySendError<T>) -> Self {
        match error {
            TrySendError::Full(_) => Self::Full,
            TrySendError::Disconnected(_) => Self::Closed,
        }
    }
}

impl<T: Send + 'static> WorkerThread<T> {
    /// Starts the thread, which runs until its queue is closed.
    pub(crate) fn start(capacity: usize, run: impl FnOnce(&Receiver<T>) + Send + 'static) -> Self {
        let (queue, work) = bounded(capacity);
        Self { queue: Some(queue), thread: Some(thread::spawn(move || run(&work))) }
    }

    /// Queues work if there is room.
    pub(crate) fn offer(&self, work: T) -> Result<(), QueueError> {
        let queue = self.queue.as_ref().ok_or(QueueError::Closed)?;
        queue.try_send(work).map_err(QueueError::of)
    }

    /// Returns the number of requests that wait.
    #[cfg(test)]
    pub(crate) fn waiting(&self) -> usize {
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
