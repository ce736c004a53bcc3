//! Each rule by intent handles its utterance.

use super::fixture::{
    answer, at, belief, delivered, first, manager, remark, settings, text, words,
};
use crate::manager::{Cause, State};
use scene::{Intent, Reading, Reference, Response};

fn plain(intent: Intent) -> Reading {
    Reading { intent, ..Reading::default() }
}

fn with_words(intent: Intent) -> Reading {
    Reading { intent, ..words(&["white"]) }
}

fn excluding(intent: Intent) -> Reading {
    Reading { intent, excluded: vec![words(&["white"]).base], ..Reading::default() }
}

#[test]
fn an_intent_is_handled_by_its_rule() {
    let mut manager = manager();
    let (rest, asking) = (manager.first(), first(&mut manager, Reading::default()));
    let fetching = first(&mut manager, words(&["clear"]));
    let rows: [(&State, Reading, &str); 14] = [
        (&rest, plain(Intent::None), "typed words without a meaning"),
        (&rest, plain(Intent::Repeat), "a question to the robot"),
        (&rest, plain(Intent::Cancel), "a cancellation"),
        (&rest, excluding(Intent::Cancel), "\"don't get me the red one\" before any request"),
        (&rest, with_words(Intent::Stop), "a stop is noted"),
        (&asking, plain(Intent::Stop), "a stop is noted"),
        (&asking, with_words(Intent::Stop), "what is said counts"),
        (&asking, plain(Intent::StopAndCancel), "\"stop, never mind\""),
        (&asking, excluding(Intent::Cancel), "what is said counts"),
        (&asking, plain(Intent::Repeat), "\"what did you say?\""),
        (&asking, plain(Intent::StartOver), "\"start over\""),
        (&asking, with_words(Intent::StartOver), "what is said counts"),
        (&asking, plain(Intent::PutBack), "\"put it back\""),
        (&fetching, excluding(Intent::Stop), "words while the arm fetches"),
    ];
    for (state, reading, rule) in rows {
        let is_stop = matches!(reading.intent, Intent::Stop | Intent::StopAndCancel);
        let after = remark(&mut manager, state, reading.clone());
        assert!(manager.rule().starts_with(rule), "{reading:?}: {}", manager.rule());
        assert_eq!(after.stop.order.is_some(), is_stop, "{reading:?}");
    }
}

#[test]
fn stopping_and_cancelling_ends_the_interaction_and_the_stop_is_reported() {
    let mut manager = manager();
    let asking = first(&mut manager, Reading::default());
    let stopped = remark(&mut manager, &asking, plain(Intent::StopAndCancel));
    assert_eq!(stopped.open, None);
    let late = manager.next(&stopped, &Cause::StopReport { confirmed: false }, at(3));
    assert!(late.stop.order.is_some_and(|order| order.is_late));
    let reported = manager.next(&late, &Cause::StopReport { confirmed: true }, at(4));
    assert_eq!(reported.stop.order, None);
    assert_ne!(text(&late), text(&reported), "it was not confirmed, and now is");
}

#[test]
fn a_request_after_starting_over_counts_alone() {
    let mut manager = manager();
    let alone = first(&mut manager, words(&["white"]));
    let plastic = first(&mut manager, words(&["plastic"]));
    let over = remark(&mut manager, &plastic, with_words(Intent::StartOver));
    assert_eq!(belief(&over), belief(&alone));
}

#[test]
fn again_after_a_hand_over_opens_an_interaction() {
    let mut manager = manager();
    let fetching = first(&mut manager, words(&["clear"]));
    let end = manager.next(&fetching, &delivered(fetching.act.pick.unwrap().0), at(2));
    let again = Reading { refers: Reference::Same, ..plain(Intent::Repeat) };
    assert!(remark(&mut manager, &end, again).open.is_some());
}

#[test]
fn a_listed_object_is_fetched_upon_a_request_and_not_upon_a_mere_answer() {
    let mut manager = manager();
    let where_is = Reading { intent: Intent::AskWhere, ..words(&["white", "dishwasher"]) };
    let listed = first(&mut manager, where_is);
    assert_eq!(remark(&mut manager, &listed, answer(Response::Yes)).open, None);
    let fetching = remark(&mut manager, &listed, Reading::default());
    let named = settings().scene.object_named("white");
    assert_eq!(fetching.act.pick.map(|(_, object)| object), named);
}
