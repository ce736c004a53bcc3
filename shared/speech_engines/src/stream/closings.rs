//! Pauses that close utterances in progress, depending on the words so far.

use std::collections::VecDeque;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::vad::Closing;

/// Utterances for which a pause is remembered: more than can be in progress.
const REMEMBERED_MAX: usize = 16;

/// The latest pause for each utterance. Shared between the service, which judges the words, and its
/// streams; one that is lost leaves the usual pause.
#[derive(Debug, Default)]
pub struct Closings(Mutex<VecDeque<(u64, Closing)>>);

impl Closings {
    /// Sets the pause that closes utterance `sound`.
    pub fn set(&self, sound: u64, closing: Closing) {
        let mut closings = self.closings();
        closings.retain(|(other, _)| *other != sound);
        if closings.len() >= REMEMBERED_MAX {
            closings.pop_front();
        }
        closings.push_back((sound, closing));
    }

    /// Removes the pause of utterance `sound`.
    pub(super) fn take(&self, sound: u64) -> Option<Closing> {
        let mut closings = self.closings();
        let at = closings.iter().position(|(other, _)| *other == sound)?;
        closings.remove(at).map(|(_, closing)| closing)
    }

    fn closings(&self) -> MutexGuard<'_, VecDeque<(u64, Closing)>> {
        // Every statement leaves the list consistent.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
