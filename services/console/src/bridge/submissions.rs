//! Utterances of viewers and of the study on their way to the robot.

use messages::{ClientId, Hypothesis, Injection, Receipt, ReceiptStatus, RequestKey, Sound};
use service::bus::EncodedWriter;
use service::client::own_id;
use service::submission::Submission;
use service::{Span, Time};

use crate::hub::command::Words;
use crate::hub::outbound::Answer;
use crate::hub::{Hub, ViewerId};

/// Deadline of a receipt.
const PATIENCE: Span = Span::from_ms(8_000);
/// Most utterances of one viewer on their way, and of all of them.
const WORDS_MAX: (usize, usize) = (8, 128);

/// Returns a viewer's identity among the clients of the speech service; the study's is the
/// console's own.
fn client_of(viewer: Option<ViewerId>) -> ClientId {
    ClientId(own_id().0.wrapping_add(viewer.map_or(0, |viewer| viewer.0)))
}

/// Utterances without a receipt.
#[derive(Debug, Default)]
pub(super) struct Submissions(Vec<Waiting>);

/// An utterance without a receipt.
#[derive(Debug)]
struct Waiting {
    /// The viewer and command that wait for it.
    viewer: Option<(ViewerId, u64)>,
    submission: Submission,
    /// Highest utterance that had been accepted before it was submitted.
    accepted: u64,
}

impl Submissions {
    /// Adds an utterance of a viewer, before which utterances up to `accepted` were accepted.
    pub(super) fn add(
        &mut self,
        viewer: Option<(ViewerId, u64)>,
        words: Words,
        accepted: u64,
        now: Time,
    ) -> Result<(), String> {
        let client = client_of(viewer.map(|(viewer, _)| viewer));
        let client = words.key.map_or(client, RequestKey::client);
        let own = self.0.iter().filter(|it| it.submission.key().client() == client);
        if own.count() >= WORDS_MAX.0 || self.0.len() >= WORDS_MAX.1 {
            return Err("too many utterances at a time; help: wait a moment".to_owned());
        }
        let Words { text, alternatives, spoken, began, ended, seen, from, key } = words;
        let sound = if spoken {
            let other =
                |(text, weight): (String, f64)| Hypothesis { weight, ..Hypothesis::certain(text) };
            let first = Hypothesis::certain(text);
            let hypotheses = std::iter::once(first).chain(alternatives.into_iter().map(other));
            Sound::Transcript { hypotheses: hypotheses.collect() }
        } else {
            Sound::Text(text)
        };
        let said = (began.unwrap_or(now), ended.unwrap_or(Time(0)));
        let submission = Submission::new(sound, said, now, PATIENCE).after(seen).by(from.as_str());
        let submission = match key {
            Some(key) => submission.under(key),
            None => submission.of(client),
        };
        self.0.push(Waiting { viewer, submission, accepted });
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Sends due requests and gives up expired ones.
    pub(super) fn pass(&mut self, writer: &EncodedWriter<Injection>, hub: &Hub, now: Time) {
        for Waiting { submission, .. } in &mut self.0 {
            if let Some(Err(error)) = submission.due(now).map(|request| writer.send(request)) {
                tracing::debug!(%error, "utterance not sent yet");
            }
        }
        for Waiting { viewer, .. } in self.0.extract_if(.., |it| it.submission.is_expired(now)) {
            if let Some((viewer, id)) = viewer {
                let why = "the speech service does not answer; help: see the list of services";
                hub.answer(viewer, id, Err(why.to_owned()));
            }
        }
    }

    /// Answers the command that waits for a receipt; an accepted one with the reason for any delay.
    pub(super) fn on_receipt(
        &mut self,
        receipt: &Receipt,
        hindrance: impl FnOnce() -> Option<String>,
        hub: &Hub,
    ) {
        let key = receipt.request();
        let Some(at) = self.0.iter().position(|it| it.submission.key() == key) else { return };
        let Waiting { viewer, accepted, submission } = self.0.swap_remove(at);
        let Some((viewer, id)) = viewer else { return };
        let note = receipt.note.as_str().unwrap_or_default();
        let answer = match receipt.status.get() {
            _ if submission.conflicts_with(receipt) => {
                let seq = receipt.seq;
                Err(format!(
                    "conflict (409): utterance {seq} with other text has this key; help: use a new key"
                ))
            }
            ReceiptStatus::Accepted => {
                let (seq, waits_for) = (receipt.seq, hindrance());
                Ok(Some(Answer::Accepted { seq, waits_for, known: seq <= accepted }))
            }
            ReceiptStatus::NotForMe => Err(format!("heard, but not taken for a request: {note}")),
            _ => Err(note.to_owned()),
        };
        hub.answer(viewer, id, answer);
    }
}
