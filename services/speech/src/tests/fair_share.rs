//! Several clients that ask for much: each has its share, and none waits for another's backlog.

use messages::{ClientId, ReceiptStatus};

use super::*;

const HAMMERING: ClientId = ClientId(1);
const POLITE: ClientId = ClientId(2);

impl Speech {
    /// Types request `number` of a client.
    fn request(&mut self, client: ClientId, number: u64, text: &str) -> Outputs {
        let (key, sound) = (RequestKey::new(client, number), Sound::Text(text.to_owned()));
        self.take(0.001, In::Injection(Injection::new(key, sound)))
    }

    /// Applies utterances up to `seq`; returns the clients whose requests are accepted then.
    fn apply(&mut self, seq: u64) -> Vec<ClientId> {
        self.take(0.001, In::Mark(AppliedMark { seq })).accepted()
    }
}

impl Outputs {
    /// Returns the clients whose requests were accepted.
    fn accepted(&self) -> Vec<ClientId> {
        let of_receipt = |out: &Out| match out {
            Out::Receipt(receipt) if receipt.seq > 0 => Some(receipt.request().client()),
            _ => None,
        };
        self.0.iter().filter_map(of_receipt).collect()
    }
}

/// Everybody waited for a hammering client, or was refused: up to 256 of its utterances came first.
#[test]
fn client_that_hammers_does_not_delay_another() {
    let mut speech = Speech::new();
    for number in 0..1_000 {
        speech.request(HAMMERING, number, "the bowl");
    }
    let receipt = speech.request(POLITE, 0, "the white bowl").receipt().expect("a receipt");
    assert_eq!(receipt.status.get(), ReceiptStatus::Accepted, "{:?}", receipt.note);
    assert!(receipt.seq <= 5, "{} utterances of the other client come first", receipt.seq - 1);
}

#[test]
fn clients_that_ask_for_more_than_their_share_take_turns() {
    let mut speech = Speech::new();
    for number in 0..8 {
        speech.request(HAMMERING, number, "the bowl");
    }
    for number in 0..8 {
        speech.request(POLITE, number, "the white bowl");
    }
    // Four of each are on their way.
    let turns: Vec<ClientId> = (1..=8).flat_map(|seq| speech.apply(seq)).collect();
    assert_eq!(turns, [[HAMMERING; 4], [POLITE; 4]].concat(), "each follows its own");
    let all = (9..=16).flat_map(|seq| speech.apply(seq)).count();
    assert_eq!((all, speech.records.len()), (0, 16), "each request is accepted once");
}

#[test]
fn request_beyond_the_bound_is_taken_when_it_is_sent_again() {
    let mut speech = Speech::new();
    // 4 accepted, 16 waiting.
    for number in 0..21 {
        speech.request(HAMMERING, number, "the bowl");
    }
    let again = speech.request(HAMMERING, 20, "the bowl");
    assert!(again.receipt().is_none(), "no room, no answer");
    assert_eq!(speech.apply(1), [HAMMERING]);
    assert!(speech.request(HAMMERING, 20, "the bowl").receipt().is_none(), "it waits now");
    let accepted: usize = (2..=20).map(|seq| speech.apply(seq).len()).sum();
    assert_eq!((accepted, speech.records.len()), (16, 21));
    assert!(speech.request(HAMMERING, 20, "the bowl").receipt().is_some(), "its receipt again");
}

#[test]
fn stop_waits_for_no_turn() {
    let mut speech = Speech::new();
    for number in 0..100 {
        speech.request(HAMMERING, number, "the bowl");
    }
    let outputs = speech.request(HAMMERING, 100, "stop");
    assert!(outputs.stops_motion() && outputs.receipt().is_none());
}
