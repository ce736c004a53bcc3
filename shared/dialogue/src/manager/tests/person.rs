//! Knowledge about the person is kept from one interaction to the next.

use super::fixture::{
    Settings, answer, asked, at, heard, manager, reply, settings, settings_with, typed,
};
use super::people::talk;
use crate::manager::{Cause, Manager, State};
use scene::{Reading, Response};
use vocabulary::ids::PromptId;
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, PickOutcome};

pub(super) fn learning(settings: &mut Settings) {
    settings.planner = "information-seeking";
}

fn learning_manager() -> Manager {
    settings_with(learning).manager()
}

#[test]
fn a_user_who_errs_is_expected_to_err_in_the_next_interaction_too() {
    let mut manager = learning_manager();
    let (_, at_first) = manager.user_params(&manager.first()).unwrap();
    let mut expected = |errs: f64| {
        let mut state = manager.first();
        for seed in 0..12 {
            let talk = talk(&mut manager, &state, "", errs, seed);
            state = talk.last().expect("an end").state.clone();
        }
        manager.user_params(&state).expect("it learns").1
    };
    let careful = expected(0.0);
    let careless = expected(0.3);
    assert!(careful < at_first && careless > 3.0 * at_first, "{careful} {at_first} {careless}");
}

#[test]
fn silence_and_answers_are_counted_once_each() {
    let mut manager = learning_manager();
    let p_l = |manager: &Manager, state: &State| manager.user_params(state).unwrap().0;
    let state = asked(&mut manager);
    let first = p_l(&manager, &state);
    let silent = manager.next(&state, &Cause::Silence, at(9));
    assert!((p_l(&manager, &silent) - 19.0 / 21.0).abs() < 1e-12, "{}", p_l(&manager, &silent));
    let prompt = state.act.prompt;
    let once = manager.next(&state, &heard(2, prompt, answer(Response::Yes)), at(9));
    assert!((p_l(&manager, &once) - 20.0 / 21.0).abs() < 1e-12);
    let twice = manager.next(&once, &heard(3, prompt, answer(Response::Yes)), at(10));
    assert_eq!(p_l(&manager, &once), p_l(&manager, &twice), "the same question");
    let murmur = manager.next(&state, &heard(2, prompt, Reading::default()), at(9));
    assert_eq!(p_l(&manager, &murmur), first, "no answer, and no silence");
}

/// A restart with other settings scores the interaction again, and counts nothing twice.
#[test]
fn reconfiguration_learns_nothing_twice() {
    let mut manager = learning_manager();
    let mut state = asked(&mut manager);
    for seq in 2..5 {
        state = reply(&mut manager, &state, answer(Response::No));
        let again = manager.next(&state, &Cause::Reconfigured, at(seq));
        assert_eq!(again.open.as_ref().unwrap().posterior, state.open.as_ref().unwrap().posterior);
        assert_eq!(again.users.person, state.users.person);
    }
    // Another planner assumes people as configured, and keeps the knowledge for later.
    let plain = settings().manager().next(&state, &Cause::Reconfigured, at(20));
    assert!(plain.open.as_ref().unwrap().posterior.person().is_none());
    assert_eq!(plain.users.person, state.users.person);
    let back = manager.next(&plain, &Cause::Reconfigured, at(21));
    assert_eq!(back.open.unwrap().posterior, state.open.unwrap().posterior);
}

#[test]
fn other_planners_learn_nothing() {
    let mut manager = manager();
    let state = asked(&mut manager);
    let state = manager.next(&state, &Cause::Silence, at(9));
    assert_eq!((state.users.person.clone(), manager.user_params(&state)), (None, None));
    assert!(state.open.unwrap().posterior.person().is_none());
}

/// The manager and its state after answers that came `reaction_s` after each question.
fn acquainted(reaction_s: f64, answers: u64) -> (Manager, State) {
    let mut manager = learning_manager();
    let mut state = asked(&mut manager);
    for seq in 2..2 + answers {
        let mut said = typed(seq, state.act.prompt, answer(Response::Yes));
        said.presentations[0].began = Time(0);
        said.onset = Time(0) + Span::from_s(reaction_s);
        said.end = said.onset;
        state = manager.next(&state, &Cause::Utterance(said), at(seq));
        if state.act.kind != ActKind::Ask {
            let again = heard(seq + 1_000, PromptId(0), Reading::default());
            let (pick, _) = state.act.pick.expect("it picks");
            let outcome = PickOutcome::Delivered;
            state = manager.next(&state, &Cause::PickEnded { pick, outcome }, at(seq));
            state = manager.next(&state, &again, at(seq));
        }
    }
    (manager, state)
}

#[test]
fn the_response_window_follows_a_person_whose_answers_were_seen() {
    let window = |reaction_s: f64, answers: u64| {
        let (manager, state) = acquainted(reaction_s, answers);
        manager.response_window_s(&state)
    };
    let configured = settings().turns.response_window_s;
    assert_eq!(window(0.5, 3), configured, "not known yet");
    assert!(window(0.5, 12) < 0.6 * configured, "{}", window(0.5, 12));
    assert!(window(12.0, 12) > configured, "{}", window(12.0, 12));
    assert!(window(60.0, 40) <= 2.0 * configured);
}

/// A client that answers at once and then dies must find its question when it is started again.
#[test]
fn a_quick_person_is_not_given_up_sooner_than_configured() {
    let (mut manager, mut state) = acquainted(0.5, 40);
    let turns = settings().turns;
    let mut waited_s = 0.0;
    while state.open.is_some() {
        assert_eq!(state.act.kind, ActKind::Ask);
        waited_s += manager.response_window_s(&state);
        state = manager.next(&state, &Cause::Silence, at(1_000 + waited_s as u64));
    }
    let least = f64::from(turns.repeats_max) * turns.response_window_s;
    assert!(waited_s >= least, "given up after {waited_s} s, expected {least} s at least");
}
