//! Durability before visibility, without waiting for the disk.
//!
//! A thread owns the journal. The main loop hands it the records of each pass and keeps the pass's
//! outputs until they are durable; the thread makes all of them durable with one sync. Order is
//! kept: an output that follows records in the same or an earlier pass is published after them.
//!
//! A full disk is a state and not an end. The thread keeps the records, retries, and reports the
//! shortage; pending outputs are neither lost nor published.

use std::collections::VecDeque;
use std::io;
use std::os::fd::BorrowedFd;
use std::path::{Path, PathBuf};
use std::time::Duration;

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, unbounded};
use journal::{AppendError, Journal, RotateError, SyncError};
use serde::{Serialize, de::DeserializeOwned};

use crate::Effects;
use crate::exit::{Exit, Failure};
use crate::journal_clock::JournalClock;
use crate::storage;
use crate::worker_channel::{self, DeviceReceiver, DeviceSender};
use runtime::sync_time;

/// Interval at which a failed write is tried again.
const RETRY_EVERY: Duration = Duration::from_millis(250);
/// Most outputs, and most passes with records, that wait for the disk; with more the service takes
/// in nothing new. Senders repeat important messages.
const WAITING_MAX: usize = 256;
/// Size at which a journal is compacted, if the node offers a snapshot, bytes.
const ROTATE_BYTES: u64 = 1 << 20;
/// Growth after which a failed rotation is tried again, bytes.
const ROTATE_AGAIN_BYTES: u64 = 256 << 10;

/// Journal operations that the thread needs; tests inject disk faults here.
pub(crate) trait Store<R>: Send + 'static {
    fn append_all(&mut self, records: &[R]) -> Result<(), AppendError>;
    fn sync(&mut self, vital: bool) -> Result<(), SyncError>;
    fn rotate(&mut self, snapshot: &[R]) -> Result<(), RotateError>;
    /// As `rotate`, and removes the earlier content.
    fn erase(&mut self, snapshot: &[R]) -> Result<(), RotateError>;
    fn bytes(&self) -> u64;
    /// Number of the next record.
    fn next_seq(&self) -> u64;
}

impl<R: Serialize + DeserializeOwned + 'static> Store<R> for Journal<R> {
    fn append_all(&mut self, records: &[R]) -> Result<(), AppendError> {
        Self::append_all(self, records)
    }

    fn sync(&mut self, vital: bool) -> Result<(), SyncError> {
        if vital { self.sync_with_reserve() } else { Self::sync(self) }
    }

    fn rotate(&mut self, snapshot: &[R]) -> Result<(), RotateError> {
        Self::rotate(self, snapshot)
    }

    fn erase(&mut self, snapshot: &[R]) -> Result<(), RotateError> {
        Self::erase(self, snapshot)
    }

    fn bytes(&self) -> u64 {
        Self::bytes(self)
    }

    fn next_seq(&self) -> u64 {
        Self::next_seq(self)
    }
}

/// Work for the thread, in order.
enum Job<R> {
    /// The records of one pass.
    Append { records: Vec<R>, vital: bool },
    /// A snapshot that replaces everything before, which is kept next to it or erased.
    Rotate { snapshot: Vec<R>, erases: bool },
}

/// News of the thread.
enum Report {
    /// So many passes are durable, and the journal has this length.
    Durable { passes: u64, bytes: u64 },
    /// Everything before a snapshot is gone.
    Erased,
    /// The disk is full.
    Short(String),
    /// The journal cannot be used any more.
    Failed(Failure),
}

/// The loop's side.
pub(crate) struct Commit<Out, Record> {
    /// Channel to the thread; `None` for a stateless service.
    jobs: Option<Sender<Job<Record>>>,
    reports: DeviceReceiver<Report>,
    /// Passes with records, and those of them that are durable.
    stated: u64,
    durable: u64,
    /// Outputs, with the passes that must be durable first.
    held: VecDeque<(u64, Out)>,
    is_short: bool,
    bytes: u64,
    rotate_at: u64,
    /// Everything before the next snapshot is to be erased.
    erases: bool,
}

impl<Out, Record: Send + 'static> Commit<Out, Record> {
    /// Starts the thread of `store`, which lies at `file`; a service without a journal needs none.
    ///
    /// # Errors
    /// No descriptor or no thread is left.
    pub(crate) fn start<S: Store<Record>>(store: Option<S>, file: &Path) -> io::Result<Self> {
        let (reporter, reports) = worker_channel::channel()?;
        let bytes = store.as_ref().map_or(0, Store::bytes);
        let jobs = match store {
            None => None,
            Some(store) => {
                let (sender, jobs) = unbounded();
                let writer = Writer::new(store, jobs, reporter, file);
                std::thread::Builder::new().name("journal".into()).spawn(|| writer.run())?;
                Some(sender)
            }
        };
        Ok(Self {
            jobs,
            reports,
            stated: 0,
            durable: 0,
            held: VecDeque::new(),
            is_short: false,
            bytes,
            rotate_at: ROTATE_BYTES,
            erases: false,
        })
    }

    /// Readable while there is news of the thread.
    pub(crate) fn fd(&self) -> BorrowedFd<'_> {
        self.reports.fd()
    }

    /// Takes over the records of a pass. Returns its outputs if they wait for nothing.
    ///
    /// # Errors
    /// The thread is gone.
    pub(crate) fn state(
        &mut self,
        effects: &mut Effects<Out, Record>,
    ) -> Result<Vec<Out>, Failure> {
        let (records, vital) = (effects.take_records(), effects.take_vital());
        if !records.is_empty()
            && let Some(jobs) = &self.jobs
        {
            jobs.send(Job::Append { records, vital }).map_err(|_| gone())?;
            self.stated += 1;
        }
        let outputs = effects.take_outputs();
        if self.is_settled() {
            return Ok(outputs);
        }
        self.held.extend(outputs.into_iter().map(|output| (self.stated, output)));
        Ok(Vec::new())
    }

    /// Takes in the news of the thread. Returns the outputs that have waited for it, in order.
    ///
    /// # Errors
    /// The journal cannot be used any more.
    pub(crate) fn settle(&mut self) -> Result<Vec<Out>, Failure> {
        self.reports.clear();
        while let Some(report) = self.reports.take() {
            match report {
                Report::Durable { passes, bytes } => {
                    (self.durable, self.bytes) = (passes, bytes);
                    if std::mem::take(&mut self.is_short) {
                        tracing::info!(
                            "the disk has space again; everything that waited is written"
                        );
                    }
                    if bytes < ROTATE_BYTES && !self.erases {
                        self.rotate_at = ROTATE_BYTES;
                    }
                }
                Report::Erased => self.erases = false,
                Report::Short(what) => {
                    if !std::mem::replace(&mut self.is_short, true) {
                        tracing::error!("{what}; waiting for space");
                    }
                }
                Report::Failed(failure) => return Err(failure),
            }
        }
        let count = self.held.iter().take_while(|(passes, _)| *passes <= self.durable).count();
        Ok(self.held.drain(..count).map(|(_, output)| output).collect())
    }

    /// Returns whether every record is durable.
    pub(crate) fn is_settled(&self) -> bool {
        self.durable == self.stated
    }

    /// Returns whether the backlog forbids further inputs.
    pub(crate) fn is_behind(&self) -> bool {
        self.held.len() >= WAITING_MAX || self.stated - self.durable >= WAITING_MAX as u64
    }

    /// Returns whether the disk is full; pending records are retried.
    pub(crate) fn is_short(&self) -> bool {
        self.is_short
    }

    /// Has everything before the next snapshot erased, which is wanted at once.
    pub(crate) fn erase(&mut self) {
        (self.erases, self.rotate_at) = (true, 0);
    }

    /// Returns whether the journal is long, and everything durable.
    pub(crate) fn wants_snapshot(&self) -> bool {
        self.jobs.is_some() && self.is_settled() && self.bytes >= self.rotate_at
    }

    /// Has the journal replaced by a snapshot.
    ///
    /// # Errors
    /// The thread is gone.
    pub(crate) fn rotate(&mut self, snapshot: Vec<Record>) -> Result<(), Failure> {
        self.rotate_at = self.bytes + ROTATE_AGAIN_BYTES;
        let Some(jobs) = &self.jobs else { return Ok(()) };
        let erases = self.erases;
        jobs.send(Job::Rotate { snapshot, erases }).map_err(|_| gone())
    }
}

fn gone() -> Failure {
    Failure::new(Exit::Invariant, "the journal's thread has ended")
}

fn storage_failure(error: &dyn std::error::Error) -> Failure {
    Failure::new(Exit::Storage, error.to_string())
}

/// The thread's side.
struct Writer<R, S> {
    store: S,
    jobs: Receiver<Job<R>>,
    reports: DeviceSender<Report>,
    folder: PathBuf,
    clock: JournalClock,
    /// Jobs that the store has not been given yet.
    backlog: VecDeque<Job<R>>,
    /// Passes that the store has been given, and those of them that are durable.
    appended: u64,
    durable: u64,
    /// True if one of the passes in between is vital.
    vital: bool,
}

impl<R, S: Store<R>> Writer<R, S> {
    fn new(store: S, jobs: Receiver<Job<R>>, reports: DeviceSender<Report>, file: &Path) -> Self {
        Self {
            store,
            jobs,
            reports,
            folder: file.parent().unwrap_or(file).to_owned(),
            clock: JournalClock::of(file),
            backlog: VecDeque::new(),
            appended: 0,
            durable: 0,
            vital: false,
        }
    }

    /// Works until the service ends or the journal fails.
    fn run(mut self) {
        loop {
            let is_idle = self.appended == self.durable && self.backlog.is_empty();
            let job = match is_idle {
                true => self.jobs.recv().map_err(|_| RecvTimeoutError::Disconnected),
                // The last attempt failed.
                false => self.jobs.recv_timeout(RETRY_EVERY),
            };
            match job {
                Ok(job) => self.backlog.push_back(job),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            if let Err(failure) = self.work() {
                self.reports.send(Report::Failed(failure));
                return;
            }
        }
    }

    /// Does everything that waits, as far as the disk lets it.
    fn work(&mut self) -> Result<(), Failure> {
        loop {
            self.backlog.extend(self.jobs.try_iter());
            self.append()?;
            if !self.sync()? {
                return Ok(());
            }
            match self.backlog.pop_front() {
                None => return Ok(()),
                Some(Job::Rotate { snapshot, erases }) => self.rotate(&snapshot, erases)?,
                Some(job) => self.backlog.push_front(job),
            }
        }
    }

    /// Gives the store the passes that wait, up to a snapshot or the limit of one sync.
    fn append(&mut self) -> Result<(), Failure> {
        while let Some(Job::Append { records, vital }) = self.backlog.front() {
            match self.store.append_all(records) {
                Ok(()) => {}
                Err(AppendError::TooLarge { .. }) if self.appended > self.durable => return Ok(()),
                Err(error) => return Err(storage_failure(&error)),
            }
            self.vital |= vital;
            self.appended += 1;
            self.backlog.pop_front();
        }
        Ok(())
    }

    /// Returns whether everything that was appended is durable.
    fn sync(&mut self) -> Result<bool, Failure> {
        if self.appended == self.durable {
            return Ok(true);
        }
        let first = self.store.next_seq();
        let Self { store, vital, .. } = self;
        match sync_time::measure(|| store.sync(*vital)) {
            Ok(()) => {
                (self.durable, self.vital) = (self.appended, false);
                self.report_durable();
                // Outputs that wait for the records do not wait for this aid for readers.
                self.clock.note(first);
                Ok(true)
            }
            Err(error @ (SyncError::Full(_) | SyncError::Write(_))) => {
                let free = storage::free_text(&self.folder);
                self.reports.send(Report::Short(format!("{error} ({free})")));
                Ok(false)
            }
            Err(error) => Err(storage_failure(&error)),
        }
    }

    fn rotate(&mut self, snapshot: &[R], erases: bool) -> Result<(), Failure> {
        let first = self.store.next_seq();
        let rotated = match erases {
            true => self.store.erase(snapshot),
            false => self.store.rotate(snapshot),
        };
        match rotated {
            Ok(()) => {
                if erases {
                    self.reports.send(Report::Erased);
                }
                self.report_durable();
                self.clock.note(first);
                tracing::info!(records = snapshot.len(), "journal rotated with a snapshot");
                Ok(())
            }
            Err(RotateError::Sync(error @ (SyncError::Unknown(_) | SyncError::Poisoned))) => {
                Err(storage_failure(&error))
            }
            Err(error) => {
                tracing::warn!(%error, "journal not compacted; it is tried again when it has grown");
                Ok(())
            }
        }
    }

    fn report_durable(&self) {
        self.reports.send(Report::Durable { passes: self.durable, bytes: self.store.bytes() });
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a failed unwrap fails the test")]
mod tests;
