//! Words of users, and the calls that withdraw a request.

use super::{Node, failure};
use crate::dds::Call;
use crate::hear;
use crate::types::{Text, Triggered};
use service::client::random_key;
use service::clock;

/// Words that withdraw a request.
const NEVER_MIND: &str = "never mind";

/// Who waits for the answer to an utterance.
#[derive(Debug)]
pub(super) enum Speaking {
    /// No call: the words came by topic.
    Topic,
    /// A call of `cancel`.
    Cancel(Call),
}

impl Node {
    /// Takes words, and calls of `cancel`.
    pub(super) fn on_words(&mut self) {
        let now = clock::now();
        let seen = self.latest.prompt();
        let Self { dds, counters, waiting, .. } = self;
        let (mut unreadable, mut refused) = (0, 0);
        let more = dds.hear.drain(&mut unreadable, |Text { data }, info| {
            let key = hear::key(info.publisher_gid().as_bytes(), info.sequence_number(), &data);
            if let Err((_, why)) = waiting.add(Speaking::Topic, (key, &data), seen, now) {
                refused += 1;
                tracing::debug!(why, "an utterance is refused");
            }
        });
        counters.unreadable += unreadable;
        counters.refused += refused;
        self.has_more |= more;
        let is_open = self.latest.view.as_ref().is_some_and(|view| view.interaction != 0);
        for call in dds.cancel.calls(&mut counters.unreadable) {
            let words = (random_key(), NEVER_MIND);
            let refused = match is_open {
                true => {
                    waiting.add(Speaking::Cancel(call), words, seen, now).err().map(|(_, why)| why)
                }
                false => Some("no request is open"),
            };
            if let Some(why) = refused {
                dds.cancel.respond(call, failure(why), &mut counters.dropped);
            }
        }
    }

    pub(super) fn advance_words(&mut self) {
        let now = clock::now();
        if let Some(request) = self.waiting.due(now)
            && let Err(error) = self.group.injections.send(request)
        {
            tracing::debug!(%error, "utterance not sent yet");
        }
        while let Some((speaking, answer)) = self.waiting.expired(now) {
            self.on_answer(speaking, answer);
        }
    }

    pub(super) fn on_answer(&mut self, speaking: Speaking, answer: hear::Answer) {
        match &answer {
            Ok(_) => self.counters.accepted += 1,
            Err(why) => {
                self.counters.refused += 1;
                tracing::warn!(why, "an utterance is not followed");
            }
        }
        let Speaking::Cancel(call) = speaking else { return };
        let response = match answer {
            Ok(number) => {
                let message = format!("\"{NEVER_MIND}\" is accepted as utterance {number}");
                Triggered { success: true, message }
            }
            Err(why) => failure(&why),
        };
        self.dds.cancel.respond(call, response, &mut self.counters.dropped);
    }
}
