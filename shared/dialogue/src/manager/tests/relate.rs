//! Relations by place, order and size as evidence.

use super::fixture::{
    Settings, at, belief, first, manager, remark, reply, settings, settings_with, words,
};
use super::reconfigure::bowls;
use crate::manager::{Cause, State};
use scene::{Measure, Reading, Reference, Relation, Response};
use vocabulary::ActKind;

const LEFTMOST: Relation = Relation::Nth(Measure::Left, 1);

fn related(relation: Relation, said: &[&str]) -> Reading {
    Reading { refers: Reference::Relation(relation), ..words(said) }
}

fn likeliest(settings: &Settings, state: &State) -> (String, f64) {
    let open = state.open.as_ref().expect("an open interaction").belief();
    let object = open.most_likely();
    (settings.scene.object(object).name.clone(), open.probability(object))
}

#[test]
fn the_leftmost_is_fetched_without_a_question_and_is_not_certain() {
    for (said, wanted) in [(&[][..], "white3"), (&["metallic"][..], "metal")] {
        let state = first(&mut manager(), related(LEFTMOST, said));
        let (name, p) = likeliest(&settings(), &state);
        assert_eq!((state.act.kind, &*name), (ActKind::Pick, wanted));
        assert!((0.97..0.995).contains(&p), "{p}");
    }
}

#[test]
fn a_user_whose_place_is_known_means_the_own_left() {
    let settings = settings_with(|it| it.gestures = true);
    let state = first(&mut settings.manager(), related(LEFTMOST, &[]));
    assert_eq!(likeliest(&settings, &state).0, "white");
}

#[test]
fn a_relation_to_what_no_object_is_says_nothing() {
    let scene = settings().scene;
    let none = ["clear", "metal"].map(|word| scene.word_named(word).unwrap()).to_vec();
    let further = vec![none];
    let reading = Reading { further, ..related(Relation::More(Measure::Left), &[]) };
    let mut manager = manager();
    let nothing = first(&mut manager, Reading::default());
    assert_eq!(belief(&first(&mut manager, reading)), belief(&nothing));
}

#[test]
fn words_that_name_a_value_are_that_value() {
    let mut manager = manager();
    let biggest = first(&mut manager, related(Relation::Nth(Measure::Big, 1), &["big"]));
    assert_eq!(belief(&biggest), belief(&first(&mut manager, words(&["big"]))));
}

#[test]
fn what_was_said_outlives_the_objects_that_it_was_said_of() {
    let state = first(&mut manager(), related(Relation::Nth(Measure::Left, 2), &[]));
    assert_eq!(likeliest(&settings(), &state).0, "metal");
    let changed = bowls(&["white3"], "");
    let after = changed.manager().next(&state, &Cause::Reconfigured, at(2));
    let (name, p) = likeliest(&changed, &after);
    assert!(name == "metal" && p > 0.97, "{name} {p}, though it is the first from the left now");
}

#[test]
fn the_left_one_calls_off_another_that_is_on_its_way() {
    let mut manager = manager();
    let fetching = first(&mut manager, related(Relation::Nth(Measure::Right, 1), &["white"]));
    assert_eq!(likeliest(&settings(), &fetching).0, "white");
    let no = Reading { response: Response::No, ..related(LEFTMOST, &[]) };
    let denied = reply(&mut manager, &fetching, no);
    assert_eq!(denied.act.kind, ActKind::Cancel);
    assert_eq!(likeliest(&settings(), &denied).0, "white3");
    let plain = remark(&mut manager, &fetching, related(Relation::Nth(Measure::Right, 1), &[]));
    assert_eq!(plain.act.kind, ActKind::Pick, "the same one again");
}
