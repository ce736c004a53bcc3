//! The journal: numbers in its records, and recovery from them.

use super::*;
use dialogue::manager::{Reason, Remark};

/// Journals hold the last remark: one inserted before others made a start after an upgrade fail.
#[test]
fn remarks_keep_their_numbers_in_journals() {
    let number = |remark: Remark| postcard::to_stdvec(&remark).unwrap()[0];
    for (remark, expected) in [
        (Remark::Stopped, 0),
        (Remark::AllRight, 7),
        (Remark::Idle, 9),
        (Remark::PuttingBack(String::new()), 13),
        (Remark::Why(Reason::None), 16),
        (Remark::OnlyFetches(None), 17),
        (Remark::TooLate(String::new()), 18),
        (Remark::StillStopped, 19),
        (Remark::StopUnconfirmed, 20),
    ] {
        assert_eq!(number(remark.clone()), expected, "{remark:?}");
    }
}

/// The journal folds again, and from any record on, or from a snapshot in the middle of an
/// interaction, the policy has its former state.
#[test]
fn policy_is_recovered_from_any_record_and_from_any_snapshot() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let mut records = tell(&mut node, observation(1, 0, &words(&["white"])), at(1)).0;
    for seq in 2..6 {
        let prompt = node.state().act.prompt.0;
        let said =
            observation(seq, prompt, &answer([Response::No, Response::Yes][seq as usize % 2]));
        records.extend(tell(&mut node, said, at(seq)).0);
    }
    assert_eq!(records.len(), 5);
    refold(&mut manager(), &records).unwrap();
    for (n, record) in records.iter().enumerate() {
        let again = PolicyNode::recover(manager().into(), records[..=n].to_vec()).unwrap();
        assert_eq!(again.state(), &record.state);
        let snapshot = again.snapshot().expect("a snapshot");
        let again = PolicyNode::recover(manager().into(), snapshot).unwrap();
        assert_eq!(again.state(), &record.state);
    }
}

#[test]
fn settings_that_change_at_rest_are_recorded_and_change_nothing_else() {
    let mut manager = manager();
    let before = manager.first();
    let other = settings_with(&[("dialogue.epsilon", "0.02")]);
    let mut node = PolicyNode::recover(
        other.manager().unwrap().into(),
        vec![Record { cause: Cause::Snapshot, at: at(1), state: before.clone() }],
    )
    .unwrap();
    let mut effects: Effects<Out, Record> = Effects::default();
    node.on(Event::Started, at(2), &mut effects);
    let records = effects.take_records();
    assert_eq!(records.len(), 1);
    assert_eq!(records[0].cause, Cause::Reconfigured);
    let after = &records[0].state;
    let same = State { settings_key: before.settings_key, ..after.clone() };
    assert_eq!(same, manager.next(&before, &Cause::Snapshot, at(2)));
}
