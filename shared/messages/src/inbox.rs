//! The receiver's half of "in order, exactly once": it accepts `applied + 1` and nothing else. The
//! sender resends messages above the receiver's mark, so rejected ones come back.

use crate::UtteranceSeq;

/// Accepts a numbered stream in order and without repeats.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inbox {
    applied: UtteranceSeq,
}

/// Treatment of a numbered message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The message is next: apply it, durably, then call [`Inbox::advance`].
    Apply,
    /// The message was applied before.
    Duplicate,
    /// Something before it is missing; it will come again.
    Early,
}

impl Inbox {
    /// An inbox that has applied everything up to and including `applied`.
    pub fn new(applied: UtteranceSeq) -> Self {
        Self { applied }
    }

    /// The highest number applied: the mark.
    pub fn applied(&self) -> UtteranceSeq {
        self.applied
    }

    /// Returns the treatment of message `seq`.
    pub fn judge(&self, seq: UtteranceSeq) -> Verdict {
        if seq <= self.applied {
            Verdict::Duplicate
        } else if seq == self.applied.next() {
            Verdict::Apply
        } else {
            Verdict::Early
        }
    }

    /// The next message is applied.
    pub fn advance(&mut self) {
        self.applied = self.applied.next();
    }
}
