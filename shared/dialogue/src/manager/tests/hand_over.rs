//! After the hand-over: the time for refusals and for putting back; the rest is in `conversations.txt`.

use super::fixture::{answer, at, delivered, first, heard, manager, remark, text, words};
use crate::manager::{Cause, Floor, Manager, State};
use scene::{Intent, Reading, Response};
use vocabulary::ids::PromptId;
use vocabulary::time::Span;
use vocabulary::{ActKind, Outcome};

/// The state after that request was fulfilled at once.
fn handed_over(manager: &mut Manager) -> State {
    let state = first(manager, words(&["clear"]));
    let (pick, _) = state.act.pick.expect("a unique description");
    manager.next(&state, &delivered(pick), at(state.applied.0 + 1))
}

fn put_back() -> Reading {
    Reading { intent: Intent::PutBack, ..Reading::default() }
}

/// An utterance that is this reading as an answer, and that one otherwise.
fn answers(state: &State, answer: Reading, otherwise: Reading) -> Cause {
    let Cause::Utterance(mut said) = heard(state.applied.0 + 1, state.act.prompt, answer) else {
        unreachable!("an utterance")
    };
    said.interpretations.last_mut().expect("for no question").reading = otherwise;
    Cause::Utterance(said)
}

#[test]
fn a_refusal_counts_for_a_while() {
    let mut manager = manager();
    let end = handed_over(&mut manager);
    let until =
        end.handed_over.as_ref().expect("a delivery").at + Span::from_s(manager.turns().refusal_s);
    let no = heard(end.applied.0 + 1, end.act.prompt, answer(Response::No));
    assert!(manager.next(&end, &no, until).open.is_some());
    let late = manager.next(&end, &no, until + Span(1));
    assert!(late.open.is_none() && late.handed_over.is_none());
    assert_eq!(late.ended.map(|ended| ended.outcome), Some(Outcome::Delivered));
    let back = heard(end.applied.0 + 1, PromptId(0), put_back());
    assert_eq!(manager.next(&end, &back, until).act.kind, ActKind::PutBack);
    let late = manager.next(&end, &back, until + Span::from_ms(1));
    assert_eq!(text(&late), "I have nothing to put back.");
    assert_eq!(late.ended.map(|ended| ended.outcome), Some(Outcome::Delivered));
}

#[test]
fn a_yes_means_nothing_without_a_question() {
    let mut manager = manager();
    let end = handed_over(&mut manager);
    let yes = answers(&end, answer(Response::Yes), Reading::default());
    let agreed = manager.next(&end, &yes, at(end.applied.0 + 1));
    assert_eq!((agreed.open.is_none(), text(&agreed).as_str()), (true, "All right."));
}

/// A user who answers "Here is the clear bowl." with "put it back" does not merely deny it.
#[test]
fn the_wish_to_put_back_is_no_mere_denial() {
    let mut manager = manager();
    let end = handed_over(&mut manager);
    let said = answers(&end, answer(Response::No), put_back());
    assert_eq!(manager.next(&end, &said, at(9)).act.kind, ActKind::PutBack);
}

#[test]
fn no_decision_is_due_while_an_object_is_put_back() {
    let mut manager = manager();
    let end = handed_over(&mut manager);
    let state = remark(&mut manager, &end, put_back());
    let asked = remark(&mut manager, &state, words(&["clear"]));
    assert!(!manager.quiet_is_due(&asked, &Floor::default(), at(99)));
}
