//! The history on the console's page: past interactions, assembled from the group's journals and kept
//! in a bounded store.
//!
//! The journals are the only source, so the history is the same whether the console was running or
//! not. They are read when someone looks at the history and when an interaction has ended, by a
//! thread or by the server's threads for blocking work: the main loop never waits for it.

#![allow(missing_docs, reason = "the fields of interactions are those of docs/console.md")]

mod assemble;
mod interaction;
mod journals;
mod routes;
pub mod shared;
mod store;

use std::io;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use crossbeam_channel::{RecvTimeoutError, Sender, TrySendError, bounded};
use serde::Serialize;
use service::group::GroupPaths;

use assemble::Assembler;
pub use interaction::{Interaction, Summary};
use journals::Journals;
pub use routes::routes;
use store::Store;

/// Interactions left to the journals: a refusal or the way back to rest may be added to them.
const SETTLED_AFTER: usize = 2;
/// Interactions of one answer.
pub const PAGE_MAX: usize = 200;
/// Time after the start until the journals are read first: the group starts meanwhile.
const FIRST_READ: Duration = Duration::from_secs(5);
/// Time after the end of an interaction until it is read: the arm returns to rest meanwhile.
const READ_AFTER: Duration = Duration::from_secs(1);

/// The history of the group.
#[derive(Debug)]
pub struct History {
    inner: Mutex<Inner>,
    ended: Sender<()>,
}

#[derive(Debug)]
struct Inner {
    journals: Journals,
    assembler: Assembler,
    /// `None` until first needed, or if it cannot be read.
    store: Option<Store>,
    paths: GroupPaths,
}

/// A part of the list, newest first.
#[derive(Debug, PartialEq, Serialize)]
pub struct Page {
    pub interactions: Vec<Summary>,
    /// Number of all interactions.
    pub total: usize,
    /// The oldest of all.
    pub oldest: Option<Summary>,
}

impl History {
    /// The history of a group; it ends its thread when it is dropped.
    ///
    /// # Errors
    /// No thread is left.
    pub fn start(paths: &GroupPaths) -> io::Result<Arc<Self>> {
        let (ended, endings) = bounded(1);
        let inner = Inner {
            journals: Journals::new(paths.clone()),
            assembler: Assembler::default(),
            store: None,
            paths: paths.clone(),
        };
        let history = Arc::new(Self { inner: Mutex::new(inner), ended });
        let reading = Arc::downgrade(&history);
        std::thread::Builder::new().name("history".into()).spawn(move || {
            let mut patience = FIRST_READ;
            loop {
                match endings.recv_timeout(patience) {
                    Ok(()) => std::thread::sleep(READ_AFTER),
                    Err(RecvTimeoutError::Timeout) => {}
                    Err(RecvTimeoutError::Disconnected) => return,
                }
                let Some(history) = reading.upgrade() else { return };
                history.lock().refresh();
                patience = Duration::MAX;
            }
        })?;
        Ok(history)
    }

    /// An interaction has ended: the journals are read soon.
    pub fn on_end(&self) {
        match self.ended.try_send(()) {
            // It is due already.
            Ok(()) | Err(TrySendError::Full(())) => {}
            Err(TrySendError::Disconnected(())) => {
                tracing::debug!("the history's thread has ended")
            }
        }
    }

    /// Returns at most `most` interactions before that number, newest first. Reads the journals
    /// first, which takes some milliseconds.
    pub fn page(&self, before: u64, most: usize) -> Page {
        let mut inner = self.lock();
        inner.refresh();
        inner.page(before, most.min(PAGE_MAX))
    }

    /// Returns an interaction; `None` for an unknown number. Reads the journals first.
    pub fn interaction(&self, number: u64) -> Option<Interaction> {
        let mut inner = self.lock();
        inner.refresh();
        if let Some(recent) = inner.assembler.get(number) {
            return Some(recent.clone());
        }
        let stored = inner.store.as_ref()?.read(number);
        stored.inspect_err(|error| tracing::warn!(%error, number, "interaction not read")).ok()?
    }

    fn lock(&self) -> MutexGuard<'_, Inner> {
        // After a panic of a reader the store is whole: it is changed by single steps.
        self.inner.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Inner {
    fn refresh(&mut self) {
        if self.store.is_none() {
            let opened = Store::open(store::folder(&self.paths.journal()));
            let opened = opened.inspect_err(
                |error| tracing::warn!(%error, "the store of the history is not read"),
            );
            self.store = opened.ok();
        }
        self.journals.read().into_iter().for_each(|lines| self.assembler.take_in(lines));
        self.settle();
    }

    /// Stores the interactions that nothing can be added to any more.
    fn settle(&mut self) {
        let Some(store) = &mut self.store else { return };
        let newest = store.newest();
        self.assembler.forget(newest);
        let settled: Vec<_> = self.assembler.recent().rev().skip(SETTLED_AFTER).collect();
        let mut up_to = newest;
        for interaction in settled.into_iter().rev() {
            if let Err(error) = store.append(interaction) {
                tracing::debug!(%error, "interaction not stored");
                break;
            }
            up_to = interaction.interaction;
        }
        self.assembler.forget(up_to);
    }

    fn page(&self, before: u64, most: usize) -> Page {
        let recent = self.assembler.recent().map(Interaction::summary);
        let recent: Vec<Summary> = recent.collect();
        let stored = self.store.iter().flat_map(Store::newest_first);
        let oldest = self.store.as_ref().and_then(Store::oldest).or(recent.first()).cloned();
        let total = recent.len() + self.store.as_ref().map_or(0, Store::len);
        let all = recent.iter().rev().chain(stored);
        let asked = all.filter(|summary| summary.interaction < before).take(most);
        Page { interactions: asked.cloned().collect(), total, oldest }
    }
}

#[cfg(test)]
mod tests;
