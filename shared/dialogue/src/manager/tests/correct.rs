//! Utterances while the arm fetches; most are in `conversations.txt`.

use super::fixture::{answer, at, first, manager, remark, typed, words};
use crate::manager::Cause;
use scene::{Doubt, Reading, Response};

/// The answer arrives while the robot has hardly begun to announce the object.
#[test]
fn a_late_no_to_the_question_before_denies_nothing() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["white", "dishwasher"]));
    let mut late = typed(2, state.act.prompt, answer(Response::No));
    (late.typed, late.presentations[0].ended, late.presentations[0].complete) =
        (false, None, false);
    late.onset = late.presentations[0].began;
    let after = manager.next(&state, &Cause::Utterance(late), at(2));
    assert_eq!(after.act, state.act);
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
