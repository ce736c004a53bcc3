use std::collections::VecDeque;

use messages::{Receipt, ReceiptStatus};

use super::{Latest, PromptId, SaidView, Speaker};
use crate::Time;
use crate::bounded::push_bounded;

/// Lines of the dialogue that are kept.
const LINES_MAX: usize = 6;

/// The latest lines of the dialogue, since a client joined.
#[derive(Debug)]
pub struct Lines {
    /// Oldest first.
    said: VecDeque<(Speaker, String)>,
    last_line: Option<PromptId>,
    /// The highest utterance that was applied before the client joined.
    before: Option<u64>,
    /// When the client joined.
    began: Time,
}

impl Lines {
    /// No lines yet, for a client that joins at `began`.
    pub fn new(began: Time) -> Self {
        Self { said: VecDeque::new(), last_line: None, before: None, began }
    }

    /// Processes new messages, which `latest` includes. Returns the new lines.
    pub fn take_in(&mut self, latest: &Latest, receipts: &[Receipt]) -> Vec<(Speaker, String)> {
        if self.before.is_none() {
            self.before = latest.view.as_ref().map(|view| view.applied);
        }
        let mut new: Vec<_> = receipts.iter().filter_map(|receipt| self.heard(receipt)).collect();
        if let Some((said, text)) = latest.presented_line()
            && self.last_line != Some(said)
        {
            self.last_line = Some(said);
            new.push((Speaker::Robot, text.to_owned()));
        }
        for line in &new {
            push_bounded(&mut self.said, LINES_MAX, line.clone());
        }
        new
    }

    fn heard(&self, receipt: &Receipt) -> Option<(Speaker, String)> {
        let text = receipt.note.as_str().ok()?;
        let is = |status: ReceiptStatus| receipt.status == status;
        if is(ReceiptStatus::Accepted) && receipt.seq > self.before.unwrap_or(0) {
            Some((Speaker::Person, text.to_owned()))
        } else if is(ReceiptStatus::NotForMe) && Time(receipt.end_ns) > self.began {
            let text = if text.is_empty() { "(nothing that could be made out)" } else { text };
            Some((Speaker::Unmeant, format!("heard, not for me: {text}")))
        } else {
            None
        }
    }

    /// The lines as [`super::View`] has them.
    pub fn said(&self) -> Vec<SaidView<'_>> {
        self.said.iter().map(|(who, text)| SaidView { who: *who, text }).collect()
    }
}
