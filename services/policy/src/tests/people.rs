//! People who give their name, and who want to be forgotten.

use messages::Forget;
use vocabulary::PersonId;

use super::*;

fn said_by(seq: u64, name: &str) -> In<'static> {
    let In::Observation(observation) = observation(seq, 0, &words(&["clear"])) else {
        unreachable!()
    };
    let from = FixedText::truncated(name);
    In::Observation(MessageRef::from(Observation { from, ..*observation }))
}

fn forget(key: u64, name: &str) -> In<'static> {
    In::Forget(Forget { key, person: FixedText::truncated(name), ..Forget::default() })
}

/// A policy that has had something fetched for each of them.
fn after(names: &[&str]) -> (PolicyNode, Vec<Record>) {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let mut records = Vec::new();
    for (seq, name) in (1..).zip(names) {
        records.extend(tell(&mut node, said_by(seq, name), at(100 * seq)).0);
        let (pick, _) = node.state().act.pick.expect("a unique description");
        let delivered = Cause::PickEnded { pick, outcome: PickOutcome::Delivered };
        let mut effects = Effects::default();
        node.apply(delivered, at(100 * seq + 1), &mut effects);
        records.extend(effects.take_records());
    }
    (node, records)
}

fn known(node: &PolicyNode) -> Vec<&str> {
    node.state().people().iter().map(|known| known.id.as_str()).collect()
}

#[test]
fn deliveries_teach_who_gave_a_name_and_an_order_has_the_policy_forget_one() {
    let (mut node, mut records) = after(&["Ann", "", "Bob", "guest"]);
    assert_eq!(known(&node), ["Ann", "Bob"]);
    assert!(!node.take_erasure());
    let (stated, outputs) = tell(&mut node, forget(7, "Ann"), at(900));
    let ann = PersonId::new("Ann").unwrap();
    assert!(matches!(&stated[..], [Record { cause: Cause::Forget(it), .. }] if *it == ann));
    let answers = |out: &Out| matches!(out, Out::View(view) if view.forgot == 7);
    assert!(outputs.iter().any(answers));
    records.extend(stated);
    assert_eq!(known(&node), ["Bob"]);
    assert!(node.take_erasure() && !node.take_erasure());
    assert_eq!(tell(&mut node, forget(7, "Ann"), at(901)).0, [], "it is repeated until answered");
    for nobody in ["", "guest", "a\nb"] {
        assert_eq!(tell(&mut node, forget(8, nobody), at(902)).0, [], "{nobody:?}");
    }
    refold(&mut manager(), &records).unwrap();

    // Killed before the journal was erased.
    let mut again = PolicyNode::recover(manager().into(), records).unwrap();
    assert_eq!(known(&again), ["Bob"]);
    assert!(again.take_erasure());
    let snapshot = again.snapshot().unwrap();
    let bytes = postcard::to_stdvec(&snapshot).unwrap();
    assert!(!bytes.windows(3).any(|window| window == b"Ann"), "no name in the snapshot");
    let mut after = PolicyNode::recover(manager().into(), snapshot).unwrap();
    assert!(!after.take_erasure());
}

#[test]
fn view_names_the_person_of_the_first_utterance_while_the_interaction_is_open() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let from = |outputs: &[Out]| {
        let name = |out: &Out| match out {
            Out::View(view) => Some(view.from.clone()),
            _ => None,
        };
        outputs.iter().rev().find_map(name).unwrap()
    };
    let (_, outputs) = tell(&mut node, said_by(1, "Ann"), at(1));
    assert_eq!(from(&outputs), "Ann");
    let (_, outputs) = tell(&mut node, said_by(2, "Bob"), at(2));
    assert_eq!(from(&outputs), "Ann");
}

#[test]
fn utterance_with_a_name_that_cannot_be_printed_stays_pending() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    assert!(tell(&mut node, said_by(1, "a\u{7}"), at(1)).0.is_empty());
    assert_eq!(node.state().applied, UtteranceSeq(0));
}
