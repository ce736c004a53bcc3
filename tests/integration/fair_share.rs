//! Several clients at once: none waits for another's backlog.

use messages::{Injection, Receipt, ReceiptStatus, Sound, topics};
use service::client::{Client, deliver};
use service::{Span, Time, clock};
use whichone_tests::hammer::Hammer;
use whichone_tests::{Group, wait_for};

/// Requests of the hammering client before the other one speaks, more than the group ever holds.
const BACKLOG: u64 = 1_000;
/// Utterances of others that may be accepted between a request and its own acceptance: what is on its
/// way, and what a busy machine lets through meanwhile.
const AHEAD_MAX: u64 = 64;

/// Up to 256 utterances of the other client came first, and further ones were refused.
#[test]
fn client_that_hammers_leaves_the_others_their_share() {
    let group = Group::up(&["dialogue.turns.questions_max=1000"]);
    // Nothing is fetched, so that the interaction stays open.
    group.must(&["stop-motion"]);
    let client = Client::join(group.paths()).unwrap();
    let receipts = client.bus().reader::<Receipt>(&topics::RECEIPT).unwrap();
    let writer = client.bus().encoded_writer::<Injection>(&topics::INJECTION).unwrap();
    let hammer = Hammer::start(&group, "the metal one");
    wait_for("a backlog", 30.0, || (hammer.sent() >= BACKLOG).then_some(()));
    for text in ["the white one", "no", "the plastic one", "start over"] {
        let mut latest = 0;
        let before = wait_for("an utterance of the other client", 20.0, || {
            receipts.drain(|receipt| latest = latest.max(receipt.seq)).unwrap();
            (latest > 0).then_some(latest)
        });
        let (sound, said) = (Sound::Text(text.to_owned()), (clock::now(), Time(0)));
        let own = deliver(&writer, &receipts, sound, said, Span::from_ms(20_000), || None).unwrap();
        assert_eq!(own[0].status.get(), ReceiptStatus::Accepted, "{text}: {:?}", own[0].note);
        let ahead = own[0].seq - before - 1;
        assert!(ahead <= AHEAD_MAX, "{text}: {ahead} utterances of the other client came first");
        let applied = || group.dialogue()["applied"].as_u64().filter(|seq| *seq >= own[0].seq);
        wait_for("the answer", 20.0, applied);
    }
    drop(hammer);
    drop((receipts, writer, client));
    group.down();
}
