//! After the hand-over: refusals, "the other one", "the same again".

use super::fixture::{
    answer, at, belief, delivered, first, heard, manager, remark, reply, settings,
};
use super::fixture::{text, words};
use crate::manager::{Cause, MotionStop, Record};
use crate::manager::{Manager, State, refold};
use scene::{Intent, Reading, Reference, Response};
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, Outcome};

fn refers(refers: Reference, said: &[&str]) -> Reading {
    Reading { refers, ..words(said) }
}

/// The state after that request was fulfilled at once, and the object's name.
fn handed_over(manager: &mut Manager, said: &[&str]) -> (State, String) {
    let state = first(manager, words(said));
    let (pick, object) = state.act.pick.expect("a unique description");
    let seq = state.applied.0 + 1;
    (manager.next(&state, &delivered(pick), at(seq)), settings().scene.object(object).name.clone())
}

fn picked(state: &State) -> String {
    settings().scene.object(state.act.pick.expect("a pick").1).name.clone()
}

#[test]
fn a_delivery_can_be_refused_and_does_not_come_again() {
    let mut manager = manager();
    let (end, name) = handed_over(&mut manager, &["white", "dishwasher"]);
    assert_eq!((name.as_str(), end.history.of("white")), ("white", 1));
    let refused = reply(&mut manager, &end, answer(Response::No));
    let ended = refused.ended.as_ref().expect("it has ended");
    assert_eq!((ended.outcome, ended.name.as_deref()), (Outcome::Refused, Some("white")));
    assert_eq!(refused.history.of("white"), 0, "it was not wanted");
    let open = refused.open.as_ref().expect("it goes on");
    assert_eq!(open.id, ended.interaction.next(), "a number has one delivery");
    assert!(text(&refused).starts_with("Sorry. "), "{}", text(&refused));
    let scene = settings().scene;
    let of = |state: &State, name: &str| belief(state)[scene.object_named(name).unwrap().index()];
    assert!(of(&refused, "white2") > of(&refused, "metal"), "what was said still counts");
    // Whatever is answered, it is not picked again.
    let mut state = refused;
    for n in 0..20 {
        assert!(of(&state, "white") < 1e-3, "{:?}", belief(&state));
        if state.act.kind != ActKind::Ask {
            break;
        }
        let response = if n % 2 == 0 { Response::Yes } else { Response::No };
        state = reply(&mut manager, &state, answer(response));
    }
    assert_ne!(picked(&state), "white");
}

#[test]
fn a_refusal_counts_for_a_while() {
    let mut manager = manager();
    let (end, _) = handed_over(&mut manager, &["clear"]);
    let window = Span::from_s(manager.turns().refusal_s);
    let handed_at = end.handed_over.as_ref().expect("a delivery").at;
    let no = |seq| heard(seq, end.act.prompt, answer(Response::No));
    let seq = end.applied.0 + 1;
    assert!(manager.next(&end, &no(seq), handed_at + window).open.is_some());
    let late = manager.next(&end, &no(seq), Time((handed_at + window).0 + 1));
    assert!(late.open.is_none() && late.handed_over.is_none());
    assert_eq!(late.ended.map(|ended| ended.outcome), Some(Outcome::Delivered));
}

#[test]
fn thanks_and_another_wish_are_no_refusals() {
    let mut manager = manager();
    let (end, _) = handed_over(&mut manager, &["clear"]);
    let thanks = Reading { intent: Intent::Thank, ..Reading::default() };
    let thanked = remark(&mut manager, &end, thanks);
    assert_eq!(text(&thanked), "You are welcome.");
    let agreed = reply(&mut manager, &end, answer(Response::Yes));
    assert_eq!((agreed.open.is_none(), text(&agreed).as_str()), (true, "All right."));
    // "Yes" means nothing without a question.
    let Cause::Utterance(mut yes) = heard(end.applied.0 + 1, end.act.prompt, answer(Response::Yes))
    else {
        unreachable!("an utterance")
    };
    yes.interpretations.last_mut().expect("for no question").reading = Reading::default();
    let agreed = manager.next(&end, &Cause::Utterance(yes), at(end.applied.0 + 1));
    assert_eq!((agreed.open.is_none(), text(&agreed).as_str()), (true, "All right."));
    let next = remark(&mut manager, &thanked, words(&["metallic"]));
    assert_eq!(next.ended.as_ref().map(|ended| ended.outcome), Some(Outcome::Delivered));
    assert!(next.handed_over.is_none(), "the next request ends the time for refusals");
    // Until then every line after the hand-over can be answered so.
    let refused = reply(&mut manager, &thanked, answer(Response::No));
    assert_eq!(refused.ended.map(|ended| ended.outcome), Some(Outcome::Refused));
}

#[test]
fn the_other_one_is_not_the_one_that_was_delivered() {
    let mut manager = manager();
    let (end, name) = handed_over(&mut manager, &["small", "metallic"]);
    let other = remark(&mut manager, &end, refers(Reference::Other, &["metallic"]));
    assert_ne!(picked(&other), name);
    assert!(picked(&other).starts_with("metal"), "{}", picked(&other));
    assert_eq!(other.ended.map(|ended| ended.outcome), Some(Outcome::Delivered));
    // Without words it is the one most like it.
    let (end, name) = handed_over(&mut manager, &["small", "metallic"]);
    let other = remark(&mut manager, &end, refers(Reference::Other, &[]));
    assert_ne!(picked(&other), name);
    assert!(picked(&other).starts_with("metal"), "{}", picked(&other));
}

#[test]
fn the_other_one_calls_off_the_fetch() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["white", "dishwasher"]));
    let other = remark(&mut manager, &fetching, refers(Reference::Other, &[]));
    assert_eq!(other.act.kind, ActKind::Cancel);
}

#[test]
fn the_same_again_is_the_one_delivered_last() {
    let mut manager = manager();
    let (end, name) = handed_over(&mut manager, &["clear"]);
    let thanks = Reading { intent: Intent::Thank, ..Reading::default() };
    let thanked = remark(&mut manager, &end, thanks);
    let again = remark(&mut manager, &thanked, refers(Reference::Same, &[]));
    assert_eq!(picked(&again), name);
}

#[test]
fn comparisons_are_resolved_among_the_objects_left() {
    let mut manager = manager();
    let scene = settings().scene;
    let volume = |name: &str| {
        let object = scene.object_named(name).unwrap();
        scene.object(object).placement.unwrap().size.iter().product::<f64>()
    };
    let larger = volume("metal2") > volume("metal");
    let (large, small) = if larger { ("metal2", "metal") } else { ("metal", "metal2") };
    for (refers_to, expected) in [
        (Reference::Smaller, small),
        (Reference::Smallest, small),
        (Reference::Larger, large),
        (Reference::Largest, large),
    ] {
        let asked = first(&mut manager, words(&["metallic"]));
        assert_eq!(asked.act.kind, ActKind::Ask);
        let state = remark(&mut manager, &asked, refers(refers_to, &[]));
        assert_eq!(picked(&state), expected, "{refers_to:?}");
        let at_once = first(&mut manager, refers(refers_to, &["metallic"]));
        assert_eq!(picked(&at_once), expected, "{refers_to:?}");
    }
}

/// All of it is in the journal.
#[test]
fn refusals_fold_again() {
    let mut manager = manager();
    let mut state = manager.first();
    let mut records = Vec::new();
    let mut step = |manager: &mut Manager, state: &mut State, cause: Cause| {
        let now = at(records.len() as u64 + 1);
        manager.step(state, &cause, now);
        records.push(Record { cause, at: now, state: state.clone() });
    };
    let clear = heard(1, state.act.prompt, words(&["clear"]));
    step(&mut manager, &mut state, clear);
    let (pick, _) = state.act.pick.expect("a pick");
    step(&mut manager, &mut state, delivered(pick));
    let no = heard(2, state.act.prompt, answer(Response::No));
    step(&mut manager, &mut state, no);
    step(&mut manager, &mut state, Cause::MotionStop(MotionStop::Stopped));
    let metal = heard(3, state.act.prompt, words(&["metallic", "big"]));
    step(&mut manager, &mut state, metal);
    let yes = heard(4, state.act.prompt, answer(Response::Yes));
    step(&mut manager, &mut state, yes);
    step(&mut manager, &mut state, Cause::MotionStop(MotionStop::Released));
    assert_eq!(state.act.kind, ActKind::Pick);
    refold(&mut manager, &records).unwrap();
}

/// In answer to the hand-over, other words are read as a no that is implied.
#[test]
fn the_other_one_in_answer_to_a_hand_over_refuses_nothing() {
    let mut manager = manager();
    let (end, name) = handed_over(&mut manager, &["small", "metallic"]);
    let implied = Reading { response: Response::No, ..refers(Reference::Other, &[]) };
    let other = reply(&mut manager, &end, implied);
    assert_ne!(picked(&other), name);
    assert_eq!(other.ended.map(|ended| ended.outcome), Some(Outcome::Delivered));
}
