//! Picks that are decided while the motion stop is latched.

use super::fixture::{answer, at, first, manager, remark, reply, text, words};
use crate::manager::{Cause, Manager, MotionStop, State};
use scene::{Intent, Reading, Response};
use vocabulary::ActKind;

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
    assert_eq!(text(&state), "I stay stopped until you resume. Shall I get the clear bowl then?");
    let resumed = resume(&mut manager, &state);
    assert_eq!((resumed.act.kind, resumed.act.pick), (ActKind::Say, None), "{}", text(&resumed));
    let confirmed = reply(&mut manager, &resumed, answer(Response::Yes));
    assert_eq!(confirmed.act.kind, ActKind::Pick);
    assert_eq!(text(&confirmed), "I will get the clear bowl.");
    // A repetition means it, too.
    let again = remark(&mut manager, &resumed, words(&["clear"]));
    assert_eq!(again.act.kind, ActKind::Pick);
}

#[test]
fn a_pick_confirmed_while_stopped_starts_with_the_release() {
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
fn a_pick_denied_or_withdrawn_while_stopped_does_not_start() {
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

/// A pick ordered before the stop continues with the release, as the operator wishes.
#[test]
fn a_stop_changes_no_order() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["clear"]));
    let stop = manager.next(&state, &Cause::MotionStop(MotionStop::Stopped), at(2));
    assert_eq!(stop.act, state.act);
    assert_eq!(resume(&mut manager, &stop).act, state.act);
}

/// How to resume: words do not.
const STILL_STOPPED: &str =
    "The motion stop is on. Press Resume on the page, or run: whichone resume-motion";

#[test]
fn words_to_go_on_are_told_how_to_resume() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["clear"]));
    let go_on = |response| Reading { intent: Intent::GoOn, response, ..Reading::default() };
    let ask = Reading { intent: Intent::AskStatus, ..Reading::default() };
    let stopped = manager.next(&fetching, &Cause::MotionStop(MotionStop::Stopped), at(0));
    for reading in [
        go_on(Response::None),
        go_on(Response::Yes),
        go_on(Response::No),
        answer(Response::Yes),
        ask,
    ] {
        let after = reply(&mut manager, &stopped, reading.clone());
        assert_eq!(text(&after), STILL_STOPPED, "{reading:?}");
        assert_eq!((after.act.kind, after.act.pick), (ActKind::Pick, fetching.act.pick));
        assert!(after.stop.motion.is_latched());
    }
    // At rest, too.
    let idle = manager.next(&manager.first(), &Cause::MotionStop(MotionStop::Stopped), at(0));
    let after = remark(&mut manager, &idle, go_on(Response::None));
    assert_eq!(text(&after), STILL_STOPPED);
}

#[test]
fn words_to_go_on_mean_what_they_did_where_nothing_is_stopped() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["clear"]));
    for response in [Response::None, Response::Yes, Response::No] {
        let go_on = Reading { intent: Intent::GoOn, response, ..Reading::default() };
        let intent = if response == Response::None { Intent::None } else { Intent::Inform };
        let as_before = reply(&mut manager, &fetching, Reading { intent, ..go_on.clone() });
        let after = reply(&mut manager, &fetching, go_on);
        assert_eq!((after.act, after.open), (as_before.act, as_before.open), "{response:?}");
    }
}

#[test]
fn yes_go_on_confirms_a_pick_that_waits_for_the_release() {
    let mut manager = manager();
    let state = stopped(&mut manager, &["clear"]);
    let yes = Reading { intent: Intent::GoOn, ..answer(Response::Yes) };
    let confirmed = reply(&mut manager, &state, yes);
    assert_eq!(text(&confirmed), "All right, once you resume.");
}

/// "Yes, the big metallic one" does not confirm the clear one.
#[test]
fn a_yes_with_words_of_another_object_confirms_nothing() {
    let mut manager = manager();
    let state = stopped(&mut manager, &["clear"]);
    let other = Reading { response: Response::Yes, ..words(&["metallic", "big"]) };
    let after = reply(&mut manager, &state, other);
    assert_ne!(text(&after), "All right, once you resume.");
    assert_ne!(resume(&mut manager, &after).act.kind, ActKind::Pick);
}

#[test]
fn the_release_ends_the_wait_for_the_report_of_a_stop() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["clear"]));
    let stop = Reading { intent: Intent::Stop, ..Reading::default() };
    let ordered = remark(&mut manager, &fetching, stop);
    assert!(ordered.stop.order.is_some());
    let stopping = manager.next(&ordered, &Cause::MotionStop(MotionStop::Stopping), at(3));
    assert!(stopping.stop.order.is_some(), "it is not at rest yet");
    assert_eq!(resume(&mut manager, &stopping).stop.order, None);
}
