//! "Put it back": the delivered object goes back, and the open interaction continues.

use super::fixture::{
    answer, at, delivered, first, heard, manager, remark, reply, settings, text, words,
};
use crate::manager::{Cause, Manager, MotionStop, Progress, Record, State, refold};
use scene::{Intent, Question, Reading, Response};
use vocabulary::time::Span;
use vocabulary::{ActKind, Outcome, PickOutcome};

fn wish(said: &[&str]) -> Reading {
    Reading { intent: Intent::PutBack, ..words(said) }
}

/// The state after that request was fulfilled at once.
fn handed_over(manager: &mut Manager, said: &[&str]) -> State {
    let state = first(manager, words(said));
    let (pick, _) = state.act.pick.expect("a unique description");
    manager.next(&state, &delivered(pick), at(state.applied.0 + 1))
}

fn ends(manager: &mut Manager, state: &State, outcome: PickOutcome) -> State {
    let (pick, _) = state.ordered().expect("an order");
    manager.next(state, &Cause::PickEnded { pick, outcome }, at(state.applied.0 + 1))
}

fn object(state: &State) -> String {
    settings().scene.object(state.act.pick.expect("an order").1).name.clone()
}

fn outcome(state: &State) -> Option<Outcome> {
    state.ended.as_ref().map(|ended| ended.outcome)
}

#[test]
fn a_delivery_that_is_put_back_counts_as_refused() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    assert_eq!(end.history.of("clear"), 1);
    let state = remark(&mut manager, &end, wish(&[]));
    assert_eq!((state.act.kind, object(&state).as_str()), (ActKind::PutBack, "clear"));
    assert!(text(&state).starts_with("I will put the clear bowl back."), "{}", text(&state));
    assert_eq!((outcome(&state), state.history.of("clear")), (Some(Outcome::Refused), 0));
    let (pick, _) = state.ordered().expect("an order");
    let before = end.ended.as_ref().map(|ended| ended.interaction);
    assert_eq!((Some(pick.interaction), pick.attempt), (before, 2));
    let done = ends(&mut manager, &state, PickOutcome::PutBack);
    assert_eq!(
        (done.act.kind, text(&done).as_str()),
        (ActKind::Say, "I have put the clear bowl back.")
    );
    assert_eq!((done.ordered(), done.open.is_none()), (None, true));
    let again = remark(&mut manager, &done, wish(&[]));
    assert_eq!(text(&again), "I have nothing to put back.");
}

/// A user who answers "Here is the clear bowl." with "put it back" does not merely deny it.
#[test]
fn the_wish_to_put_back_is_no_mere_denial() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let Cause::Utterance(mut said) = heard(end.applied.0 + 1, end.act.prompt, answer(Response::No))
    else {
        panic!("an utterance")
    };
    let alone = said.interpretations.iter_mut().filter(|it| it.answers.is_none());
    alone.for_each(|it| it.reading = wish(&[]));
    let state = manager.next(&end, &Cause::Utterance(said), at(9));
    assert_eq!(state.act.kind, ActKind::PutBack);
}

#[test]
fn an_object_is_put_back_while_a_delivery_can_be_refused() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let handed_at = end.handed_over.as_ref().expect("a delivery").at;
    let window = Span::from_s(manager.turns().refusal_s);
    let cause = heard(end.applied.0 + 1, vocabulary::ids::PromptId(0), wish(&[]));
    let last = manager.next(&end, &cause, handed_at + window);
    assert_eq!(last.act.kind, ActKind::PutBack);
    let late = manager.next(&end, &cause, handed_at + window + Span::from_ms(1));
    assert_eq!(text(&late), "I have nothing to put back.");
    assert_eq!(outcome(&late), Some(Outcome::Delivered));
    let other = remark(&mut manager, &end, wish(&["white"]));
    assert_eq!(text(&other), "I have nothing to put back.");
    let it = remark(&mut manager, &end, wish(&["clear"]));
    assert_eq!(it.act.kind, ActKind::PutBack);
}

#[test]
fn a_question_that_was_open_comes_after_it() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["white", "dishwasher"]);
    let refused = reply(&mut manager, &end, answer(Response::No));
    assert_eq!((refused.act.kind, outcome(&refused)), (ActKind::Ask, Some(Outcome::Refused)));
    let state = remark(&mut manager, &refused, wish(&[]));
    assert_eq!((state.act.kind, object(&state).as_str()), (ActKind::PutBack, "white"));
    let (pick, _) = state.ordered().expect("an order");
    assert_eq!(Some(pick.interaction), refused.open.as_ref().map(|open| open.id));
    let done = ends(&mut manager, &state, PickOutcome::PutBack);
    assert_eq!(done.act.kind, ActKind::Ask);
    assert!(
        text(&done).starts_with("I have put the bowl in the dishwasher back. "),
        "{}",
        text(&done)
    );
    assert_eq!(
        done.open.as_ref().map(|open| open.belief()),
        refused.open.map(|open| open.belief())
    );
    // The next order has a key of its own.
    let mut next = done;
    while next.act.kind == ActKind::Ask {
        next = reply(&mut manager, &next, answer(Response::Yes));
    }
    let (fetched, _) = next.act.pick.expect("a pick");
    assert!(fetched > pick, "{fetched:?} after {pick:?}");
}

#[test]
fn words_said_while_an_object_is_put_back_count_afterwards() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["white", "dishwasher"]);
    let state = remark(&mut manager, &end, wish(&[]));
    let asked = remark(&mut manager, &state, words(&["clear"]));
    assert_eq!((asked.act.kind, asked.ordered()), (ActKind::PutBack, state.ordered()));
    assert!(
        text(&asked).starts_with("I am putting the bowl in the dishwasher back."),
        "{}",
        text(&asked)
    );
    let thanks = Reading { intent: Intent::Thank, ..Reading::default() };
    let thanked = remark(&mut manager, &asked, thanks);
    assert_eq!((thanked.act.kind, text(&thanked).as_str()), (ActKind::PutBack, "You are welcome."));
    let again = remark(&mut manager, &thanked, wish(&[]));
    assert_eq!((again.act.kind, again.ordered()), (ActKind::PutBack, state.ordered()));
    let floor = crate::manager::Floor::default();
    assert!(!manager.quiet_is_due(&again, &floor, at(99)));
    let done = ends(&mut manager, &again, PickOutcome::PutBack);
    assert_eq!((done.act.kind, object(&done).as_str()), (ActKind::Pick, "clear"));
    assert!(text(&done).ends_with("I will get the clear bowl."), "{}", text(&done));
}

#[test]
fn putting_back_has_its_turn_after_a_fetch() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let fetching = remark(&mut manager, &end, words(&["white", "dishwasher"]));
    let state = remark(&mut manager, &fetching, wish(&[]));
    assert_eq!((state.act.kind, state.act.pick), (ActKind::Pick, fetching.act.pick));
    assert!(text(&state).ends_with("Then I will put the clear bowl back."), "{}", text(&state));
    assert_eq!(state.history.of("clear"), 0);
    let then = ends(&mut manager, &state, PickOutcome::Delivered);
    assert_eq!((then.act.kind, object(&then).as_str()), (ActKind::PutBack, "clear"));
    assert!(text(&then).starts_with("Here is the bowl in the dishwasher."), "{}", text(&then));
    let done = ends(&mut manager, &then, PickOutcome::PutBack);
    assert_eq!(text(&done), "I have put the clear bowl back.");
    // And now the other one.
    let other = remark(&mut manager, &done, wish(&[]));
    assert_eq!((other.act.kind, object(&other).as_str()), (ActKind::PutBack, "white"));
}

/// Without an object handed over, the one being fetched is meant.
#[test]
fn the_fetch_is_called_off_where_nothing_was_handed_over() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["clear"]));
    assert_eq!(remark(&mut manager, &fetching, wish(&[])).act.kind, ActKind::Cancel);
    let asked = first(&mut manager, words(&["white"]));
    let reply = remark(&mut manager, &asked, wish(&[]));
    assert_eq!(reply.act.kind, ActKind::Ask);
    assert!(text(&reply).starts_with("I have nothing to put back."), "{}", text(&reply));
}

#[test]
fn putting_back_waits_for_a_yes_and_the_release_while_stopped() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let stop = |manager: &mut Manager, state: &State, stopped| {
        let stop = if stopped { MotionStop::Stopped } else { MotionStop::Released };
        manager.next(state, &Cause::MotionStop(stop), at(state.applied.0))
    };
    let stopped = stop(&mut manager, &end, true);
    let held_back = remark(&mut manager, &stopped, wish(&[]));
    assert_eq!((held_back.act.kind, held_back.ordered()), (ActKind::Say, None));
    assert!(text(&held_back).ends_with("Shall I put the clear bowl back then?"));
    let yes = reply(&mut manager, &held_back, answer(Response::Yes));
    assert_eq!((text(&yes).as_str(), yes.ordered()), ("All right, once you resume.", None));
    assert_eq!(stop(&mut manager, &yes, false).act.kind, ActKind::PutBack);
    // Released before the yes.
    let released = stop(&mut manager, &held_back, false);
    assert_eq!(text(&released), "Say yes, and I will put the clear bowl back.");
    assert_eq!(reply(&mut manager, &released, answer(Response::Yes)).act.kind, ActKind::PutBack);
    let no = reply(&mut manager, &released, answer(Response::No));
    assert_eq!((no.act.kind, no.putting_back.is_none()), (ActKind::Say, true));
}

#[test]
fn putting_back_can_be_called_off_until_the_arm_holds_the_object() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let state = remark(&mut manager, &end, wish(&[]));
    let never_mind = Reading { intent: Intent::Cancel, ..Reading::default() };
    let called_off = [
        remark(&mut manager, &state, never_mind),
        reply(&mut manager, &state, answer(Response::No)),
    ];
    for called_off in called_off {
        assert_eq!((called_off.act.kind, called_off.act.pick), (ActKind::Cancel, state.act.pick));
        let left = ends(&mut manager, &called_off, PickOutcome::Cancelled);
        assert_eq!(text(&left), "The clear bowl stays with you.");
        let again = remark(&mut manager, &left, wish(&[]));
        assert_eq!(again.act.kind, ActKind::PutBack);
        assert!(again.ordered() > state.ordered(), "a key of its own");
        let held = ends(&mut manager, &called_off, PickOutcome::PutBack);
        assert_eq!(text(&held), "I have put the clear bowl back.");
    }
}

/// All of it is in the journal.
#[test]
fn putting_back_folds_again() {
    let mut manager = manager();
    let mut state = manager.first();
    let mut records = Vec::new();
    let mut step = |state: &mut State, cause: Cause| {
        let now = at(records.len() as u64 + 1);
        manager.step(state, &cause, now);
        records.push(Record { cause, at: now, state: state.clone() });
    };
    let clear = heard(1, state.act.prompt, words(&["clear"]));
    step(&mut state, clear);
    let (pick, _) = state.ordered().expect("a pick");
    step(&mut state, delivered(pick));
    step(&mut state, Cause::MotionStop(MotionStop::Stopped));
    let back = heard(2, state.act.prompt, wish(&[]));
    step(&mut state, back);
    let yes = heard(3, state.act.prompt, answer(Response::Yes));
    step(&mut state, yes);
    step(&mut state, Cause::MotionStop(MotionStop::Released));
    let ordered = state.putting_back.as_ref().map(|it| it.progress);
    assert!(matches!(ordered, Some(Progress::Ordered(_))));
    let (pick, _) = state.ordered().expect("an order");
    step(&mut state, Cause::PickEnded { pick, outcome: PickOutcome::PutBack });
    assert_eq!(state.act.question, Question::None);
    refold(&mut settings().manager(), &records).unwrap();
}

/// A person must look first.
#[test]
fn putting_back_is_dropped_where_the_fetch_before_it_was_interrupted() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let fetching = remark(&mut manager, &end, words(&["white", "dishwasher"]));
    let in_turn = remark(&mut manager, &fetching, wish(&[]));
    for interrupted in [PickOutcome::Interrupted, PickOutcome::Blocked] {
        let state = ends(&mut manager, &in_turn, interrupted);
        assert_eq!((state.act.kind, state.ordered()), (ActKind::Say, None));
        assert!(state.putting_back.is_none());
    }
}

/// "No, the white one" is about another object.
#[test]
fn a_no_with_words_of_another_object_does_not_call_putting_back_off() {
    let mut manager = manager();
    let end = handed_over(&mut manager, &["clear"]);
    let state = remark(&mut manager, &end, wish(&[]));
    let no = |said: &[&str]| Reading { response: Response::No, ..words(said) };
    assert_eq!(reply(&mut manager, &state, no(&["clear"])).act.kind, ActKind::Cancel);
    let other = reply(&mut manager, &state, no(&["white"]));
    assert_eq!((other.act.kind, other.ordered()), (ActKind::PutBack, state.ordered()));
}
