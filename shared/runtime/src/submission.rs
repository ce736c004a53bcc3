//! A request to the speech service, resent under one key until its receipts have arrived, so that
//! a restart in between neither loses nor doubles it.

use messages::{
    ClientId, FixedText, Injection, PromptId, Receipt, ReceiptStatus, RequestKey, Sound,
};

use crate::client::{own_id, request_key};
use crate::{Span, Time};

/// Time between two transmissions of an unanswered request.
const RESEND_EVERY: Span = Span::from_ms(250);

/// A request under way to the group. Pure: the caller sends the result of [`Submission::due`] and
/// feeds every receipt of the topic to [`Submission::on_receipt`].
#[derive(Clone, Debug, PartialEq)]
pub struct Submission {
    injection: Injection,
    patience: Span,
    expires: Time,
    sent: Option<Time>,
    receipts: Vec<Receipt>,
}

impl Submission {
    /// A request of this process that was said from `began` to `ended` (0: its arrival) and expires
    /// after `patience`.
    pub fn new(sound: Sound, (began, ended): (Time, Time), now: Time, patience: Span) -> Self {
        let (onset_ns, end_ns) = (began.ns(), ended.ns());
        let key = request_key(own_id());
        let from = String::new();
        let injection = Injection { key, onset_ns, end_ns, seen_prompt: 0, from, sound };
        Self { injection, patience, expires: now + patience, sent: None, receipts: Vec::new() }
    }

    /// Makes it a request of `client`, for a process that speaks for several.
    #[must_use]
    pub fn of(mut self, client: ClientId) -> Self {
        self.injection.key = request_key(client);
        self
    }

    /// Notes the latest prompt that the user was shown before; 0 if unknown.
    #[must_use]
    pub fn after(mut self, seen: PromptId) -> Self {
        self.injection.seen_prompt = seen.0;
        self
    }

    /// States who speaks, by a name that the speech service judges; empty for an unnamed person.
    #[must_use]
    pub fn by(mut self, from: impl Into<String>) -> Self {
        self.injection.from = from.into();
        self
    }

    /// Replaces the random key by one that a further delivery of the same message would have, too.
    #[must_use]
    pub fn under(mut self, key: RequestKey) -> Self {
        self.injection.key = key;
        self
    }

    /// Time after which the request expires.
    pub fn patience(&self) -> Span {
        self.patience
    }

    /// Key of the request, which its receipts repeat.
    pub fn key(&self) -> RequestKey {
        self.injection.key
    }

    /// Returns the request if it is due for its first or a further transmission, and marks it as
    /// sent.
    pub fn due(&mut self, now: Time) -> Option<&Injection> {
        if self.sent.is_some_and(|sent| now < sent + RESEND_EVERY) {
            return None;
        }
        self.sent = Some(now);
        Some(&self.injection)
    }

    /// Takes a receipt; those of other requests and repeated ones are ignored.
    pub fn on_receipt(&mut self, receipt: &Receipt) {
        let new = self.receipts.iter().all(|known| known.segment != receipt.segment);
        if receipt.request() == self.key() && new {
            self.receipts.push(*receipt);
            self.receipts.sort_by_key(|receipt| receipt.segment);
        }
    }

    /// Returns the receipts once all of them have arrived: one for text, one for each utterance of
    /// a sound file, in order.
    pub fn receipts(&self) -> Option<&[Receipt]> {
        let first = self.receipts.first()?;
        (self.receipts.len() >= first.segments as usize).then_some(&self.receipts)
    }

    /// Returns true if the receipt accepts other words than this request's: its key was used for
    /// them. Words are compared as far as a receipt holds them; sounds and gestures are not.
    pub fn conflicts_with(&self, receipt: &Receipt) -> bool {
        let Sound::Text(text) = &self.injection.sound else { return false };
        receipt.request() == self.key()
            && receipt.status == ReceiptStatus::Accepted
            && receipt.note != FixedText::truncated(text)
    }

    /// Returns true if the patience has run out without all receipts.
    pub fn is_expired(&self, now: Time) -> bool {
        now >= self.expires && self.receipts().is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    fn submission() -> Submission {
        Submission::new(Sound::Text("hello".into()), (at(0), at(0)), at(0), Span::from_ms(1_000))
    }

    #[test]
    fn a_submission_is_resent_under_one_key_until_it_expires() {
        let mut submission = submission();
        let key = submission.key();
        let sent: Vec<u64> = (0..1_000)
            .step_by(50)
            .filter(|&ms| submission.due(at(ms)).is_some_and(|request| request.key == key))
            .collect();
        assert_eq!(sent, [0, 250, 500, 750]);
        assert!(!submission.is_expired(at(999)));
        assert!(submission.is_expired(at(1_000)));
    }

    #[test]
    fn a_submission_conflicts_with_other_words_under_its_key() {
        let long = "a cup ".repeat(200);
        let said = |text: &str| {
            let sound = Sound::Text(text.to_owned());
            let new = Submission::new(sound, (at(0), at(0)), at(0), Span::from_ms(1_000));
            new.under(RequestKey([7; 16]))
        };
        let receipt = |key: u8, status: ReceiptStatus, text: &str| Receipt {
            key: [key; 16],
            status: status.code(),
            note: FixedText::truncated(text),
            ..Receipt::default()
        };
        let accepted = |text: &str| receipt(7, ReceiptStatus::Accepted, text);
        assert!(!said("hello").conflicts_with(&accepted("hello")));
        assert!(said("hello").conflicts_with(&accepted("help")));
        assert!(!said(&long).conflicts_with(&accepted(&long)), "a receipt holds its beginning");
        assert!(!said("hello").conflicts_with(&receipt(8, ReceiptStatus::Accepted, "help")));
        let refused = receipt(7, ReceiptStatus::Refused, "empty utterance");
        assert!(!said("hello").conflicts_with(&refused));
    }

    #[test]
    fn a_submission_is_complete_with_one_receipt_for_each_segment() {
        let mut submission = submission();
        let key = submission.key();
        let other = RequestKey([7; 16]);
        let arrivals =
            [(0, other, None), (1, key, None), (1, key, None), (0, key, Some(vec![0, 1]))];
        for (segment, key, expected) in arrivals {
            let receipt = Receipt { segment, segments: 2, key: key.0, ..Receipt::default() };
            submission.on_receipt(&receipt);
            let found = submission.receipts().map(|all| all.iter().map(|r| r.segment).collect());
            assert_eq!(found, expected);
        }
        assert!(!submission.is_expired(at(9_000)));
    }
}
