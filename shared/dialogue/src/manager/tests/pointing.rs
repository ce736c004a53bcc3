//! Gestures: evidence about the object, and nothing else.

use super::fixture::{
    Settings, answer, asked, at, belief, manager, remark, settings, settings_with, typed, words,
};
use crate::manager::{Cause, Manager, Utterance};
use scene::{Intent, Reading, Response};
use vocabulary::ids::{PromptId, UtteranceSeq};

pub(super) fn with_gestures(settings: &mut Settings) {
    settings.gestures = true;
}

fn pointing_manager() -> Manager {
    settings_with(with_gestures).manager()
}

fn place(bowl: &str) -> [f64; 3] {
    let scene = settings().scene;
    scene.object(scene.object_named(bowl).unwrap()).placement.unwrap().xyz
}

/// An utterance with a gesture towards a bowl.
fn shown(seq: u64, prompt: PromptId, reading: Reading, bowl: &str) -> Cause {
    Cause::Utterance(Utterance { gesture: Some(place(bowl)), ..typed(seq, prompt, reading) })
}

#[test]
fn a_gesture_alone_opens_an_interaction_and_favours_what_it_points_at() {
    let mut manager = pointing_manager();
    for (i, bowl) in settings().scene.objects().iter().enumerate() {
        let cause = shown(1, PromptId(0), Reading::default(), &bowl.name);
        let state = manager.next(&manager.first(), &cause, at(1));
        let belief = belief(&state);
        let best = belief.iter().copied().fold(0.0, f64::max);
        assert!(belief[i] == best && best > 1.0 / 6.0, "{}: {belief:?}", bowl.name);
    }
}

#[test]
fn a_gesture_is_no_answer_but_an_answer_with_it_counts() {
    let mut manager = pointing_manager();
    let state = asked(&mut manager);
    let prompt = state.act.prompt;
    let shown_only = manager.next(&state, &shown(2, prompt, Reading::default(), "clear"), at(2));
    // The same evidence without any question standing: nothing was taken from the question.
    let cause = shown(1, PromptId(0), Reading::default(), "clear");
    assert_eq!(belief(&shown_only), belief(&manager.next(&manager.first(), &cause, at(1))));
    let answered = manager.next(&state, &shown(2, prompt, answer(Response::Yes), "clear"), at(2));
    assert_ne!(belief(&answered), belief(&shown_only));
}

#[test]
fn words_that_name_nothing_do_not_hide_the_hand() {
    let mut manager = pointing_manager();
    let deictic = Reading { intent: Intent::None, ..Reading::default() };
    let cause = shown(1, PromptId(0), deictic, "white3");
    assert!(manager.next(&manager.first(), &cause, at(1)).open.is_some());
    let refused = Reading { intent: Intent::Cancel, ..Reading::default() };
    let cause = shown(1, PromptId(0), refused, "white3");
    assert!(manager.next(&manager.first(), &cause, at(1)).open.is_none());
}

/// A wrong gesture is made up for by words about the object.
#[test]
fn a_far_off_gesture_is_outvoted() {
    let mut manager = pointing_manager();
    let cause = shown(1, PromptId(0), Reading::default(), "white");
    let state = manager.next(&manager.first(), &cause, at(1));
    let state = remark(&mut manager, &state, words(&["metallic", "big", "counter"]));
    let metal2 = settings().scene.object_named("metal2").unwrap();
    assert_eq!(state.open.unwrap().belief().most_likely(), metal2);
}

#[test]
fn gestures_change_nothing_where_they_do_not_count_and_words_with_them_do() {
    let mut manager = manager();
    let alone = shown(1, PromptId(0), Reading::default(), "clear");
    let state = manager.next(&manager.first(), &alone, at(1));
    assert_eq!((&state.open, state.applied), (&None, UtteranceSeq(1)));
    let said = words(&["white"]);
    let with = manager.next(&state, &shown(2, PromptId(0), said.clone(), "clear"), at(2));
    let without = remark(&mut manager, &state, said);
    assert_eq!(belief(&with), belief(&without));
}
