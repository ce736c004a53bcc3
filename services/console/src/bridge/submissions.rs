//! Words of viewers on their way to the robot: sent under one key until they are answered, so that
//! no restart in between loses or doubles them.

use messages::{Hypothesis, Injection, Receipt, ReceiptStatus, Sound};
use service::bus::EncodedWriter;
use service::client::random_key;
use service::{Span, Time};

use crate::hub::command::Words;
use crate::hub::outbound::Answer;
use crate::hub::{Hub, ViewerId};

/// How often words without an answer are sent again.
const RESEND_EVERY: Span = Span::from_ms(250);
/// How long an answer is waited for.
const PATIENCE: Span = Span::from_ms(8_000);
/// Words on their way at a time.
const WORDS_MAX: usize = 32;

/// Words on their way.
#[derive(Debug, Default)]
pub(super) struct Submissions(Vec<Waiting>);

#[derive(Debug)]
struct Waiting {
    /// Who waits for the answer; nobody for words of the study's.
    viewer: Option<(ViewerId, u64)>,
    injection: Injection,
    began: Time,
    sent: Option<Time>,
}

impl Submissions {
    pub(super) fn add(
        &mut self,
        viewer: Option<(ViewerId, u64)>,
        words: Words,
        now: Time,
    ) -> Result<(), String> {
        if self.0.len() >= WORDS_MAX {
            return Err("too much is being said at a time; wait a moment".to_owned());
        }
        let Words { text, alternatives, spoken, began, ended } = words;
        let sound = if spoken {
            let other =
                |(text, weight): (String, f64)| Hypothesis { weight, ..Hypothesis::certain(text) };
            let first = Hypothesis::certain(text);
            let hypotheses = std::iter::once(first).chain(alternatives.into_iter().map(other));
            Sound::Transcript { hypotheses: hypotheses.collect() }
        } else {
            Sound::Text(text)
        };
        let onset_ns = began.unwrap_or(now).ns();
        let end_ns = ended.map_or(0, Time::ns);
        let injection = Injection { key: random_key(), onset_ns, end_ns, sound };
        self.0.push(Waiting { viewer, injection, began: now, sent: None });
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Sends what is due and gives up what nobody answers.
    pub(super) fn pass(&mut self, writer: &EncodedWriter<Injection>, hub: &Hub, now: Time) {
        for said in &mut self.0 {
            if said.sent.is_none_or(|sent| now >= sent + RESEND_EVERY) {
                if let Err(error) = writer.send(&said.injection) {
                    tracing::debug!(%error, "words not sent yet");
                }
                said.sent = Some(now);
            }
        }
        self.0.retain(|said| {
            let waits = now < said.began + PATIENCE;
            if let Some((viewer, id)) = said.viewer.filter(|_| !waits) {
                let why = "the speech service does not answer; see the list of services";
                hub.answer(viewer, id, Err(why.to_owned()));
            }
            waits
        });
    }

    /// What became of some words.
    pub(super) fn on_receipt(&mut self, receipt: &Receipt, hub: &Hub) {
        let Some(at) = self.0.iter().position(|said| said.injection.key == receipt.request())
        else {
            return;
        };
        let Some((viewer, id)) = self.0.swap_remove(at).viewer else { return };
        let note = receipt.note.as_str().unwrap_or_default();
        let outcome = match receipt.status.get() {
            ReceiptStatus::Accepted => Ok(Some(Answer::Accepted { seq: receipt.seq })),
            ReceiptStatus::NotForMe => Err(format!("heard, but not taken for a request: {note}")),
            _ => Err(note.to_owned()),
        };
        hub.answer(viewer, id, outcome);
    }
}
