//! What each process remembers, what its journal holds, what travels, and what is true.

use messages::UtteranceSeq;
use messages::outbox::Outbox;

/// An utterance: the client's key, and the object that an answer names; 0 for a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Said {
    pub(super) key: u8,
    pub(super) object: u8,
}

/// An order of the policy, as it is published and journaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Ordered {
    pub(super) interaction: u8,
    pub(super) object: u8,
}

/// The state of the policy; each of its records holds it whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Policy {
    pub(super) applied: u8,
    pub(super) last_interaction: u8,
    pub(super) last_prompt: u8,
    /// The open interaction, 0 for none.
    pub(super) open: u8,
    /// Its order; object 0 while it asks.
    pub(super) pick: u8,
    /// Whether that order is called off.
    pub(super) called_off: bool,
    /// The latest end: interaction, and the object delivered, 0 where it failed.
    pub(super) ended: (u8, u8),
}

/// The state of the arm; each of its records holds it whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Arm {
    pub(super) pick: Ordered,
    pub(super) phase: Phase,
    pub(super) stopped: bool,
    /// The latest stop order obeyed.
    pub(super) obeyed: u8,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) enum Phase {
    #[default]
    None,
    Accepted,
    Holding,
    /// The gripper opens where it hands over.
    LettingGo,
    /// Called off while it holds: the object goes back.
    Returning,
    Delivered,
    Failed,
    /// Called off, and left or put back.
    Cancelled,
}

/// Speech's journal.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct SpeechJournal {
    /// Number before the first of `accepted`.
    pub(super) base: u8,
    pub(super) accepted: Vec<Said>,
    pub(super) presented: u8,
    /// Number of a stop that was said, until the arm has confirmed it; 0 for none.
    pub(super) stop: u8,
}

/// Speech's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Speech {
    pub(super) mark: Option<u8>,
    pub(super) playing: u8,
}

/// What travels. Latest-value topics hold one message.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Bus {
    pub(super) injection: Option<Said>,
    pub(super) receipt: Option<(u8, u8)>,
    /// Utterances by number, in any order.
    pub(super) utterances: Vec<(u8, Said)>,
    pub(super) mark: Option<u8>,
    /// Prompt asked, order, and whether it is called off.
    pub(super) act: Option<(u8, Ordered, bool)>,
    pub(super) status: Option<(Ordered, Phase)>,
    /// What the client sees.
    pub(super) view: Policy,
    pub(super) presented: u8,
    /// Numbers of a stop order on its way to the arm, and of the order that the arm answers; 0 for none.
    pub(super) stop: u8,
    pub(super) stop_done: u8,
}

/// The client.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct Client {
    /// Objects that it has got.
    pub(super) got: u8,
    pub(super) keys: u8,
    pub(super) sending: Option<Said>,
    /// Highest number accepted.
    pub(super) accepted: u8,
    pub(super) answered: u8,
    pub(super) reported: u8,
}

/// What is true outside of all memories.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub(super) struct World {
    pub(super) holding: u8,
    /// The latest question that the user has heard to its end.
    pub(super) heard: u8,
    /// Bits of interactions.
    pub(super) grasped: u16,
    /// Bits of (interaction, object).
    pub(super) ordered: u32,
    pub(super) delivered: u32,
    /// Those that the arm knew to be called off before its gripper opened.
    pub(super) called_off: u32,
    /// Bits of keys.
    pub(super) acknowledged: u32,
    pub(super) applied: u32,
    /// The user has called something off.
    pub(super) calls_off: bool,
    pub(super) stop_seen: bool,
    pub(super) stops: u8,
    /// Times at which a stop was said.
    pub(super) stop_orders: u8,
    /// One of them was accepted.
    pub(super) stop_said: bool,
    /// The number of one that the arm has not latched.
    pub(super) stop_due: u8,
    pub(super) crashes: u8,
    pub(super) lost: u8,
    pub(super) broken: Option<&'static str>,
}

/// Everything at one moment.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct State {
    pub(super) client: Client,
    pub(super) speech_journal: SpeechJournal,
    pub(super) speech: Option<Speech>,
    pub(super) policy_journal: Policy,
    pub(super) policy: Option<Policy>,
    pub(super) arm_journal: Arm,
    pub(super) arm: Option<Arm>,
    pub(super) bus: Bus,
    pub(super) world: World,
}

pub(super) fn bit(order: Ordered) -> u32 {
    1 << (order.interaction * 3 + order.object)
}

impl World {
    pub(super) fn must(&mut self, holds: bool, what: &'static str) {
        if !holds {
            self.broken.get_or_insert(what);
        }
    }
}

impl SpeechJournal {
    /// The real outbox as it is recovered from the journal, with the mark.
    pub(super) fn outbox(&self, mark: Option<u8>) -> Outbox<Said> {
        let mut outbox = Outbox::new(UtteranceSeq(self.base.into()), 16, 256);
        for (seq, said) in (u64::from(self.base) + 1..).zip(&self.accepted) {
            outbox.push(UtteranceSeq(seq), *said);
        }
        if let Some(mark) = mark {
            // A mark that was never sent is not believed, as in the service.
            let _ = outbox.acknowledge(UtteranceSeq(mark.into()));
        }
        outbox
    }

    pub(super) fn number(&self, key: u8) -> Option<u8> {
        let at = self.accepted.iter().position(|said| said.key == key)?;
        Some(self.base + at as u8 + 1)
    }

    pub(super) fn last(&self) -> u8 {
        self.base + self.accepted.len() as u8
    }
}

impl State {
    /// The highest number that any journal has given to anything.
    pub(super) fn highest_number(&self) -> u8 {
        let (speech, policy) = (&self.speech_journal, &self.policy_journal);
        let numbers = [
            speech.last(),
            speech.presented,
            policy.applied,
            policy.last_interaction,
            policy.last_prompt,
            self.arm_journal.pick.interaction,
            self.client.reported,
        ];
        numbers.into_iter().max().unwrap_or(0)
    }
}
