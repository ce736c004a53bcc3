//! The main loop's side of the recorder: encodes each pass and hands it to the writer's thread.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;

use crossbeam_channel::{Sender, TrySendError, bounded};
use serde::Serialize;

use super::writer::{Job, Ring, Writer};
use super::{Beginning, Entry, Head};
use crate::{Effects, Event, Span, Time};

/// Passes that may wait for the disk. The loop never waits: a flight with a gap could not be
/// replayed, so with more than that the recording ends.
const WAITING_MAX: usize = 1024;
/// How long passes in which nothing but time passed are kept, so that they are written together,
/// and up to which size, bytes.
const ROUTINE_KEPT: Span = Span::from_ms(500);
const ROUTINE_BYTES_MAX: usize = 4096;

/// Records one flight.
#[derive(Debug, Default)]
pub struct Tap {
    /// `None` while nothing is recorded.
    jobs: Option<Sender<Job>>,
    thread: Option<JoinHandle<()>>,
    head: Option<Head>,
    /// Number of the current file, counted from 0.
    files: u64,
    /// Number of files that the writer has found long enough for another one to begin.
    long_files: Arc<AtomicU64>,
    /// The passes that are kept, and the present one so far.
    passes: Vec<u8>,
    /// Time of the first event in them, and of the last one.
    span: Option<(Time, Time)>,
    /// Whether the present pass has an event.
    has_events: bool,
    /// Whether more happened in them than time passing.
    is_eventful: bool,
    #[cfg(test)]
    handed_over: usize,
}

impl Tap {
    /// Starts to record into a new file of `ring`. `records` are those that the node was recovered
    /// from. If that fails, the service continues without a recording.
    pub fn start<R: Serialize>(ring: Ring, head: &Head, records: &[R]) -> Self {
        let mut tap = Self::default();
        tap.head = Some(head.clone());
        let (jobs, waiting) = bounded(WAITING_MAX);
        let long_files = Arc::clone(&tap.long_files);
        let (service, started_wall_ns) = (head.service.clone(), head.started_wall_ns);
        let thread = std::thread::Builder::new().name("flight".into());
        // The deletion of an old flight may take half a second, for which no start waits.
        let started = thread.spawn(move || {
            match Writer::create(ring, service, started_wall_ns, long_files) {
                Ok(writer) => writer.run(&waiting),
                Err(error) => tracing::warn!(%error, "this start is not recorded"),
            }
        });
        match started {
            Ok(thread) => (tap.jobs, tap.thread) = (Some(jobs), Some(thread)),
            Err(error) => tracing::warn!(%error, "this start is not recorded"),
        }
        tap.add(head);
        tap.add(&Beginning::<_, ()>::Journal(records));
        tap.send();
        tap
    }

    /// Returns whether the file is long, and another one may begin with a checkpoint of the node.
    pub fn wants_checkpoint(&self) -> bool {
        self.jobs.is_some() && self.long_files.load(Ordering::Relaxed) > self.files
    }

    /// Continues in another file, between two passes of a node that has this checkpoint.
    pub fn go_on(&mut self, checkpoint: &[u8], now: Time, wall_ns: u64) {
        self.send();
        let Some(mut head) = self.head.clone() else { return };
        (head.started, head.started_wall_ns) = (now, wall_ns);
        self.files += 1;
        self.hand_over(Job::Begin(wall_ns));
        self.add(&head);
        self.add(&Beginning::<(), _>::Checkpoint(checkpoint));
        self.send();
    }

    /// Returns whether anything is recorded.
    pub fn is_on(&self) -> bool {
        self.jobs.is_some()
    }

    /// Records an event just before the node is given it.
    pub fn event<In: Serialize>(&mut self, event: &Event<In>, now: Time) {
        self.has_events = true;
        self.is_eventful |= !matches!(event, Event::Tick);
        self.span = Some((self.span.map_or(now, |(first, _)| first), now));
        self.add(&Entry::<_, ()>::Event(now, event));
    }

    /// Records that the node learned of durable records.
    pub fn durable(&mut self) {
        self.add(&Entry::<(), ()>::Durable);
    }

    /// Records the node's statements of a pass, before any of them is carried out.
    pub fn stated<Out: Serialize, Record: Serialize>(&mut self, effects: &Effects<Out, Record>) {
        if self.has_events {
            self.is_eventful |= !effects.records().is_empty();
            self.add(&Entry::<(), _>::Stated(effects));
        }
    }

    /// Ends a pass. It is written now, unless nothing but time passed in it.
    pub fn end_pass(&mut self) {
        self.has_events = false;
        let is_old = self.span.is_some_and(|(first, last)| last >= first + ROUTINE_KEPT);
        if self.is_eventful || is_old || self.passes.len() >= ROUTINE_BYTES_MAX {
            self.send();
        }
    }

    /// Returns how many parts wait for the writer.
    #[cfg(test)]
    pub(super) fn waiting(&self) -> usize {
        self.jobs.as_ref().map_or(0, Sender::len)
    }

    /// Returns how many parts the writer has been given.
    #[cfg(test)]
    pub(super) fn handed_over(&self) -> usize {
        self.handed_over
    }

    fn add(&mut self, value: &impl Serialize) {
        if self.jobs.is_none() {
            return;
        }
        match postcard::to_extend(value, std::mem::take(&mut self.passes)) {
            Ok(passes) => self.passes = passes,
            Err(error) => self.end(&format!("an entry cannot be encoded: {error}")),
        }
    }

    fn send(&mut self) {
        (self.span, self.is_eventful) = (None, false);
        if !self.passes.is_empty() {
            let passes = std::mem::take(&mut self.passes);
            self.hand_over(Job::Passes(passes));
        }
    }

    fn hand_over(&mut self, job: Job) {
        let Some(jobs) = &self.jobs else { return };
        #[cfg(test)]
        {
            self.handed_over += 1;
        }
        match jobs.try_send(job) {
            Ok(()) => {}
            Err(TrySendError::Full(_)) => self.end("the disk is too slow"),
            // The writer has said why.
            Err(TrySendError::Disconnected(_)) => self.jobs = None,
        }
    }

    fn end(&mut self, why: &str) {
        tracing::warn!(why, "the recording of this start ends; the service continues");
        self.jobs = None;
    }
}

/// Recorded entries are written even if the main loop panics: the event that it panicked at is in
/// the flight.
impl Drop for Tap {
    fn drop(&mut self) {
        self.send();
        self.jobs = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
