//! Objects that appear and disappear under a dialogue.

use super::fixture::{
    Settings, answer, asked, at, belief, bowls_file, delivered, first, heard, manager, markers,
    remark, reply, settings, settings_of, settings_with, text, typed, words,
};
use super::fold::{random_dialogue, shift};
use crate::Model;
use crate::manager::NAMES_MAX;
use crate::manager::{Cause, Manager, Record, State, Utterance, refold_since};
use scene::{Intent, Measure, Reading, Reference, Relation, Response, Role, UnknownWord};
use vocabulary::ids::{PickId, PromptId};
use vocabulary::{ActKind, Outcome, PickOutcome};

/// The shipped bowls without those in `gone`, and with these TOML lines behind them.
pub(super) fn bowls(gone: &[&str], more: &str) -> Settings {
    settings_of(&bowls_file(gone, more))
}

/// A seventh bowl: a small white one in the cabinet, before the others' numbers or behind them.
const SEVENTH: &str = r#"
[[objects]]
name = "white4"
attributes = { color = "white", material = "plastic", size = "small", shape = "round", location = "cabinet" }
xyz = [0.60, 0.40, 0.125]
size = [0.12, 0.12, 0.05]
grasp_width = 0.006
form = "hollow"
"#;

/// After "the white one", with a question standing.
fn white_asked(manager: &mut Manager) -> State {
    let state = first(manager, words(&["white"]));
    assert_eq!(state.act.kind, ActKind::Ask);
    state
}

/// Enough to order `metal2` at once.
fn all_about_metal2() -> Reading {
    words(&["metallic", "metal", "big", "counter"].repeat(4))
}

fn probability(settings: &Settings, state: &State, name: &str) -> f64 {
    belief(state)[settings.scene.object_named(name).unwrap().index()]
}

#[test]
fn a_bowl_that_is_gone_drops_out_and_a_new_one_counts_with_the_words_said() {
    let state = white_asked(&mut manager());
    let changed = bowls(&["metal2"], SEVENTH);
    let after = changed.manager().next(&state, &Cause::Reconfigured, at(2));
    assert_eq!(after.scene_key, changed.scene.key());
    assert_eq!(after.open.as_ref().unwrap().id, state.open.as_ref().unwrap().id, "it goes on");
    assert_eq!(belief(&after).len(), 6);
    let p = |name| probability(&changed, &after, name);
    assert!((p("white4") - p("white2")).abs() < 1e-12, "white, as was said");
    assert!(p("white4") > 2.0 * p("metal"), "{:?}", belief(&after));
    assert_eq!(after.act.kind, ActKind::Ask);
    assert!(after.act.prompt > state.act.prompt, "asked again");
    let said = "The big metallic bowl is gone. ";
    let new = "The small white bowl in the cabinet is new. ";
    assert!(text(&after).starts_with(&format!("{said}{new}")), "{}", text(&after));
}

/// Scoring again under the same scene gives exactly the same belief.
#[test]
fn the_same_scene_gives_the_same_belief_bit_for_bit() {
    for seed in 0..12 {
        for record in random_dialogue(&settings(), seed) {
            let state = record.state;
            if state.open.is_none() {
                continue;
            }
            let again = manager().next(&state, &Cause::Reconfigured, at(50));
            let bits = |state: &State| -> Vec<u64> {
                let belief = state.open.as_ref().unwrap().belief();
                belief.log_weights().iter().map(|w| w.to_bits()).collect()
            };
            assert_eq!(bits(&again), bits(&state), "seed {seed}");
            assert_eq!(again.act.prompt, state.act.prompt, "seed {seed}: it is not asked again");
        }
    }
}

#[test]
fn an_answer_to_a_question_from_before_still_counts() {
    let state = white_asked(&mut manager());
    let question = state.act.prompt;
    let changed = Settings { misperception: 0.0, ..bowls(&["white"], "") };
    let mut manager = changed.manager();
    let after = manager.next(&state, &Cause::Reconfigured, at(2));
    let asked = &after.open.as_ref().unwrap().prompts[0].named;
    let asked = asked.question(&changed.scene);
    let late = manager.next(&after, &heard(2, question, answer(Response::Yes)), at(3));
    let mut expected = after.open.as_ref().unwrap().belief();
    let model = Model::new(&changed.scene, changed.params);
    expected.update(&model, asked, &answer(Response::Yes));
    assert_eq!(belief(&late), expected.probabilities());
}

#[test]
fn a_change_of_the_scene_folds_again_bit_for_bit_from_the_record_before() {
    let mut records = random_dialogue(&settings(), 5);
    records.truncate(6);
    let before = records.last().unwrap().state.clone();
    let changed = bowls(&["metal"], SEVENTH);
    let mut manager = changed.manager();
    let mut state = before;
    for (n, cause) in [Cause::Reconfigured, Cause::Silence].into_iter().enumerate() {
        let when = at(100 + n as u64);
        state = manager.next(&state, &cause, when);
        records.push(Record { cause, at: when, state: state.clone() });
    }
    let key = manager.key();
    assert_eq!(refold_since(&mut changed.manager(), &records, key), Ok(2));
    // Settings that decide nothing about these records may differ.
    let mut slower = changed.clone();
    slower.turns.response_window_s = 99.0;
    let mut slower = slower.manager();
    assert_ne!(slower.key(), key);
    assert_eq!(refold_since(&mut slower, &records, key), Ok(2));
    let open = records[6].state.open.as_mut().expect("an open interaction");
    shift(open, 1e-12);
    let error = refold_since(&mut changed.manager(), &records, key).unwrap_err();
    assert_eq!((error.index, error.part), (6, "belief"));
}

#[test]
fn a_pick_whose_object_is_gone_ends_the_interaction_and_another_goes_on() {
    let mut manager = manager();
    let state = first(&mut manager, all_about_metal2());
    let (pick, _) = state.act.pick.expect("sure enough");
    let gone = bowls(&["metal2"], "").manager().next(&state, &Cause::Reconfigured, at(2));
    assert_eq!(gone.ended.map(|ended| ended.outcome), Some(Outcome::SceneChanged));

    let changed = bowls(&["white"], "");
    let mut manager = changed.manager();
    let moved = manager.next(&state, &Cause::Reconfigured, at(2));
    let metal2 = changed.scene.object_named("metal2").unwrap();
    assert_eq!(moved.act.pick, Some((pick, metal2)), "the same order with the new number");
    // The arm was restarted too, and has left the object that it had not yet grasped.
    let left = Cause::PickEnded { pick, outcome: PickOutcome::Cancelled };
    let again = manager.next(&moved, &left, at(3));
    let second = PickId { attempt: pick.attempt + 1, ..pick };
    assert_eq!(again.act.pick, Some((second, metal2)));
    assert!(again.act.id > moved.act.id);
    let done = manager.next(&again, &delivered(second), at(4));
    assert_eq!(done.ended.and_then(|ended| ended.name).as_deref(), Some("metal2"));
    assert_eq!(done.history.of("metal2"), 1);
}

#[test]
fn a_pick_that_the_person_gave_up_is_not_ordered_again() {
    let mut manager = manager();
    let state = first(&mut manager, all_about_metal2());
    let (pick, _) = state.act.pick.expect("sure enough");
    let cancel = Reading { intent: Intent::Cancel, ..Reading::default() };
    let state = remark(&mut manager, &state, cancel);
    let left = Cause::PickEnded { pick, outcome: PickOutcome::Cancelled };
    let state = manager.next(&state, &left, at(3));
    assert_eq!(state.ended.map(|ended| ended.outcome), Some(Outcome::Cancelled));
}

#[test]
fn the_interaction_ends_where_nothing_is_left() {
    let state = white_asked(&mut manager());
    let markers = markers();
    let after = markers.manager().next(&state, &Cause::Reconfigured, at(2));
    assert_eq!(after.ended.map(|ended| ended.outcome), Some(Outcome::SceneChanged));
    assert_eq!(after.scene_key, markers.scene.key());
}

#[test]
fn a_word_that_nothing_had_counts_for_an_object_that_has_it_now() {
    let mut manager = manager();
    let state = asked(&mut manager);
    let utterance = typed(2, PromptId(0), Reading::default());
    let unknown = Some(UnknownWord { text: "copper".to_owned(), role: Role::Quality });
    let cause = Cause::Utterance(Utterance { unknown, ..utterance });
    let state = manager.next(&state, &cause, at(2));
    let copper =
        SEVENTH.replace("white4", "copper1").replace("color = \"white\"", "color = \"copper\"");
    let file = bowls_file(&[], &copper);
    let changed = settings_of(&file.replacen("  \"white\",\n", "  \"white\",\n  \"copper\",\n", 1));
    let after = changed.manager().next(&state, &Cause::Reconfigured, at(3));
    let p = |name| probability(&changed, &after, name);
    assert!(p("copper1") > 2.0 * p("white"), "{:?}", belief(&after));
}

/// An endless talker: memory stays bounded, the belief loses nothing, and only a change of the
/// scene finds that the beginning is forgotten.
#[test]
fn memory_of_an_interaction_is_bounded() {
    let mut manager = settings_with(|it| it.turns.questions_max = 1_000).manager();
    let mut state = asked(&mut manager);
    let said = words(&["white", "metallic"]);
    for _ in 2..600 {
        state = reply(&mut manager, &state, said.clone());
    }
    let open = state.open.as_ref().expect("nothing was decided by this");
    assert!(open.forgotten > 0 && open.evidence.len() <= NAMES_MAX / 4, "{}", open.evidence.len());
    let again = manager.next(&state, &Cause::Reconfigured, at(1000));
    assert_eq!(again.open.unwrap().forgotten, open.forgotten);
}

#[test]
fn what_was_said_outlives_the_objects_that_it_was_said_of() {
    let refers = Reference::Relation(Relation::Nth(Measure::Left, 2));
    let state = first(&mut manager(), Reading { refers, ..Reading::default() });
    let likeliest = |state: &State| state.open.as_ref().unwrap().belief().most_likely();
    assert_eq!(settings().scene.object(likeliest(&state)).name, "metal");
    let changed = bowls(&["white3"], "");
    let after = changed.manager().next(&state, &Cause::Reconfigured, at(2));
    let p = probability(&changed, &after, "metal");
    assert!(p > 0.97, "{p}, though it is the first from the left now");
}

#[test]
fn history_survives_another_scene() {
    let mut manager = manager();
    let state = first(&mut manager, words(&["clear"]));
    let (pick, _) = state.act.pick.expect("sure enough");
    let state = manager.next(&state, &delivered(pick), at(2));
    let there = markers().manager().next(&state, &Cause::Reconfigured, at(99));
    let back = manager.next(&there, &Cause::Reconfigured, at(100));
    assert_eq!((back.history.of("clear"), back.history), (1, state.history));
}

/// Turning absence on under an open interaction gives every belief one entry more.
#[test]
fn absence_may_be_switched_while_a_question_stands() {
    let state = asked(&mut manager());
    let mut absent = settings_with(|it| it.prior.absent = 0.1).manager();
    let on = absent.next(&state, &Cause::Reconfigured, at(2));
    assert_eq!((belief(&on).len(), on.act.kind), (7, ActKind::Ask));
    let off = manager().next(&on, &Cause::Reconfigured, at(3));
    assert_eq!(belief(&off), belief(&state));
}
