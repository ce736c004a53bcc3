//! Picks that are decided while the motion stop is latched.

use super::{answer, at, first, manager, remark, reply, tell, text, words};
use crate::{In, PolicyNode};
use dialogue::manager::{Cause, Manager, MotionStop, State};
use messages::{ActKind, ArmStatus};
use scene::{Intent, Reading, Response};
use service::Node;

fn stopped(manager: &mut Manager, said: &[&str]) -> State {
    let state = manager.next(&manager.first(), &Cause::MotionStop(MotionStop::Stopped), at(0));
    remark(manager, &state, words(said))
}

fn resume(manager: &mut Manager, state: &State) -> State {
    manager.next(state, &Cause::MotionStop(MotionStop::Released), at(state.applied.0))
}

#[test]
fn a_pick_while_stopped_is_announced_and_not_ordered() {
    let mut manager = manager();
    let state = stopped(&mut manager, &["clear"]);
    assert_eq!((state.act.kind, state.act.pick), (ActKind::Say, None));
    assert_eq!(text(&state), "The motion stop is on. Shall I get the clear bowl once you resume?");
    let resumed = resume(&mut manager, &state);
    assert_eq!((resumed.act.kind, resumed.act.pick), (ActKind::Say, None), "{}", text(&resumed));
    let confirmed = reply(&mut manager, &resumed, answer(Response::Yes));
    assert_eq!(confirmed.act.kind, ActKind::Pick);
    assert_eq!(text(&confirmed), "I will get the clear bowl.");
    // Whoever says it again means it, too.
    let again = remark(&mut manager, &resumed, words(&["clear"]));
    assert_eq!(again.act.kind, ActKind::Pick);
}

#[test]
fn what_was_confirmed_while_stopped_starts_with_the_release() {
    let mut manager = manager();
    let state = stopped(&mut manager, &["clear"]);
    let confirmed = reply(&mut manager, &state, answer(Response::Yes));
    assert_eq!(
        (confirmed.act.kind, text(&confirmed).as_str()),
        (ActKind::Say, "All right, once you resume.")
    );
    assert_eq!(resume(&mut manager, &confirmed).act.kind, ActKind::Pick);
}

#[test]
fn what_was_denied_or_withdrawn_while_stopped_does_not_start() {
    let mut manager = manager();
    let state = stopped(&mut manager, &["clear"]);
    let denied = reply(&mut manager, &state, answer(Response::No));
    let resumed = resume(&mut manager, &denied);
    assert_ne!(resumed.act.kind, ActKind::Pick);
    let open = denied.open.as_ref().expect("another one is wanted");
    assert!(open.belief().most_likely() != manager.scene().object_named("clear").unwrap());
    let never_mind = Reading { intent: Intent::Cancel, ..Reading::default() };
    let withdrawn = remark(&mut manager, &state, never_mind);
    assert!(resume(&mut manager, &withdrawn).open.is_none());
    let instead = Reading { response: Response::No, ..words(&["metallic", "big"]) };
    let other = reply(&mut manager, &state, instead);
    assert_eq!((other.act.kind, other.act.pick), (ActKind::Say, None));
}

/// What was ordered before the stop goes on with its release, as the operator wishes.
#[test]
fn a_stop_changes_no_order() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["clear"]));
    let stop = manager.next(&state, &Cause::MotionStop(MotionStop::Stopped), at(2));
    assert_eq!(stop.act, state.act);
    assert_eq!(resume(&mut manager, &stop).act, state.act);
}

#[test]
fn the_stop_is_heard_from_the_arm() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let status = |stopped| In::Arm(ArmStatus { stopped, ..ArmStatus::default() });
    assert_eq!(tell(&mut node, status(1), at(1)).0.len(), 1);
    assert!(node.state().motion_stop.is_latched());
    assert!(tell(&mut node, status(1), at(2)).0.is_empty());
    assert_eq!(tell(&mut node, status(0), at(3)).0.len(), 1);
    assert!(!node.state().motion_stop.is_latched());
}
