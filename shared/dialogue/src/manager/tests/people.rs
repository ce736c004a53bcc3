//! Learning about people who give their name.

use super::fixture::{
    Settings, answer, at, belief, delivered, heard, reply, settings_with, typed, words,
};
use crate::manager::{Cause, Manager, PEOPLE_MAX, Record, State, Utterance, refold};
use crate::{Answer, Channel};
use scene::{ObjectId, Reading, Response};
use vocabulary::ids::PromptId;
use vocabulary::{ActKind, PersonId, Rng};

fn manager() -> Manager {
    settings_with(|it| it.misperception = 0.0).manager()
}

fn named(name: &str) -> PersonId {
    PersonId::new(name).unwrap()
}

/// The same utterance of a person.
fn from(name: &str, cause: Cause) -> Cause {
    match cause {
        Cause::Utterance(said) => Cause::Utterance(Utterance { from: named(name), ..said }),
        cause => cause,
    }
}

/// Plays an interaction with a person who errs with that probability, to the delivery of the wanted
/// object, and returns its course.
pub(super) fn talk(
    manager: &mut Manager,
    state: &State,
    name: &str,
    errs: f64,
    seed: u64,
) -> Vec<Record> {
    let model = manager.model().clone();
    let mut rng = Rng::new(seed);
    let wanted = ObjectId::from(rng.below(6));
    let mut records: Vec<Record> = Vec::new();
    let mut state = state.clone();
    let start = state.ended.clone();
    for _ in 0..80 {
        let seq = state.applied.0 + 1;
        let say = |reading| from(name, heard(seq, state.act.prompt, reading));
        let handed = state.handed_over.as_ref().and_then(|it| it.object());
        let cause = match (&state.open, state.act.pick) {
            (None, _) if state.ended == start => say(Reading::default()),
            (None, _) if handed != Some(wanted) => say(answer(Response::No)),
            (None, _) => return records,
            (Some(_), Some((pick, _))) => delivered(pick),
            (Some(_), None) => {
                let truth = Answer::truthful(&model, state.act.question, wanted);
                let said = match (truth, rng.uniform() < errs) {
                    (Answer::Yes, true) => Answer::No,
                    (Answer::No, true) => Answer::Yes,
                    (said, _) => said,
                };
                say(said.reading(&model))
            }
        };
        let now = at(1 + records.len() as u64 + 1_000 * seed);
        state = manager.next(&state, &cause, now);
        records.push(Record { cause, at: now, state: state.clone() });
    }
    panic!("seed {seed}: it comes to no end: {:?}", state.act)
}

fn after(manager: &mut Manager, state: &State, name: &str, errs: f64, seeds: u64) -> State {
    let mut state = state.clone();
    for seed in 1..=seeds {
        state = talk(manager, &state, name, errs, seed).pop().unwrap().state;
    }
    state
}

/// The error rate that a person is taken to have in the next interaction.
fn expected(manager: &mut Manager, state: &State, name: &str) -> f64 {
    let seq = state.applied.0 + 1;
    let cause = from(name, heard(seq, PromptId(0), Reading::default()));
    let open = manager.next(state, &cause, at(1_000_000));
    manager.user_params(&open).map_or(manager.model().params().epsilon, |(_, epsilon)| epsilon)
}

#[test]
fn people_who_err_are_told_from_those_who_do_not() {
    let mut manager = manager();
    let first = manager.first();
    let state = after(&mut manager, &first, "Ann", 0.2, 20);
    let state = after(&mut manager, &state, "Bob", 0.0, 20);
    let (ann, bob) = (expected(&mut manager, &state, "Ann"), expected(&mut manager, &state, "Bob"));
    assert!((0.1..0.3).contains(&ann) && bob == 0.01, "{ann} {bob}");
    for nobody in ["Carl", "guest", ""] {
        assert_eq!(expected(&mut manager, &state, nobody), 0.01, "{nobody:?}");
    }
    let known: Vec<_> = state.people().iter().map(|it| (it.id.as_str(), it.deliveries)).collect();
    assert_eq!(known, [("Ann", 20), ("Bob", 20)]);
}

/// Unnamed users are treated as ever, bit for bit, whoever is known.
#[test]
fn of_nobody_nothing_is_learned() {
    let mut manager = manager();
    let first = manager.first();
    let state = after(&mut manager, &first, "guest", 0.2, 5);
    assert_eq!(state.people().iter().count(), 0);
    let known = after(&mut manager, &first, "Ann", 0.2, 8);
    let posterior = |manager: &mut Manager, state: &State| {
        let records = talk(manager, state, "", 0.0, 3);
        let of = |record: &Record| record.state.open.as_ref().map(|it| it.posterior.clone());
        records.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(posterior(&mut manager, &known), posterior(&mut manager, &first));
    let off = settings_with(|it| it.people.learns = false);
    let mut off = off.manager();
    assert_eq!(after(&mut off, &first, "Ann", 0.0, 3).people().iter().count(), 0);
    assert_eq!(expected(&mut off, &known, "Ann"), 0.01, "known, and not made use of");
}

/// A delivery that was refused teaches with the object that was meant, once.
#[test]
fn refused_deliveries_are_taken_back() {
    let mut manager = manager();
    let model = manager.model().clone();
    let (given, wanted) = (ObjectId(1), ObjectId(2));
    let mut state = manager.first();
    let say =
        |state: &State, reading| from("Ann", heard(state.applied.0 + 1, state.act.prompt, reading));
    state = manager.next(&state, &say(&state, Reading::default()), at(1));
    for seq in 2..20 {
        let Some((pick, object)) = state.act.pick else {
            let of = |o| Answer::truthful(&model, state.act.question, o).reading(&model);
            state = manager.next(&state, &say(&state, of(given)), at(seq));
            continue;
        };
        assert_eq!(object, given);
        state = manager.next(&state, &delivered(pick), at(seq));
        break;
    }
    let person = |state: &State| state.people().get(&named("Ann")).cloned().unwrap();
    let (name, lied) = (model_name(&manager, given), model_name(&manager, wanted));
    assert_eq!((person(&state).deliveries, person(&state).fetched.of(&name)), (1, 1));
    assert_eq!(person(&state).channels[Channel::YesNo as usize].wrong, 0.0);
    state = manager.next(&state, &say(&state, answer(Response::No)), at(20));
    assert!(state.open.is_some());
    assert_eq!((person(&state).deliveries, person(&state).fetched.of(&name)), (0, 0));
    for seq in 21..60 {
        let Some((pick, object)) = state.act.pick else {
            let of = |o| Answer::truthful(&model, state.act.question, o).reading(&model);
            state = manager.next(&state, &say(&state, of(wanted)), at(seq));
            continue;
        };
        assert_eq!(object, wanted);
        state = manager.next(&state, &delivered(pick), at(seq));
        break;
    }
    let yes_no = person(&state).channels[Channel::YesNo as usize];
    assert_eq!((person(&state).deliveries, person(&state).fetched.of(&lied)), (1, 1));
    assert!(yes_no.wrong > 0.9, "{yes_no:?}");
}

fn model_name(manager: &Manager, object: ObjectId) -> String {
    manager.scene().object(object).name.clone()
}

#[test]
fn the_prior_is_by_what_a_person_had_fetched_after_some_deliveries() {
    let settings = settings_with(|it| {
        it.misperception = 0.0;
        it.people.prior_from = 3;
    });
    let mut manager = settings.manager();
    let mut state = manager.first();
    let mut priors = Vec::new();
    for n in 1..=4_u64 {
        let ask = from("Ann", heard(state.applied.0 + 1, PromptId(0), Reading::default()));
        priors.push(belief(&manager.next(&state, &ask, at(100 * n)))[5]);
        let said = from("Ann", heard(state.applied.0 + 1, PromptId(0), words(&["clear"])));
        state = manager.next(&state, &said, at(100 * n));
        let (pick, _) = state.act.pick.expect("a unique word");
        state = manager.next(&state, &delivered(pick), at(100 * n + 1));
    }
    let expected = [1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0, 4.0 / 9.0];
    for (p, expected) in priors.iter().zip(expected) {
        assert!((p - expected).abs() < 1e-12, "{priors:?}");
    }
    let anybody = heard(state.applied.0 + 1, PromptId(0), Reading::default());
    assert!((belief(&manager.next(&state, &anybody, at(999)))[5] - 1.0 / 6.0).abs() < 1e-12);
}

/// A person can be forgotten at any moment; the interaction continues as with an unnamed user.
#[test]
fn forgetting_leaves_nothing() {
    let mut manager = manager();
    let first = manager.first();
    let state = after(&mut manager, &first, "Ann", 0.2, 6);
    let state = after(&mut manager, &state, "Bob", 0.0, 2);
    let forget = Cause::Forget(named("Ann"));
    let forgotten = manager.next(&state, &forget, at(9_000));
    let names: Vec<_> = forgotten.people().iter().map(|it| it.id.to_string()).collect();
    assert_eq!(names, ["Bob"]);
    for record in talk(&mut manager, &state, "Ann", 0.2, 9) {
        let forgotten = manager.next(&record.state, &forget, at(20_000));
        assert!(!format!("{forgotten:?}").contains("Ann"), "{:?}", forgotten.act);
        let open = |state: &State| state.open.is_some();
        assert_eq!(open(&forgotten), open(&record.state));
        if forgotten.act.kind == ActKind::Ask {
            // It can be answered as before.
            let next = reply(&mut manager, &forgotten, answer(Response::Yes));
            assert!(next.open.is_some());
        }
    }
}

#[test]
fn people_are_bounded_and_the_one_seen_longest_ago_is_forgotten_first() {
    let mut manager = manager();
    let mut state = manager.first();
    let visit = |manager: &mut Manager, state: &State, name: &str| {
        let said = from(name, heard(state.applied.0 + 1, PromptId(0), words(&["clear"])));
        let state = manager.next(state, &said, at(1));
        let (pick, _) = state.act.pick.expect("a unique word");
        manager.next(&state, &delivered(pick), at(1))
    };
    for n in 0..PEOPLE_MAX {
        state = visit(&mut manager, &state, &format!("person {n}"));
    }
    state = visit(&mut manager, &state, "person 0");
    state = visit(&mut manager, &state, "new");
    assert_eq!(state.people().iter().count(), PEOPLE_MAX);
    let is_known = |name: &str| state.people().get(&named(name)).is_some();
    assert_eq!(["person 0", "person 1", "new"].map(is_known), [true, false, true]);
}

/// A replay gives the same states, also with restarts under other settings in between.
#[test]
fn replay_gives_the_same_people() {
    let settings: Settings = settings_with(|it| it.misperception = 0.0125);
    let mut manager = settings.manager();
    let mut state = manager.first();
    let mut records = Vec::new();
    for seed in 1..=6 {
        records.extend(talk(&mut manager, &state, "Ann", 0.15, seed));
        state = records.last().unwrap().state.clone();
    }
    assert_eq!(refold(&mut settings.manager(), &records), Ok(()));
    for record in records.iter().rev().take(8) {
        let again = manager.next(&record.state, &Cause::Reconfigured, record.at);
        let posterior = |state: &State| state.open.as_ref().map(|it| it.posterior.clone());
        assert_eq!(posterior(&again), posterior(&record.state));
        assert_eq!(again.users, record.state.users);
    }
    let person = state.people().get(&named("Ann")).unwrap();
    assert!(person.attributes.iter().any(|(_, count)| count.right > 1.0), "{person:?}");
}

/// Words that are wrong teach as well.
#[test]
fn wrong_words_are_told_from_right_ones() {
    let mut manager = manager();
    let first = manager.first();
    let fetch = |manager: &mut Manager, state: &State, said: &[&str], wanted: &str| {
        let wanted = manager.scene().object_named(wanted).unwrap();
        let model = manager.model().clone();
        let mut state = manager.next(
            state,
            &from("Ann", heard(state.applied.0 + 1, PromptId(0), words(said))),
            at(1),
        );
        for _ in 0..40 {
            let handed = state.handed_over.as_ref().and_then(|it| it.object());
            let say = |reading| from("Ann", heard(state.applied.0 + 1, state.act.prompt, reading));
            let cause = match (&state.open, state.act.pick) {
                (None, _) if handed == Some(wanted) => break,
                (None, _) => say(answer(Response::No)),
                (Some(_), Some((pick, _))) => delivered(pick),
                _ => say(Answer::truthful(&model, state.act.question, wanted).reading(&model)),
            };
            state = manager.next(&state, &cause, at(1));
        }
        state
    };
    let count = |state: &State| {
        state.people().get(&named("Ann")).unwrap().channels[Channel::Words as usize]
    };
    let right = fetch(&mut manager, &first, &["clear"], "clear");
    assert!(count(&right).wrong < 0.01 && count(&right).right > 0.99, "{:?}", count(&right));
    let wrong = fetch(&mut manager, &first, &["clear"], "white");
    assert!(count(&wrong).wrong > 0.99, "{:?}", count(&wrong));
}

/// A person's name travels with the utterance, in journals too; without one nothing changes.
#[test]
fn an_utterance_of_nobody_has_the_bytes_of_before() {
    let said = typed(1, PromptId(0), Reading::default());
    let json = |said: &Utterance| serde_json::to_value(said).unwrap();
    let of_ann = Utterance { from: named("Ann"), ..said.clone() };
    assert_eq!(json(&said)[3], "Whole");
    for said in [said, of_ann] {
        for more in [false, true] {
            let said = Utterance { more, ..said.clone() };
            assert_eq!(serde_json::from_value::<Utterance>(json(&said)).unwrap(), said);
        }
    }
}
