//! A cancelled object that cannot go back: the robot asks for a decision about it, and decides
//! nothing else before.

use super::fixture::{answer, at, belief, delivered, first, manager, remark, reply, text, words};
use crate::manager::{Cause, Manager, MotionStop, State};
use scene::{Intent, ObjectId, Reading, Response};
use vocabulary::ids::PickId;
use vocabulary::{ActKind, Outcome, PickOutcome};

const ASKS: &str = "I cannot put the clear bowl back, so I still hold it. Shall I give it to you?";

fn intent(intent: Intent) -> Reading {
    Reading { intent, ..Reading::default() }
}

/// A state in which the gripper has kept the clear bowl, which was called off so.
fn kept(manager: &mut Manager, called_off: Reading) -> (State, PickId, ObjectId) {
    let state = first(manager, words(&["clear"]));
    let (pick, object) = state.act.pick.expect("sure enough to pick");
    let state = reply(manager, &state, called_off);
    assert_eq!(state.act.kind, ActKind::Cancel);
    let ended = Cause::PickEnded { pick, outcome: PickOutcome::Kept };
    let state = manager.next(&state, &ended, at(state.applied.0));
    assert_eq!((state.act.kind, state.act.pick), (ActKind::Say, None));
    assert_eq!(text(&state), ASKS);
    (state, pick, object)
}

fn assert_hands_over(manager: &mut Manager, state: &State, (before, object): (PickId, ObjectId)) {
    let (pick, ordered) = state.act.pick.expect("it is handed over");
    assert_eq!((state.act.kind, ordered), (ActKind::Pick, object));
    assert_eq!((pick.interaction, pick.attempt), (before.interaction, before.attempt + 1));
    assert_eq!(text(state), "All right.");
    let ended = manager.next(state, &delivered(pick), at(9));
    assert_eq!(ended.ended.expect("it has ended").outcome, Outcome::Delivered);
}

#[test]
fn a_yes_hands_over_the_kept_object() {
    let again = words(&["clear"]);
    for word in [answer(Response::Yes), again] {
        let mut manager = manager();
        let (state, pick, object) = kept(&mut manager, intent(Intent::Cancel));
        let yes = reply(&mut manager, &state, word);
        assert_hands_over(&mut manager, &yes, (pick, object));
    }
}

#[test]
fn nothing_else_is_ordered_while_an_object_is_kept() {
    let said = [
        answer(Response::No),
        intent(Intent::Cancel),
        intent(Intent::StartOver),
        intent(Intent::AskStatus),
        intent(Intent::Thank),
        words(&["metallic", "big"]),
        Reading { response: Response::No, ..words(&["metallic", "big"]) },
    ];
    for word in said {
        let mut manager = manager();
        let (state, pick, object) = kept(&mut manager, intent(Intent::Cancel));
        let after = reply(&mut manager, &state, word.clone());
        assert_eq!((after.act.kind, after.act.pick), (ActKind::Say, None), "{word:?}");
        assert!(text(&after).ends_with(ASKS), "{word:?}: {}", text(&after));
        let yes = reply(&mut manager, &after, answer(Response::Yes));
        assert_hands_over(&mut manager, &yes, (pick, object));
    }
}

#[test]
fn another_wish_counts_once_the_gripper_is_free() {
    let mut manager = manager();
    let instead = Reading { response: Response::No, ..words(&["metallic", "big"]) };
    let (state, _, object) = kept(&mut manager, instead);
    let yes = reply(&mut manager, &state, answer(Response::Yes));
    let (pick, _) = yes.act.pick.expect("it is handed over");
    let after = manager.next(&yes, &delivered(pick), at(9));
    assert!(text(&after).starts_with("Here is the clear bowl. "), "{}", text(&after));
    assert!(after.open.is_some() && belief(&after)[object.index()] < 1e-3);
}

#[test]
fn put_back_is_tried_again_and_ends_as_the_arm_says() {
    let mut manager = manager();
    let (state, pick, object) = kept(&mut manager, intent(Intent::Cancel));
    let again = remark(&mut manager, &state, intent(Intent::PutBack));
    let (retry, ordered) = again.act.pick.expect("it is tried again");
    assert_eq!(
        (again.act.kind, ordered, retry.attempt),
        (ActKind::Cancel, object, pick.attempt + 1)
    );
    assert_eq!(text(&again), "I am putting the clear bowl back.");
    let end = |outcome| Cause::PickEnded { pick: retry, outcome };
    let stays = manager.next(&again, &end(PickOutcome::Kept), at(9));
    assert_eq!(text(&stays), ASKS);
    let back = manager.next(&again, &end(PickOutcome::Cancelled), at(9));
    assert_eq!(back.ended.map(|ended| ended.outcome), Some(Outcome::Cancelled));
    assert!(back.open.is_none());
}

#[test]
fn a_yes_while_stopped_counts_after_the_release() {
    let mut manager = manager();
    let (state, pick, object) = kept(&mut manager, intent(Intent::Cancel));
    let stopped = manager.next(&state, &Cause::MotionStop(MotionStop::Stopped), at(8));
    let released = |manager: &mut Manager, state: &State| {
        manager.next(state, &Cause::MotionStop(MotionStop::Released), at(9))
    };
    assert_eq!(text(&released(&mut manager, &stopped)), ASKS);
    let yes = reply(&mut manager, &stopped, answer(Response::Yes));
    assert_eq!((yes.act.kind, yes.act.pick), (ActKind::Say, None));
    let state = released(&mut manager, &yes);
    assert_hands_over(&mut manager, &state, (pick, object));
}
