//! Who talks with the robot, what each was shown last, and the latest replies.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use crate::state::State;

/// Silence after which a conversation loses the robot to others.
const OWNED_FOR: Duration = Duration::from_secs(60);
/// Conversations whose latest prompt is remembered.
const SHOWN_MAX: usize = 128;
/// Replies that are remembered for repeated requests.
const REPLIES_MAX: usize = 512;

/// The conversations of one console.
#[derive(Debug, Default)]
pub(crate) struct Conversations {
    owner: Option<Owner>,
    shown: VecDeque<(String, u64)>,
    replies: VecDeque<Replied>,
}

/// The conversation that the robot is in.
#[derive(Debug)]
struct Owner {
    conversation: String,
    until: Instant,
    /// Its latest utterance; none while that is being accepted.
    utterance: Option<u64>,
}

/// A request that was answered.
#[derive(Debug)]
struct Replied {
    /// The token's name and the request's key.
    key: (String, String),
    text: String,
    body: String,
}

/// What is remembered of a request's key.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Repeated {
    /// The answer that it got.
    Reply(String),
    /// Other words had this key.
    OtherWords,
}

impl Conversations {
    /// Claims the robot for a conversation; false while another one has an open request.
    pub(crate) fn claim(&mut self, conversation: &str, state: &State, now: Instant) -> bool {
        let is_open = |owner: &Owner| {
            let is_pending = owner.utterance.is_none_or(|seq| state.utterance < seq);
            now < owner.until && (state.interaction != 0 || is_pending)
        };
        let mut others = self.owner.iter().filter(|owner| owner.conversation != conversation);
        if others.any(is_open) {
            return false;
        }
        let conversation = conversation.to_owned();
        self.owner = Some(Owner { conversation, until: now + OWNED_FOR, utterance: None });
        true
    }

    /// Notes the utterance of a conversation that has claimed the robot; `None` if it was not accepted.
    pub(crate) fn said(&mut self, conversation: &str, utterance: Option<u64>) {
        let own = |owner: &mut Owner| owner.conversation == conversation;
        match utterance {
            Some(seq) => {
                let owner = self.owner.as_mut().filter(|owner| owner.conversation == conversation);
                owner.into_iter().for_each(|owner| owner.utterance = Some(seq));
            }
            None => drop(self.owner.take_if(|owner| own(owner) && owner.utterance.is_none())),
        }
    }

    /// Notes the latest prompt that a conversation was given.
    pub(crate) fn show(&mut self, conversation: &str, prompt: u64) {
        if prompt == 0 {
            return;
        }
        self.shown.retain(|(known, _)| known != conversation);
        if self.shown.len() == SHOWN_MAX {
            self.shown.pop_front();
        }
        self.shown.push_back((conversation.to_owned(), prompt));
    }

    /// Returns the latest prompt that a conversation was given, 0 for none.
    pub(crate) fn shown(&self, conversation: &str) -> u64 {
        let found = self.shown.iter().find(|(known, _)| known == conversation);
        found.map_or(0, |(_, prompt)| *prompt)
    }

    /// Remembers the reply to a request.
    pub(crate) fn remember(&mut self, key: (String, String), text: &str, body: &str) {
        self.replies.retain(|known| known.key != key);
        if self.replies.len() == REPLIES_MAX {
            self.replies.pop_front();
        }
        self.replies.push_back(Replied { key, text: text.to_owned(), body: body.to_owned() });
    }

    /// Returns what is remembered of a request.
    pub(crate) fn repeated(&self, key: &(String, String), text: &str) -> Option<Repeated> {
        let known = self.replies.iter().find(|known| known.key == *key)?;
        Some(match known.text == text {
            true => Repeated::Reply(known.body.clone()),
            false => Repeated::OtherWords,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(interaction: u64, utterance: u64) -> State {
        State { interaction, utterance, ..State::default() }
    }

    #[test]
    fn robot_is_in_one_conversation_at_a_time() {
        let (mut all, now) = (Conversations::default(), Instant::now());
        assert!(all.claim("hall", &state(0, 3), now));
        assert!(!all.claim("kitchen", &state(0, 3), now), "its words are being accepted");
        all.said("hall", Some(4));
        assert!(!all.claim("kitchen", &state(0, 3), now), "its words are not applied yet");
        assert!(!all.claim("kitchen", &state(2, 4), now), "its request is open");
        assert!(all.claim("hall", &state(2, 4), now));
        all.said("hall", None);
        assert!(all.claim("kitchen", &state(2, 4), now), "what was refused claims nothing");
        all.said("kitchen", Some(5));
        assert!(all.claim("hall", &state(0, 5), now), "the request has ended");
        all.said("hall", Some(6));
        assert!(!all.claim("kitchen", &state(3, 6), now + OWNED_FOR / 2));
        assert!(all.claim("kitchen", &state(3, 6), now + OWNED_FOR), "it was silent for long");
    }

    #[test]
    fn replies_and_prompts_are_remembered() {
        let mut all = Conversations::default();
        let key = |name: &str| (name.to_owned(), "k".to_owned());
        all.remember(key("hall"), "yes", "{}");
        assert_eq!(all.repeated(&key("hall"), "yes"), Some(Repeated::Reply("{}".to_owned())));
        assert_eq!(all.repeated(&key("hall"), "no"), Some(Repeated::OtherWords));
        assert_eq!(all.repeated(&key("kitchen"), "yes"), None);
        (0..REPLIES_MAX).for_each(|n| all.remember(key(&n.to_string()), "yes", "{}"));
        assert_eq!(all.repeated(&key("hall"), "yes"), None, "the oldest is forgotten");
        all.show("hall", 7);
        all.show("hall", 0);
        assert_eq!((all.shown("hall"), all.shown("kitchen")), (7, 0));
    }
}
