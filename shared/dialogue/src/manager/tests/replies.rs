//! Every text that is typed gets an answer, and no question comes twice in the same words.

use super::fixture::{answer, at, first, heard, manager, remark, reply, text, typed, words};
use crate::manager::{Cause, Manager, State, Utterance};
use scene::{Intent, Reading, Response, Role, UnknownWord};
use vocabulary::ActKind;
use vocabulary::ids::PromptId;

fn intent(intent: Intent) -> Reading {
    Reading { intent, ..Reading::default() }
}

fn about(intent: Intent, said: &[&str]) -> Reading {
    Reading { intent, ..words(said) }
}

/// All talk but stops, whose effect the arm reports first.
const TALK: [Intent; 16] = [
    Intent::None,
    Intent::Cancel,
    Intent::Repeat,
    Intent::StartOver,
    Intent::AskBack,
    Intent::AskCount,
    Intent::AskWhich,
    Intent::AskWhether,
    Intent::AskWhere,
    Intent::AskWhy,
    Intent::AskStatus,
    Intent::AskHelp,
    Intent::Greet,
    Intent::Thank,
    Intent::Chore,
    Intent::GoOn,
];

fn cancels(intent: Intent) -> bool {
    matches!(intent, Intent::Cancel | Intent::StopAndCancel)
}

/// At rest, with a pending question, while the arm fetches, and while a pick is cancelled.
fn situations(manager: &mut Manager) -> Vec<State> {
    let rest = manager.first();
    let asking = first(manager, words(&["white"]));
    let fetching = first(manager, words(&["clear"]));
    let leaving = reply(manager, &fetching, answer(Response::No));
    vec![rest, asking, fetching, leaving]
}

#[test]
fn everything_typed_is_answered() {
    let mut manager = manager();
    for state in situations(&mut manager) {
        let talk = TALK.into_iter().map(intent);
        // A question under way answers the remark about the object.
        let said = (state.act.kind != ActKind::Ask).then(|| answer(Response::Yes));
        for reading in talk.chain([intent(Intent::PutBack)]).chain(said) {
            let after = remark(&mut manager, &state, reading.clone());
            let said = (after.act.prompt, after.act.presentation);
            assert_ne!(said, (state.act.prompt, state.act.presentation), "{reading:?}");
            assert!(!text(&after).is_empty(), "{:?} {reading:?}", state.act.kind);
        }
    }
}

/// The arm's order remains valid whatever is said about other things.
#[test]
fn an_answer_changes_no_order() {
    let mut manager = manager();
    let [_, _, fetching, leaving] = &situations(&mut manager)[..] else { panic!("four") };
    for state in [fetching, leaving] {
        for it in TALK.into_iter().filter(|it| !cancels(*it)) {
            let after = remark(&mut manager, state, intent(it));
            assert_eq!(
                (after.act.kind, after.act.pick),
                (state.act.kind, state.act.pick),
                "{it:?}"
            );
            let open = after.open.as_ref().expect("it goes on");
            assert_eq!(Some(open.belief()), state.open.as_ref().map(|open| open.belief()));
        }
    }
    // Its announcement can be denied whatever was said since.
    let thanked = remark(&mut manager, fetching, intent(Intent::Thank));
    assert_eq!(text(&thanked), "You are welcome.");
    let seq = thanked.applied.0 + 1;
    for prompt in [fetching.act.prompt, thanked.act.prompt] {
        let denial = heard(seq, prompt, answer(Response::No));
        assert_eq!(manager.next(&thanked, &denial, at(seq)).act.kind, ActKind::Cancel);
    }
}

#[test]
fn talk_that_is_not_meant_for_the_robot_stays_unanswered() {
    let mut manager = manager();
    for state in situations(&mut manager) {
        let seq = state.applied.0 + 1;
        let mut said = typed(seq, PromptId(0), intent(Intent::None));
        said.typed = false;
        let after = manager.next(&state, &Cause::Utterance(said), at(seq));
        assert_eq!(after.act, state.act);
    }
}

#[test]
fn questions_about_the_scene_are_answered_from_it() {
    let mut manager = manager();
    let nothing = manager.first();
    let mut ask = |reading| text(&remark(&mut manager, &nothing, reading));
    let count = ask(about(Intent::AskCount, &["white"]));
    assert!(count.starts_with("There are three white bowls: the "), "{count}");
    let none = ask(about(Intent::AskCount, &["white", "metallic"]));
    assert_eq!(none, "There are no white metallic bowls here.");
    let which = ask(about(Intent::AskWhich, &["dishwasher"]));
    assert!(which.starts_with("I see the ") && which.contains("dishwasher"), "{which}");
    let whether = ask(about(Intent::AskWhether, &["dishwasher"]));
    assert!(whether.starts_with("Yes, I see the "), "{whether}");
    let not = ask(about(Intent::AskWhether, &["white", "metallic"]));
    assert_eq!(not, "No, there are no white metallic bowls here.");
    let values = about(Intent::AskWhich, &["small", "big"]).base;
    let further: Vec<_> = values.into_iter().map(|word| vec![word]).collect();
    let of_size = |word| Reading { further: further.clone(), ..about(Intent::AskWhich, &[word]) };
    let which = ask(of_size("clear"));
    assert_eq!(which, "It is big.");
    let which = ask(of_size("white"));
    assert_eq!(which, "Two are small and one is big.");
    let only = ask(about(Intent::Chore, &["clear"]));
    assert_eq!(only, "I can only fetch things and put them back. Shall I get the clear bowl?");
    assert_eq!(ask(about(Intent::AskWhere, &["clear"])), "It is on the counter.");
    assert!(ask(intent(Intent::AskHelp)).contains("for example: the "));
    assert_eq!(ask(intent(Intent::Greet)), "Hello! What would you like?");
}

#[test]
fn reasons_are_those_of_the_belief() {
    let mut manager = manager();
    let asking = first(&mut manager, words(&["metallic"]));
    let why = text(&remark(&mut manager, &asking, intent(Intent::AskWhy)));
    assert!(why.starts_with("Because it could be the ") && why.ends_with('?'), "{why}");
    let fetching = first(&mut manager, words(&["clear"]));
    let why = text(&remark(&mut manager, &fetching, intent(Intent::AskWhy)));
    assert_eq!(why, "Because you said clear.");
}

#[test]
fn no_question_is_put_twice_in_the_same_words() {
    let mut manager = manager();
    let mut state = first(&mut manager, words(&["metallic"]));
    let mut said = vec![text(&state)];
    for reading in TALK.into_iter().filter(|it| !cancels(*it) && *it != Intent::StartOver) {
        let wished = reading == Intent::Repeat;
        state = remark(&mut manager, &state, intent(reading));
        assert_eq!(state.act.kind, ActKind::Ask);
        let text = text(&state);
        let question = text.rsplit_once(['.', '!']).map_or(text.as_str(), |(_, it)| it.trim());
        assert!(wished || !said.iter().any(|it| it.ends_with(question)), "{text} after {said:?}");
        said.push(text);
    }
}

/// Once more, shorter; then the choices; then quiet.
#[test]
fn silence_is_met_with_fewer_words_and_then_with_silence() {
    let mut manager = manager();
    let mut state = first(&mut manager, words(&["metallic"]));
    let mut lines = vec![text(&state)];
    while state.open.is_some() {
        state = manager.next(&state, &Cause::Silence, at(20 * lines.len() as u64));
        lines.push(text(&state));
    }
    let [first, second, third, last] = &lines[..] else { panic!("{lines:?}") };
    assert!(second.len() < first.len(), "{lines:?}");
    assert!(third.contains(" or ") && third.ends_with("I am here when you need me."), "{lines:?}");
    assert_eq!(last, "");
}

#[test]
fn a_user_who_starts_over_is_asked_for_the_object() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["white"]));
    let over = reply(&mut manager, &state, intent(Intent::StartOver));
    assert_eq!((over.act.kind, text(&over).as_str()), (ActKind::Ask, "What would you like?"));
    let silent = manager.next(&over, &Cause::Silence, at(30));
    assert_eq!(text(&silent), "Which bowl would you like?");
    let clear = remark(&mut manager, &over, words(&["clear"]));
    assert_eq!(clear.act.kind, ActKind::Pick);
}

/// A request for an absent object starts nothing; a synonym of a quality may.
#[test]
fn absence_from_the_scene_is_said_at_once() {
    let mut manager = manager();
    let request = |text: &str, role: Role| {
        let said = typed(1, PromptId(0), Reading::default());
        let unknown = Some(UnknownWord { text: text.to_owned(), role });
        let said = Utterance { unknown, ..said };
        Cause::Utterance(said)
    };
    let plate = manager.next(&manager.first(), &request("plate", Role::Kind), at(1));
    assert_eq!(text(&plate), "There are no plates here, only bowls.");
    assert!(plate.open.is_none());
    let purple = manager.next(&manager.first(), &request("purple", Role::Quality), at(1));
    assert_eq!(purple.act.kind, ActKind::Ask);
}
