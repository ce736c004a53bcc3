//! Words of ROS on their way to the speech service: bounded, in order, each once.

use messages::{PromptId, Receipt, ReceiptStatus, RequestKey, Sound};
use scene::StableHash;
use service::submission::Submission;
use service::{Span, Time};
use std::collections::VecDeque;

/// Most utterances that wait for their receipts.
const WAITING_MAX: usize = 8;
/// Longest utterance, bytes.
const TEXT_BYTES_MAX: usize = 1_000;
/// Deadline of a receipt.
const PATIENCE: Span = Span::from_ms(8_000);

/// Key of a message, the same for every delivery of it: made of its writer's identity, its number there,
/// and its text.
pub fn key(writer: &[u8], sequence: i64, text: &str) -> RequestKey {
    let mut key = [0; 16];
    for (half, salt) in key.chunks_exact_mut(8).zip(0_u8..) {
        let mut hash = StableHash::default();
        hash.bytes(&[salt]);
        hash.bytes(writer);
        hash.bytes(&sequence.to_le_bytes());
        hash.text(text);
        half.copy_from_slice(&hash.value().to_le_bytes());
    }
    RequestKey(key)
}

/// Result of an utterance: its number, or why it is not followed.
pub type Answer = Result<u64, String>;

/// Utterances without a receipt, oldest first, each with what waits for its answer.
#[derive(Debug)]
pub struct Waiting<C>(VecDeque<(C, Submission)>);

impl<C> Default for Waiting<C> {
    fn default() -> Self {
        Self(VecDeque::new())
    }
}

impl<C> Waiting<C> {
    /// Adds an utterance of a user who has seen the prompt `seen`. One that waits already is not added
    /// again.
    ///
    /// # Errors
    /// Why it is refused, with what was to wait for it.
    pub fn add(
        &mut self,
        caller: C,
        (key, text): (RequestKey, &str),
        seen: PromptId,
        now: Time,
    ) -> Result<(), (C, &'static str)> {
        let text = text.trim();
        if text.is_empty() {
            return Err((caller, "empty"));
        }
        if text.len() > TEXT_BYTES_MAX {
            return Err((caller, "longer than 1000 bytes"));
        }
        if self.0.iter().any(|(_, waiting)| waiting.key() == key) {
            return Err((caller, "a further delivery of a message that waits already"));
        }
        if self.0.len() >= WAITING_MAX {
            return Err((caller, "too many utterances at a time"));
        }
        let sound = Sound::Text(text.to_owned());
        let submission = Submission::new(sound, (now, Time(0)), now, PATIENCE);
        self.0.push_back((caller, submission.after(seen).under(key)));
        Ok(())
    }

    /// Returns the request that is due. The next one is sent when the one before has its receipt, so
    /// that they are heard in order.
    pub fn due(&mut self, now: Time) -> Option<&messages::Injection> {
        self.0.front_mut()?.1.due(now)
    }

    /// Takes in a receipt; returns the caller that waits for it and the answer.
    pub fn on_receipt(&mut self, receipt: &Receipt) -> Option<(C, Answer)> {
        let key = receipt.request();
        let at = self.0.iter().position(|(_, waiting)| waiting.key() == key)?;
        let (caller, _) = self.0.remove(at)?;
        let answer = match receipt.status.get() {
            ReceiptStatus::Accepted => Ok(receipt.seq),
            _ => Err(receipt.note.as_str().unwrap_or_default().to_owned()),
        };
        Some((caller, answer))
    }

    /// Gives up an utterance whose receipt is overdue.
    pub fn expired(&mut self, now: Time) -> Option<(C, Answer)> {
        let at = self.0.iter().position(|(_, waiting)| waiting.is_expired(now))?;
        let (caller, _) = self.0.remove(at)?;
        Some((
            caller,
            Err("the speech service does not answer; help: see `whichone status`".into()),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    fn waiting(texts: u8) -> Waiting<u8> {
        let mut waiting = Waiting::default();
        for n in 0..texts {
            assert_eq!(waiting.add(n, (RequestKey([n; 16]), "hello"), PromptId(0), at(0)), Ok(()));
        }
        waiting
    }

    #[test]
    fn key_is_that_of_the_message_and_of_no_other() {
        let writers = [[1_u8; 16], [2; 16]];
        let mut keys = Vec::new();
        for writer in &writers {
            for (sequence, text) in [(1, "a"), (2, "a"), (1, "b"), (-1, "")] {
                assert_eq!(key(writer, sequence, text), key(writer, sequence, text));
                keys.push(key(writer, sequence, text));
            }
        }
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), 8);
        assert!(keys.iter().all(|RequestKey(key)| key[..8] != key[8..]));
    }

    #[test]
    fn flood_is_refused_and_what_waits_is_kept() {
        let mut waiting = waiting(WAITING_MAX as u8);
        let more = (RequestKey([99; 16]), "hello");
        assert_eq!(
            waiting.add(9, more, PromptId(0), at(0)),
            Err((9, "too many utterances at a time"))
        );
        assert_eq!(waiting.due(at(0)).map(|request| request.key), Some(RequestKey([0; 16])));
        assert_eq!(waiting.due(at(1)), None, "the second one waits for the first one's receipt");
        let accepted = |key| Receipt {
            key,
            seq: 5,
            status: ReceiptStatus::Accepted.into(),
            ..Receipt::default()
        };
        assert_eq!(waiting.on_receipt(&accepted([50; 16])), None);
        assert_eq!(waiting.on_receipt(&accepted([0; 16])), Some((0, Ok(5))));
        assert_eq!(waiting.due(at(2)).map(|request| request.key), Some(RequestKey([1; 16])));
        assert_eq!(waiting.add(9, more, PromptId(0), at(2)), Ok(()));
    }

    #[test]
    fn odd_words_are_refused() {
        let mut waiting = waiting(1);
        let long = "x".repeat(TEXT_BYTES_MAX + 1);
        for text in ["", " \n", &long] {
            assert!(waiting.add(9, (RequestKey([7; 16]), text), PromptId(0), at(0)).is_err());
        }
        let again = (RequestKey([0; 16]), "hello");
        assert!(waiting.add(9, again, PromptId(0), at(0)).is_err(), "delivered twice, said once");
    }

    #[test]
    fn silence_of_the_speech_service_is_an_answer() {
        let mut waiting = waiting(2);
        assert_eq!(waiting.expired(at(7_999)), None);
        assert!(matches!(waiting.expired(at(8_000)), Some((0, Err(_)))));
        assert!(matches!(waiting.expired(at(8_000)), Some((1, Err(_)))));
        assert_eq!(waiting.expired(at(9_000)), None);
    }
}
