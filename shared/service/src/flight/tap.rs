//! The main loop's side of the recorder: encodes each pass and hands it to the writer's thread.

use std::thread::JoinHandle;

use crossbeam_channel::{Sender, TrySendError, bounded};
use serde::Serialize;

use super::writer::{Ring, Writer};
use super::{Entry, Head};
use crate::{Effects, Event, Time};

/// Passes that may wait for the disk. The loop never waits: a flight with a gap could not be replayed, so
/// with more than that the recording ends.
const WAITING_MAX: usize = 1024;
/// Size up to which passes without an event are kept together, bytes.
const QUIET_BYTES_MAX: usize = 256;

/// Records one flight.
#[derive(Debug, Default)]
pub struct Tap {
    /// None while nothing is recorded.
    passes: Option<Sender<Vec<u8>>>,
    thread: Option<JoinHandle<()>>,
    /// The pass so far.
    pass: Vec<u8>,
    has_events: bool,
}

impl Tap {
    /// Starts to record into a new file of `ring`. `records` are those that the node was recovered from.
    /// Where that fails, the service does without a recording.
    pub fn start<R: Serialize>(ring: Ring, head: &Head, records: &[R]) -> Self {
        let mut tap = Self::default();
        let (passes, waiting) = bounded(WAITING_MAX);
        let started = Writer::create(ring, head).and_then(|writer| {
            let thread = std::thread::Builder::new().name("flight".into());
            thread.spawn(move || writer.run(&waiting))
        });
        match started {
            Ok(thread) => (tap.passes, tap.thread) = (Some(passes), Some(thread)),
            Err(error) => tracing::warn!(%error, "this start is not recorded"),
        }
        tap.add(head);
        tap.add(&records);
        tap.send();
        tap
    }

    /// Returns whether anything is recorded.
    pub fn is_on(&self) -> bool {
        self.passes.is_some()
    }

    /// Records an event just before the node is given it.
    pub fn event<In: Serialize>(&mut self, event: &Event<In>, now: Time) {
        self.has_events = true;
        self.add(&Entry::<_, ()>::Event(now, event));
    }

    /// Records that the node was told of durable records.
    pub fn durable(&mut self) {
        self.add(&Entry::<(), ()>::Durable);
    }

    /// Records what the node has stated in a pass, before any of it is carried out.
    pub fn stated<Out: Serialize, Record: Serialize>(&mut self, effects: &Effects<Out, Record>) {
        if self.has_events {
            self.add(&Entry::<(), _>::Stated(effects));
        }
    }

    /// Ends a pass: what it holds is written now.
    pub fn end_pass(&mut self) {
        if self.has_events || self.pass.len() >= QUIET_BYTES_MAX {
            self.send();
        }
    }

    fn add(&mut self, value: &impl Serialize) {
        if self.passes.is_none() {
            return;
        }
        match postcard::to_extend(value, std::mem::take(&mut self.pass)) {
            Ok(pass) => self.pass = pass,
            Err(error) => self.end(&format!("an entry cannot be encoded: {error}")),
        }
    }

    fn send(&mut self) {
        self.has_events = false;
        let Some(passes) = &self.passes else { return };
        match passes.try_send(std::mem::take(&mut self.pass)) {
            Ok(()) => {}
            Err(TrySendError::Full(_)) => self.end("the disk is too slow"),
            // The writer has said why.
            Err(TrySendError::Disconnected(_)) => self.passes = None,
        }
    }

    fn end(&mut self, why: &str) {
        tracing::warn!(why, "the recording of this start ends; the service continues");
        self.passes = None;
    }
}

/// What is recorded is written, also where the main loop panics: the event that it panicked at is in the
/// flight.
impl Drop for Tap {
    fn drop(&mut self) {
        if !self.pass.is_empty() {
            self.send();
        }
        self.passes = None;
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}
