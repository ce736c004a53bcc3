//! A lost journal, of the policy or another service, and orders partly unknown to the arm.

use service::SetAside;

use super::*;

const OVER: u64 = service::journal_set::NUMBERS_SKIPPED;

fn start(node: &mut PolicyNode, is_own: bool, now: Time) -> Vec<Record> {
    let mut effects = Effects::default();
    node.on(Event::SetAside(SetAside { over: OVER, is_own }), now, &mut effects);
    node.on(Event::Started, now, &mut effects);
    effects.take_records()
}

#[test]
fn policy_without_memory_takes_no_old_utterance_and_gives_no_old_number() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let mut records = start(&mut node, true, at(1));
    assert_eq!(records.len(), 1);
    for old in [1, 2, 17, OVER] {
        assert!(tell(&mut node, observation(old, 0, &Reading::default()), at(2)).0.is_empty());
    }
    records.extend(tell(&mut node, observation(OVER + 1, 0, &Reading::default()), at(3)).0);
    let state = node.state();
    let open = state.open.as_ref().expect("the request begins an interaction");
    assert_eq!((open.id.0, state.applied.0), (OVER + 1, OVER + 1));
    assert!(state.act.prompt.0 > OVER && state.act.id.0 > OVER, "{:?}", state.act);
    refold(&mut manager(), &records).unwrap();

    // Every further start repeats it.
    let mut again = PolicyNode::recover(manager().into(), records).unwrap();
    assert_eq!(start(&mut again, false, at(4)), []);
    assert_eq!(again.state(), state);
}

#[test]
fn interaction_ends_with_the_reason_when_a_journal_was_set_aside() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let mut records = tell(&mut node, observation(1, 0, &Reading::default()), at(1)).0;
    let mut node = PolicyNode::recover(manager().into(), records.clone()).unwrap();
    records.extend(start(&mut node, false, at(2)));
    let state = node.state();
    assert_eq!(state.ended.as_ref().map(|ended| ended.outcome), Some(Outcome::Abandoned));
    assert_eq!(text(state), "I have lost a part of my memory; please ask me again.");
    assert!(state.act.prompt.0 > OVER, "{:?}", state.act);
    refold(&mut manager(), &records).unwrap();
}

/// The arm's journal may remember another pick under the number of this one.
#[test]
fn delivery_of_another_object_than_the_ordered_one_is_none() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let sure = words(&["small", "white", "plastic", "dishwasher", "dishwasher", "dishwasher"]);
    tell(&mut node, observation(1, 0, &sure), at(1));
    let (pick, object) = node.state().act.pick.expect("sure enough to pick");
    let status = ArmStatus {
        interaction: pick.interaction.0,
        attempt: pick.attempt,
        object: u32::from(object.0) + 1,
        phase: PickPhase::Done.code(),
        outcome: PickOutcome::Delivered.code(),
        ..ArmStatus::default()
    };
    let (records, outputs) = tell(&mut node, In::Arm(status), at(2));
    let cause = Cause::PickEnded { pick, outcome: PickOutcome::Interrupted };
    assert_eq!(records.iter().map(|record| &record.cause).collect::<Vec<_>>(), [&cause]);
    assert_eq!(node.state().ended.as_ref().map(|ended| ended.outcome), Some(Outcome::Failed));
    let rejected = outputs.iter().find_map(|out| match out {
        Out::View(view) => Some(view.refused),
        _ => None,
    });
    assert_eq!(rejected, Some(1));
}
