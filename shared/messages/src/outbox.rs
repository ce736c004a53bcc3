//! The sender's half of "in order, exactly once": it keeps everything above the receiver's mark and
//! sends it again, a window at a time.

use crate::UtteranceSeq;
use std::collections::VecDeque;

/// Accepted messages that the receiver has not yet applied.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub struct Outbox<T> {
    last: UtteranceSeq,
    waiting: VecDeque<(UtteranceSeq, T)>,
    window: usize,
    capacity: usize,
}

/// Too many messages wait; the newest was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{} not understood yet; say it again in a moment", scene::count(*waiting, "utterance"))]
pub struct Full {
    /// Number of waiting messages.
    pub waiting: usize,
}

impl<T> Outbox<T> {
    /// An outbox whose last number given was `last`, that keeps `capacity` messages and sends
    /// `window` of them at a time.
    pub fn new(last: UtteranceSeq, window: usize, capacity: usize) -> Self {
        Self { last, waiting: VecDeque::new(), window, capacity }
    }

    /// The number that the next message will get, if there is room for it.
    ///
    /// # Errors
    /// The outbox is full.
    pub fn next(&self) -> Result<UtteranceSeq, Full> {
        if self.waiting.len() >= self.capacity {
            return Err(Full { waiting: self.waiting.len() });
        }
        Ok(self.last.next())
    }

    /// Takes the message with the number from [`Outbox::next`] (or, at recovery, from the journal).
    pub fn push(&mut self, seq: UtteranceSeq, message: T) {
        debug_assert!(seq > self.last, "numbers only rise");
        self.last = seq;
        self.waiting.push_back((seq, message));
    }

    /// The receiver has applied everything up to `mark`. Returns `false` and changes nothing if
    /// `mark` was never sent: accepting it would drop pending messages.
    pub fn acknowledge(&mut self, mark: UtteranceSeq) -> bool {
        if mark > self.last {
            return false;
        }
        while self.waiting.front().is_some_and(|(seq, _)| *seq <= mark) {
            self.waiting.pop_front();
        }
        true
    }

    /// Ends every number up to `over`: pending messages with these numbers are dropped, and
    /// numbering continues above.
    pub fn skip(&mut self, over: UtteranceSeq) {
        self.waiting.retain(|(seq, _)| *seq > over);
        self.last = self.last.max(over);
    }

    /// Returns the messages to send now, in order.
    pub fn window(&self) -> impl Iterator<Item = &(UtteranceSeq, T)> {
        self.waiting.iter().take(self.window)
    }

    /// Returns all waiting messages, in order.
    pub fn waiting(&self) -> impl Iterator<Item = &T> {
        self.waiting.iter().map(|(_, message)| message)
    }

    /// Returns the number of waiting messages.
    pub fn len(&self) -> usize {
        self.waiting.len()
    }

    /// Returns whether no message is waiting.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// The last number given.
    pub fn last(&self) -> UtteranceSeq {
        self.last
    }
}
