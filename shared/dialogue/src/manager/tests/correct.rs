//! Utterances while the arm fetches.

use super::fixture::{
    answer, at, belief, delivered, first, manager, remark, reply, settings, text, typed, words,
};
use crate::manager::{Cause, Manager, State};
use scene::{Doubt, Intent, ObjectId, Reading, Response};
use vocabulary::ids::PickId;
use vocabulary::{ActKind, Outcome, PickOutcome};

/// A state in which an object is fetched, and which.
fn fetching(manager: &mut Manager) -> (State, PickId, ObjectId) {
    let request = words(&["white", "dishwasher"]);
    let state = first(manager, request);
    let (pick, object) = state.act.pick.expect("sure enough to pick");
    (state, pick, object)
}

fn left(pick: PickId) -> Cause {
    Cause::PickEnded { pick, outcome: PickOutcome::Cancelled }
}

#[test]
fn a_denial_calls_the_pick_off_and_the_words_before_it_still_count() {
    let mut manager = manager();
    let (state, pick, object) = fetching(&mut manager);
    let denied = reply(&mut manager, &state, answer(Response::No));
    assert_eq!((denied.act.kind, denied.act.pick), (ActKind::Cancel, Some((pick, object))));
    let after = manager.next(&denied, &left(pick), at(3));
    let open = after.open.as_ref().expect("the interaction goes on");
    assert_eq!((open.id, open.evidence.len()), (pick.interaction, 3));
    let before = belief(&state)[object.index()];
    assert!(belief(&after)[object.index()] < 0.5 * before, "{:?}", belief(&after));
    // White ones are still likelier than any that were never mentioned, and the denied one is not.
    let scene = settings().scene;
    let of = |name: &str| belief(&after)[scene.object_named(name).unwrap().index()];
    assert!(of("white2") > of("metal2") && of("metal2") > belief(&after)[object.index()]);
    assert_eq!((after.act.kind, after.act.pick), (ActKind::Ask, None));
}

#[test]
fn the_next_pick_has_a_key_of_its_own() {
    let mut manager = manager();
    let (state, pick, object) = fetching(&mut manager);
    let wanted = Reading { response: Response::No, ..words(&["metallic"]) };
    let denied = reply(&mut manager, &state, wanted);
    let mut after = manager.next(&denied, &left(pick), at(3));
    assert_eq!(after.act.kind, ActKind::Ask);
    let more = words(&["metallic", "big"]);
    after = remark(&mut manager, &after, more);
    let (next, other) = after.act.pick.expect("sure again");
    assert_eq!((next.interaction, next.attempt), (pick.interaction, 2));
    assert_ne!(other, object);
    let ended = manager.next(&after, &delivered(next), at(5)).ended.expect("it has ended");
    assert_eq!((ended.object, ended.outcome), (Some(other), Outcome::Delivered));
}

#[test]
fn another_object_named_in_full_is_fetched_without_a_question() {
    let mut manager = manager();
    let (state, pick, _) = fetching(&mut manager);
    let changed = remark(&mut manager, &state, words(&["clear"]));
    assert_eq!(changed.act.kind, ActKind::Cancel);
    let after = manager.next(&changed, &left(pick), at(3));
    let (_, next) = after.act.pick.expect("nothing to ask");
    assert_eq!(settings().scene.object(next).name, "clear");
}

#[test]
fn an_object_ruled_out_in_words_is_denied_too() {
    let mut manager = manager();
    let (state, ..) = fetching(&mut manager);
    let group = words(&["small", "white"]).base;
    let not_this = Reading { excluded: vec![group], ..Reading::default() };
    let denied = remark(&mut manager, &state, not_this);
    assert_eq!(denied.act.kind, ActKind::Cancel);
    let group = words(&["clear"]).base;
    let not_another = Reading { excluded: vec![group], ..Reading::default() };
    let goes_on = remark(&mut manager, &state, not_another);
    assert_eq!((goes_on.act.kind, goes_on.act.pick), (state.act.kind, state.act.pick));
}

#[test]
fn words_that_fit_or_are_about_something_else_leave_the_arm_alone() {
    let mut manager = manager();
    let (state, ..) = fetching(&mut manager);
    // A "no" without a preceding line of the robot is not about the object being fetched.
    let readings = [
        answer(Response::Yes),
        answer(Response::No),
        words(&["white"]),
        Reading { intent: Intent::None, ..Reading::default() },
    ];
    for reading in readings {
        let after = remark(&mut manager, &state, reading);
        assert_eq!((after.act.kind, after.act.pick), (state.act.kind, state.act.pick));
        assert!(belief(&after).iter().zip(belief(&state)).all(|(a, b)| (a - b).abs() < 0.05));
    }
}

#[test]
fn words_that_make_it_unlikely_call_it_off_without_a_no() {
    let mut manager = manager();
    let (state, ..) = fetching(&mut manager);
    let other =
        words(&["clear", "clear", "clear", "counter", "counter", "counter", "big", "clear"]);
    let after = remark(&mut manager, &state, other);
    assert_eq!(after.act.kind, ActKind::Cancel);
}

/// The answer arrives while the robot has hardly begun to announce the object.
#[test]
fn a_late_no_to_the_question_before_denies_nothing() {
    let mut manager = manager();
    let (state, ..) = fetching(&mut manager);
    let mut late = typed(2, state.act.prompt, answer(Response::No));
    (late.typed, late.presentations[0].ended, late.presentations[0].complete) =
        (false, None, false);
    late.onset = late.presentations[0].began;
    let after = manager.next(&state, &Cause::Utterance(late), at(2));
    assert_eq!(after.act, state.act);
}

/// The fingers had begun to open.
#[test]
fn an_object_that_has_arrived_already_is_handed_over() {
    let mut manager = manager();
    let (state, pick, object) = fetching(&mut manager);
    let denied = reply(&mut manager, &state, answer(Response::No));
    let after = manager.next(&denied, &delivered(pick), at(3));
    let ended = after.ended.as_ref().expect("it has ended");
    assert_eq!((ended.object, ended.outcome), (Some(object), Outcome::Refused));
    let said = text(&after);
    assert!(
        said.starts_with("It was too late to leave the ") && said.contains("Here it is. "),
        "{said}"
    );
    let open = after.open.as_ref().expect("another one is wanted");
    assert!(open.belief().probability(object) < 1e-3);
}

#[test]
fn an_object_not_wanted_any_more_is_handed_over_with_these_words() {
    let mut manager = manager();
    let (state, pick, _) = fetching(&mut manager);
    let never_mind = Reading { intent: Intent::Cancel, ..Reading::default() };
    let withdrawn = remark(&mut manager, &state, never_mind);
    let after = manager.next(&withdrawn, &delivered(pick), at(3));
    let said = text(&after);
    assert!(said.starts_with("It was too late to leave the "), "{said}");
    assert!(after.open.is_none());
}

#[test]
fn a_user_who_wants_nothing_any_more_after_a_denial_gets_nothing() {
    let mut manager = manager();
    let (state, pick, _) = fetching(&mut manager);
    let denied = reply(&mut manager, &state, answer(Response::No));
    let never_mind = Reading { intent: Intent::Cancel, ..Reading::default() };
    let withdrawn = remark(&mut manager, &denied, never_mind);
    assert_eq!((withdrawn.act.kind, withdrawn.act.pick), (denied.act.kind, denied.act.pick));
    let ended = manager.next(&withdrawn, &left(pick), at(4));
    assert!(ended.open.is_none());
    assert_eq!(ended.ended.map(|ended| ended.outcome), Some(Outcome::Cancelled));
}

/// Only if they are certain: a possibly misheard word replaces nothing.
#[test]
fn words_replace_those_of_the_same_attribute_where_they_are_certain() {
    let remembers_white = |doubt: Doubt| {
        let mut manager = manager();
        let state = first(&mut manager, words(&["white"]));
        let after = remark(&mut manager, &state, Reading { doubt, ..words(&["metallic"]) });
        let evidence = &after.open.as_ref().expect("an open interaction").evidence;
        let mut said = evidence.iter().flat_map(|it| &it.interpretations);
        said.any(|(.., reading)| reading.base.iter().any(|word| word == "white"))
    };
    assert!(!remembers_white(Doubt::default()));
    assert!(remembers_white(Doubt { base: vec![0.3], ..Doubt::default() }));
}

/// The user has it, and named another one before it arrived.
#[test]
fn an_object_that_came_too_late_is_not_fetched_again() {
    let mut manager = manager();
    let (state, pick, object) = fetching(&mut manager);
    let changed = remark(&mut manager, &state, words(&["clear"]));
    let after = manager.next(&changed, &delivered(pick), at(3));
    assert_ne!(after.act.pick.expect("the clear one").1, object);
    let again = remark(&mut manager, &after, words(&["white", "dishwasher"]));
    assert!(belief(&again)[object.index()] < 1e-3, "{:?}", belief(&again));
}
