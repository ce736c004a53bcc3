//! Requests for several objects.

use super::fixture::{answer, at, delivered, first, manager, remark, reply, settings, text, words};
use crate::manager::State;
use scene::{Intent, Reading, Response};
use vocabulary::{ActKind, Outcome};

fn request() -> Reading {
    let further = [&["big", "metallic"][..], &["white"]];
    Reading { further: further.map(|it| words(it).base).to_vec(), ..words(&["clear"]) }
}

fn picked(state: &State) -> String {
    settings().scene.object(state.act.pick.expect("a pick").1).name.clone()
}

#[test]
fn several_objects_are_fetched_in_turn() {
    let mut manager = manager();
    let state = first(&mut manager, request());
    assert_eq!(picked(&state), "clear");
    let line = text(&state);
    assert!(line.starts_with("First the clear bowl, then the "), "{line}");
    assert!(line.ends_with("I will get the clear bowl."), "{line}");
    let (pick, _) = state.act.pick.unwrap();
    let next = manager.next(&state, &delivered(pick), at(3));
    assert!(picked(&next).starts_with("metal"), "{}", picked(&next));
    assert!(text(&next).starts_with("Here is the clear bowl. I will get the "), "{}", text(&next));
    let ended = next.ended.as_ref().expect("the first has ended");
    assert_eq!((ended.outcome, ended.name.as_deref()), (Outcome::Delivered, Some("clear")));
    let (pick, _) = next.act.pick.unwrap();
    assert_eq!(pick.interaction, ended.interaction.next());
    let last = manager.next(&next, &delivered(pick), at(4));
    assert_eq!(last.act.kind, ActKind::Ask, "there are three white ones");
    assert!(last.queue.is_empty());
}

#[test]
fn a_request_that_is_withdrawn_is_withdrawn_whole() {
    let mut manager = manager();
    let state = first(&mut manager, request());
    let cancel = Reading { intent: Intent::Cancel, ..Reading::default() };
    let called_off = remark(&mut manager, &state, cancel);
    assert!(called_off.queue.is_empty());
    assert_eq!(called_off.act.kind, ActKind::Cancel);
}

/// Words of another object after a hand-over are the next request, though they do not fit as an
/// answer.
#[test]
fn the_next_request_is_no_refusal() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["clear"]));
    let (pick, _) = state.act.pick.unwrap();
    let end = manager.next(&state, &delivered(pick), at(2));
    let implied = Reading { response: Response::No, ..words(&["metallic", "big"]) };
    let next = reply(&mut manager, &end, implied);
    assert_eq!(next.ended.as_ref().map(|ended| ended.outcome), Some(Outcome::Delivered));
    assert!(!text(&next).contains("Sorry"), "{}", text(&next));
    assert!(picked(&next).starts_with("metal"));
    let refused = reply(&mut manager, &end, answer(Response::No));
    assert_eq!(refused.ended.map(|ended| ended.outcome), Some(Outcome::Refused));
}

/// "Two clear bowls", of which there is one.
#[test]
fn an_object_asked_for_twice_is_fetched_once() {
    let mut manager = manager();
    let twice = Reading { further: vec![words(&["clear"]).base], ..words(&["clear"]) };
    let state = first(&mut manager, twice);
    assert_eq!(picked(&state), "clear");
    assert!(state.queue.is_empty(), "{:?}", state.queue);
    assert_eq!(text(&state), "There is one: the clear bowl. I will get the clear bowl.");
}

#[test]
fn both_of_a_kind_are_fetched_without_a_question_about_the_second() {
    let mut manager = manager();
    let both = Reading { further: vec![words(&["metallic"]).base], ..words(&["metallic"]) };
    let mut state = first(&mut manager, both);
    while state.act.kind == ActKind::Ask {
        state = reply(&mut manager, &state, answer(Response::Yes));
    }
    let one = picked(&state);
    let (pick, _) = state.act.pick.unwrap();
    let next = manager.next(&state, &delivered(pick), at(9));
    let other = picked(&next);
    assert!(other != one && other.starts_with("metal"), "{one}, then {other}");
}
