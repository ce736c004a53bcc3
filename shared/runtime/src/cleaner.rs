//! The supervisor's thread that removes shared memory of dead processes while successors start.
//!
//! Starting services wait for a locked file, which a finished cleanup unlocks, even by a panic.

use crate::bus::Ipc;
use crate::group::GroupPaths;
use iceoryx2::prelude::{CallbackProgression, Config, Node, NodeState};
use rustix::fs::{FlockOperation, flock};
use rustix::io::Errno;
use std::fs::{self, File};
use std::io;
use std::os::unix::fs::MetadataExt;
use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Room for the stack of the thread, bytes. iceoryx2 keeps configurations and names on it.
const STACK_BYTES: usize = 2 << 20;

/// Timeout for another process or thread that is cleaning up.
const OTHERS_PATIENCE: Duration = Duration::from_millis(200);

/// Longest wait for a cleanup, which takes milliseconds.
const PATIENCE: Duration = Duration::from_secs(2);

/// The thread, and the lock for which starting services wait.
#[derive(Debug)]
pub(crate) struct Cleaner {
    lock: Arc<CleanupLock>,
    requests: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// A file that is locked during any cleanup.
#[derive(Debug)]
struct CleanupLock {
    path: PathBuf,
    file: File,
    /// Cleanups that have begun and not ended.
    begun: Mutex<usize>,
    ended: Condvar,
}

impl CleanupLock {
    fn begun(&self) -> MutexGuard<'_, usize> {
        self.begun.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn hold_back(&self) -> bool {
        let mut begun = self.begun();
        let inode = |found: io::Result<fs::Metadata>| found.map(|file| file.ino()).ok();
        // A removed file has no waiters.
        let is_locked = inode(self.file.metadata()) == inode(fs::metadata(&self.path))
            && flock(&self.file, FlockOperation::NonBlockingLockExclusive).is_ok();
        *begun += usize::from(is_locked);
        is_locked
    }

    fn let_go(&self) {
        let mut begun = self.begun();
        *begun = begun.saturating_sub(1);
        if *begun == 0 {
            let _ = flock(&self.file, FlockOperation::Unlock);
            self.ended.notify_all();
        }
    }
}

/// A cleanup that ends when dropped.
struct Begun<'a>(&'a CleanupLock);

impl Drop for Begun<'_> {
    fn drop(&mut self) {
        self.0.let_go();
    }
}

impl Cleaner {
    /// Starts the thread, which removes the leftovers that `config` finds.
    ///
    /// # Errors
    /// The lock's file cannot be written, or the thread cannot start.
    pub(crate) fn start(lock: PathBuf, config: Config) -> io::Result<Self> {
        let file = safe_files::open_lock(&lock)?;
        let (begun, ended) = (Mutex::default(), Condvar::default());
        let lock = Arc::new(CleanupLock { path: lock, file, begun, ended });
        let (requests, inbox) = mpsc::channel();
        let work = {
            let lock = Arc::clone(&lock);
            move || {
                for () in inbox {
                    let _begun = Begun(&lock);
                    clean(&config);
                }
            }
        };
        let thread = thread::Builder::new().name("cleaner".into()).stack_size(STACK_BYTES);
        let thread = Some(thread.spawn(work)?);
        Ok(Self { lock, requests: Some(requests), thread })
    }

    /// Begins a cleanup, for which starting services wait. Returns false if they would not.
    pub(crate) fn begin(&self) -> bool {
        if !self.lock.hold_back() {
            return false;
        }
        let is_asked = self.requests.as_ref().is_some_and(|it| it.send(()).is_ok());
        if !is_asked {
            self.lock.let_go();
        }
        is_asked
    }

    /// Waits until every cleanup that has begun has ended, and not for ever.
    pub(crate) fn await_end(&self) {
        let begun = self.lock.begun();
        let waited = self.lock.ended.wait_timeout_while(begun, PATIENCE, |begun| *begun > 0);
        drop(waited);
    }

    #[cfg(test)]
    pub(crate) fn hold_back(&self) -> bool {
        self.lock.hold_back()
    }

    #[cfg(test)]
    pub(crate) fn let_go(&self) {
        self.lock.let_go();
    }
}

impl Drop for Cleaner {
    fn drop(&mut self) {
        self.requests = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// Removes the shared memory of dead processes.
pub(crate) fn clean(config: &Config) {
    let listed = Node::<Ipc>::list(config, |state| {
        if let NodeState::Dead(view) = state {
            let removed = view.blocking_remove_stale_resources(OTHERS_PATIENCE);
            tracing::trace!(?removed, "cleaned up after a dead process");
        }
        CallbackProgression::Continue
    });
    if let Err(error) = listed {
        tracing::debug!(?error, "dead processes are looked for with the next cleanup");
    }
}

/// Waits, as a service that starts, until no cleanup is in progress.
pub(crate) fn await_cleanup(paths: &GroupPaths) {
    // A group without a supervisor has no such file. A lock ends with its holder.
    let Ok(file) = File::open(paths.cleanup_lock()) else { return };
    while flock(&file, FlockOperation::LockShared) == Err(Errno::INTR) {}
}
