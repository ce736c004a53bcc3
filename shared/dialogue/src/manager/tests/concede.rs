//! "I do not know", "it does not matter", "any".

use super::fixture::{
    answer, at, belief, delivered, first, manager, remark, reply, settings, text, typed, words,
};
use crate::manager::{Cause, Manager, State};
use scene::{AttributeId, ObjectId, Question, Reading, Reference, Response};
use vocabulary::ids::PromptId;
use vocabulary::{ActKind, Interpretation};

fn asked_about(state: &State) -> Option<AttributeId> {
    state.act.question.attribute()
}

fn any(said: &[&str]) -> Reading {
    Reading { response: Response::DoesNotMatter, ..words(said) }
}

/// Answers truthfully for the object until the robot picks; returns the attributes asked about.
fn until_pick(manager: &mut Manager, mut state: State, wanted: &str) -> (State, Vec<AttributeId>) {
    let scene = settings().scene;
    let object = scene.object_named(wanted).unwrap();
    let mut asked = Vec::new();
    while state.act.kind == ActKind::Ask {
        let holds = match state.act.question {
            Question::Attribute(k, v) => {
                asked.push(k);
                scene.has(object, k, v)
            }
            Question::Point(offered) => offered == object,
            other => panic!("{other:?}"),
        };
        let response = if holds { Response::Yes } else { Response::No };
        state = reply(manager, &state, answer(response));
    }
    (state, asked)
}

#[test]
fn an_attribute_that_the_user_cannot_tell_is_not_asked_about_again() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["white"]));
    let k = asked_about(&state).expect("a question");
    let before = belief(&state);
    let after = reply(&mut manager, &state, answer(Response::CannotTell));
    assert_eq!(belief(&after), before, "it says nothing about the object");
    let (end, asked) = until_pick(&mut manager, after, "white3");
    assert!(!asked.contains(&k) && end.act.kind == ActKind::Pick, "{asked:?}");
}

/// If nothing else distinguishes them, they are named, one is offered, and it is taken only if the
/// user again does not know.
#[test]
fn objects_that_the_user_cannot_tell_apart_are_named() {
    let mut manager = manager();
    let mut state = first(&mut manager, words(&["metallic"]));
    let mut offers = Vec::new();
    while state.act.kind == ActKind::Ask {
        if let Question::Point(offered) = state.act.question {
            let line = text(&state);
            let named = line.starts_with("There are two: the ") && line.ends_with('?');
            assert!(named && line.contains("Do you want the "), "{line}");
            offers.push(offered);
        }
        state = reply(&mut manager, &state, answer(Response::CannotTell));
    }
    assert_eq!(offers, [state.act.pick.expect("a pick").1]);
    let line = text(&state);
    assert!(line.starts_with("There are two: the ") && line.contains("I will take the"), "{line}");
    let scene = settings().scene;
    let name = &scene.object(state.act.pick.expect("a pick").1).name;
    assert!(["metal", "metal2"].contains(&name.as_str()), "{name}");
}

/// Words that tell nothing new, such as a late answer to another question, are not consent.
#[test]
fn an_offer_that_is_not_answered_is_repeated_and_not_taken() {
    let mut manager = manager();
    let mut state = first(&mut manager, words(&["metallic"]));
    while !matches!(state.act.question, Question::Point(_)) {
        state = reply(&mut manager, &state, answer(Response::CannotTell));
    }
    let offered = state.act.question;
    let again = reply(&mut manager, &state, words(&["metallic"]));
    assert_eq!((again.act.kind, again.act.question), (ActKind::Ask, offered), "{}", text(&again));
    let taken = reply(&mut manager, &again, answer(Response::CannotTell));
    assert_eq!(taken.act.kind, ActKind::Pick, "{}", text(&taken));
}

#[test]
fn an_attribute_that_does_not_matter_is_not_asked_about_and_any_of_it_is_right() {
    let mut manager = manager();
    let mut state = first(&mut manager, words(&["metallic"]));
    let mut questions = Vec::new();
    while state.act.kind == ActKind::Ask {
        questions.push(asked_about(&state));
        state = reply(&mut manager, &state, answer(Response::DoesNotMatter));
    }
    let all = questions.len();
    questions.dedup();
    assert_eq!((questions.len(), state.act.kind), (all, ActKind::Pick));
    assert!(text(&state).starts_with("I will get the"), "{}", text(&state));
}

#[test]
fn a_user_who_wants_any_gets_one_at_once() {
    let mut manager = manager();
    let scene = settings().scene;
    let of = |state: &State| scene.object(state.act.pick.expect("a pick").1).name.clone();
    let any_white = first(&mut manager, any(&["white"]));
    assert!(of(&any_white).starts_with("white"));
    let asked = first(&mut manager, words(&["metallic"]));
    let any_metallic = reply(&mut manager, &asked, any(&["metallic"]));
    assert!(of(&any_metallic).starts_with("metal"));
    let nothing = manager.first();
    let no_request = remark(&mut manager, &nothing, any(&[]));
    assert_eq!((no_request.open.is_none(), no_request.act.kind), (true, ActKind::Say));
}

/// Concessions are kept by names, and until the end of the interaction only.
#[test]
fn concessions_end_with_the_interaction() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["white"]));
    let k = asked_about(&state).expect("a question");
    let after = reply(&mut manager, &state, answer(Response::CannotTell));
    let name = settings().scene.attributes()[k.index()].name.clone();
    assert_eq!(after.open.as_ref().unwrap().conceded.unknown, [name]);
    let (end, _) = until_pick(&mut manager, after, "white");
    let (pick, _): (_, ObjectId) = end.act.pick.expect("a pick");
    let seq = end.applied.0 + 1;
    let ended: Cause = delivered(pick);
    let rest = manager.next(&end, &ended, at(seq));
    let again = remark(&mut manager, &rest, words(&["white"]));
    assert_eq!(asked_about(&again), Some(k));
}

#[test]
fn any_in_answer_to_a_question_is_about_the_object() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["metallic"]));
    assert_eq!(state.act.kind, ActKind::Ask);
    let any = Reading { refers: Reference::Any, ..answer(Response::DoesNotMatter) };
    assert_eq!(reply(&mut manager, &state, any).act.kind, ActKind::Pick);
}

/// "The white one or the clear one, I don't mind."
#[test]
fn readings_that_concede_the_same_concede_it_together() {
    let mut manager = manager();
    let mut said = typed(1, PromptId(0), Reading::default());
    let wordings = ["white", "clear"].map(|word| any(&[word]));
    let as_likely = |reading| Interpretation { weight: 0.5, answers: None, reading };
    said.interpretations = wordings.map(as_likely).to_vec();
    let state = manager.next(&manager.first(), &Cause::Utterance(said), at(1));
    assert_eq!(state.act.kind, ActKind::Pick, "{}", text(&state));
}
