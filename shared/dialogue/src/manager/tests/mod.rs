//! The manager's rules, on the shipped six bowls.

mod concede;
mod conversations;
mod correct;
mod fixture;
mod fold;
mod hand_over;
mod held_back;
mod long;
mod misfit;
mod people;
mod person;
mod reconfigure;
mod replies;
mod seconds;
mod turns;
mod words;

use super::{Cause, State};
use fixture::{answer, asked, at, belief, heard, manager, reply, settings, settings_with};
use scene::{ObjectId, Question, Response};
use vocabulary::Outcome;
use vocabulary::ids::{PromptId, UtteranceSeq};

#[test]
fn a_late_answer_is_scored_against_the_question_that_was_heard() {
    let mut manager = settings_with(|it| it.misperception = 0.0).manager();
    let first = asked(&mut manager);
    let second = reply(&mut manager, &first, answer(Response::Yes));
    assert_ne!(second.act.question, first.act.question, "another question stands now");
    // Said before the second question was heard: it can only be meant for the first.
    let late = manager.next(&second, &heard(3, first.act.prompt, answer(Response::Yes)), at(3));
    let Question::Attribute(k, v) = first.act.question else { panic!("{:?}", first.act) };
    let scene = settings().scene;
    let mass = |state: &State| -> f64 {
        let has = |i: &usize| scene.has(ObjectId::from(*i), k, v);
        belief(state).iter().enumerate().filter(|(i, _)| has(i)).map(|(_, p)| p).sum()
    };
    assert!(mass(&late) > mass(&second), "the first question's value gains once more");
    assert_eq!(late.act.prompt, second.act.prompt, "the unheard question is not said again");
}

#[test]
fn an_answer_to_nothing_begins_nothing() {
    let mut manager = manager();
    let state =
        manager.next(&manager.first(), &heard(1, PromptId(5), answer(Response::Yes)), at(1));
    assert_eq!((state.open, state.applied), (None, UtteranceSeq(1)));
}

#[test]
fn an_answer_to_another_interaction_s_question_changes_no_belief() {
    let mut manager = manager();
    let state = asked(&mut manager);
    let stale = PromptId(state.act.prompt.0 + 70);
    let after = manager.next(&state, &heard(2, stale, answer(Response::No)), at(2));
    assert_eq!(belief(&state), belief(&after));
}

#[test]
fn silence_repeats_the_same_question_and_then_ends_the_interaction() {
    let mut manager = manager();
    let mut state = asked(&mut manager);
    let first = state.act.clone();
    for n in 1..=manager.turns().repeats_max {
        state = manager.next(&state, &Cause::Silence, at(10 * u64::from(n)));
        assert_eq!((state.act.prompt, state.act.presentation), (first.prompt, 1 + n));
        assert_eq!(state.open.as_ref().map(|open| open.questions), Some(1));
    }
    state = manager.next(&state, &Cause::Silence, at(100));
    assert_eq!(state.ended.map(|ended| ended.outcome), Some(Outcome::Abandoned));
}
