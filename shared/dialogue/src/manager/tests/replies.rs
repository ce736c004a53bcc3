//! Every text that is typed gets an answer, and no question comes twice in the same words. The answers are in
//! `conversations.txt`.

use super::fixture::{
    answer, at, belief, first, heard, manager, remark, reply, text, typed, words,
};
use crate::manager::{Cause, Manager, State};
use scene::{Intent, Reading, Response};
use vocabulary::ids::PromptId;
use vocabulary::{ActKind, Outcome};

fn intent(intent: Intent) -> Reading {
    Reading { intent, ..Reading::default() }
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

/// Recognisers write "Thank you." and "you" into silence.
#[test]
fn thanks_and_words_without_a_meaning_change_no_belief() {
    let mut manager = manager();
    let asking = first(&mut manager, words(&["white"]));
    for it in [Intent::Thank, Intent::None] {
        let after = remark(&mut manager, &asking, intent(it));
        assert_eq!(after.act.question, asking.act.question, "{it:?}");
        assert_eq!(belief(&after), belief(&asking), "{it:?}");
        let answered = reply(&mut manager, &asking, intent(it));
        assert_eq!(belief(&answered), belief(&asking), "{it:?}");
    }
}

/// Recognisers may make any number of them of silence.
#[test]
fn words_without_a_meaning_bring_the_question_twice_more() {
    let mut manager = manager();
    let asking = first(&mut manager, words(&["white"]));
    let mut state = asking.clone();
    for it in [Intent::Thank, Intent::None] {
        state = remark(&mut manager, &state, intent(it));
        assert_eq!(state.act.question, asking.act.question, "{it:?}");
    }
    assert!(text(&state).ends_with("I am here when you need me."), "{}", text(&state));
    let given_up = remark(&mut manager, &state, intent(Intent::Thank));
    assert_eq!(text(&given_up), "You are welcome.");
    assert_eq!(given_up.ended.unwrap().outcome, Outcome::Abandoned);
    let asked_back = remark(&mut manager, &state, intent(Intent::AskHelp));
    let thanked = remark(&mut manager, &asked_back, intent(Intent::Thank));
    assert_eq!(thanked.act.question, asking.act.question, "talk between them begins anew");
    let answered = reply(&mut manager, &state, answer(Response::Yes));
    assert_ne!(answered.open.map(|open| open.silences), Some(2), "an answer begins anew");
}

#[test]
fn no_question_is_put_twice_in_the_same_words() {
    let mut manager = manager();
    let mut state = first(&mut manager, words(&["metallic"]));
    let mut said = vec![text(&state)];
    for reading in TALK.into_iter().filter(|it| !cancels(*it) && *it != Intent::StartOver) {
        // Thanks count as no answer, as does what is not understood.
        if reading == Intent::Thank {
            continue;
        }
        let wished = reading == Intent::Repeat;
        state = remark(&mut manager, &state, intent(reading));
        assert_eq!(state.act.kind, ActKind::Ask);
        let text = text(&state).replace(" I am here when you need me.", "");
        let question = text.rsplit_once(['.', '!']).map_or(text.as_str(), |(_, it)| it.trim());
        assert!(wished || !said.iter().any(|it| it.ends_with(question)), "{text} after {said:?}");
        said.push(text);
    }
}
