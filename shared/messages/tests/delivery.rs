//! Outbox and inbox together: whatever a lossy, doubling, reordering wire does, each message is
//! applied exactly once and in order, as long as the wire works now and then.

use messages::UtteranceSeq;
use messages::inbox::{Inbox, Verdict};
use messages::outbox::Outbox;
use proptest::prelude::*;

/// Simulated delivery of a window of messages.
#[derive(Clone, Copy, Debug)]
enum Fault {
    LoseAll,
    LoseOdd,
    Double,
    Reverse,
    LoseMark,
    ReceiverRestarts,
    SenderRestarts,
    ForgedMark(u64),
}

fn fault() -> impl Strategy<Value = Fault> {
    use Fault::*;
    let forged = prop_oneof![Just(u64::MAX), Just(u64::MAX - 1), 1 << 40..u64::MAX];
    let usual = [LoseAll, LoseOdd, Double, Reverse, LoseMark, ReceiverRestarts, SenderRestarts];
    prop_oneof![7 => prop::sample::select(usual.to_vec()), 1 => forged.prop_map(ForgedMark)]
}

struct Pair {
    accepted: Vec<u32>,
    outbox: Outbox<u32>,
    inbox: Inbox,
    applied: Vec<u32>,
}

impl Pair {
    fn new() -> Self {
        let outbox = Outbox::new(UtteranceSeq(0), 4, 64);
        Self { accepted: Vec::new(), outbox, inbox: Inbox::default(), applied: Vec::new() }
    }

    fn accept(&mut self, message: u32) {
        if let Ok(seq) = self.outbox.next() {
            self.accepted.push(message);
            self.outbox.push(seq, message);
        }
    }

    fn exchange(&mut self, fault: Option<Fault>) {
        let mut wire: Vec<(UtteranceSeq, u32)> = self.outbox.window().copied().collect();
        match fault {
            Some(Fault::LoseAll) => wire.clear(),
            Some(Fault::LoseOdd) => wire.retain(|(seq, _)| seq.0 % 2 == 0),
            Some(Fault::Double) => wire.extend(wire.clone()),
            Some(Fault::Reverse) => wire.reverse(),
            Some(Fault::ReceiverRestarts) => {
                self.inbox = Inbox::new(UtteranceSeq(self.applied.len() as u64));
            }
            Some(Fault::SenderRestarts) => self.restart_sender(),
            Some(Fault::ForgedMark(mark)) => {
                assert!(!self.outbox.acknowledge(UtteranceSeq(mark)), "never sent");
            }
            Some(Fault::LoseMark) | None => {}
        }
        for (seq, message) in wire {
            if self.inbox.judge(seq) == Verdict::Apply {
                self.applied.push(message);
                self.inbox.advance();
            }
        }
        if !matches!(fault, Some(Fault::LoseMark)) {
            self.outbox.acknowledge(self.inbox.applied());
        }
    }

    /// The sender comes back from its journal, which holds everything that was accepted.
    fn restart_sender(&mut self) {
        self.outbox = Outbox::new(UtteranceSeq(0), 4, 64);
        for (i, message) in self.accepted.iter().enumerate() {
            self.outbox.push(UtteranceSeq(i as u64 + 1), *message);
        }
    }
}

proptest! {
    #[test]
    fn everything_accepted_is_applied_once_and_in_order(
        steps in prop::collection::vec((any::<Option<u32>>(), prop::option::of(fault())), 1..120)
    ) {
        let mut pair = Pair::new();
        for (message, fault) in steps {
            message.into_iter().for_each(|m| pair.accept(m));
            pair.exchange(fault);
            prop_assert!(pair.accepted.starts_with(&pair.applied));
        }
        for _ in 0..64 {
            pair.exchange(None);
        }
        prop_assert_eq!(&pair.applied, &pair.accepted);
        prop_assert!(pair.outbox.is_empty());
    }
}

#[test]
fn outbox_rejects_messages_when_full() {
    let mut outbox = Outbox::new(UtteranceSeq(7), 2, 2);
    for message in 0..2 {
        let seq = outbox.next().unwrap();
        outbox.push(seq, message);
    }
    assert_eq!(outbox.next().unwrap_err().waiting, 2);
    outbox.acknowledge(UtteranceSeq(8));
    assert_eq!(outbox.next(), Ok(UtteranceSeq(10)));
}

#[test]
fn outbox_ignores_a_mark_that_was_never_sent() {
    let mut outbox: Outbox<u32> = Outbox::new(UtteranceSeq(7), 4, 8);
    outbox.push(UtteranceSeq(8), 0);
    for forged in [9, 41, u64::MAX] {
        assert!(!outbox.acknowledge(UtteranceSeq(forged)));
    }
    assert_eq!((outbox.len(), outbox.next()), (1, Ok(UtteranceSeq(9))));
    assert!(outbox.acknowledge(UtteranceSeq(8)) && outbox.is_empty());
}
