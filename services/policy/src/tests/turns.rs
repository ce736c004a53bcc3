//! Decisions that wait until the person has ended.

use super::*;
use messages::Activity;

#[test]
fn a_deferred_decision_is_made_when_the_person_has_ended() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let speaks = Activity { onset_ns: at(1).ns(), pending: 1, ..Activity::default() };
    tell(&mut node, In::Activity(speaks), at(1));
    tell(&mut node, observation(1, 0, &Reading::default()), at(2));
    assert_eq!(node.state().act.kind, ActKind::Wait, "the person speaks on");
    let (records, _) = tell(&mut node, In::Activity(Activity::default()), at(3));
    assert_eq!(records.iter().map(|r| r.cause.clone()).collect::<Vec<_>>(), [Cause::Quiet]);
    assert_eq!(node.state().act.kind, ActKind::Ask);
}

#[test]
fn a_sound_that_never_ends_holds_nothing_back_for_ever() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let speaks = Activity { onset_ns: at(1).ns(), pending: 1, ..Activity::default() };
    tell(&mut node, In::Activity(speaks), at(1));
    tell(&mut node, observation(1, 0, &Reading::default()), at(2));
    let mut effects: Effects<Out, Record> = Effects::default();
    node.on(Event::Tick, at(11), &mut effects);
    assert_eq!(node.state().act.kind, ActKind::Wait);
    node.on(Event::Tick, at(13), &mut effects);
    assert_eq!(node.state().act.kind, ActKind::Ask);
}
