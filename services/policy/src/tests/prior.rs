//! What is believed before anything is said: alike, by history, or that it may not be here.

use super::*;

fn manager_with(over: &[(&str, &str)]) -> Manager {
    settings_with(over).manager().unwrap()
}

const HISTORY: [(&str, &str); 1] = [("dialogue.prior.objects", "history")];
const ABSENT: [(&str, &str); 1] = [("dialogue.prior.absent", "0.1")];

/// Has `name` asked for with every word that it has, and delivered.
fn deliver(manager: &mut Manager, state: &State, name: &str, seq: &mut u64) -> State {
    let scene = settings().scene;
    let wanted = scene.object_named(name).unwrap();
    let base: Vec<_> = scene.vocabulary(wanted).flat_map(|word| [word; 4]).collect();
    *seq += 1;
    let cause = heard(*seq, PromptId(0), Reading { base, ..Reading::default() });
    let state = manager.next(state, &cause, at(*seq));
    let (pick, object) = state.act.pick.expect("sure enough");
    assert_eq!(object, wanted);
    manager.next(&state, &Cause::PickEnded { pick, outcome: PickOutcome::Delivered }, at(*seq))
}

fn first_belief(manager: &mut Manager, state: &State, seq: u64) -> Vec<f64> {
    belief(&manager.next(state, &heard(seq + 1, PromptId(0), Reading::default()), at(seq + 1)))
}

#[test]
fn what_was_fetched_often_is_believed_first_only_where_that_is_chosen() {
    let (mut seq, mut manager) = (0, manager_with(&HISTORY));
    let mut state = manager.first();
    for name in ["clear", "clear", "metal", "clear"] {
        state = deliver(&mut manager, &state, name, &mut seq);
    }
    assert_eq!((state.history.of("clear"), state.history.of("metal")), (3, 1));
    let expected = [1.0, 1.0, 1.0, 2.0, 1.0, 4.0].map(|n| n / 10.0);
    for (p, expected) in first_belief(&mut manager, &state, seq).iter().zip(expected) {
        assert!((p - expected).abs() < 1e-12, "{p} {expected}");
    }
    let uniform = first_belief(&mut super::manager(), &state, seq);
    assert!(uniform.iter().all(|p| (p - 1.0 / 6.0).abs() < 1e-12), "{uniform:?}");
}

#[test]
fn history_survives_a_restart_and_another_scene_and_folds_again() {
    let (mut seq, mut manager) = (0, manager_with(&HISTORY));
    let (mut state, mut records) = (manager.first(), Vec::new());
    for _ in 0..3 {
        seq += 1;
        let base = [settings().scene.word_named("clear").unwrap(); 6].to_vec();
        let cause = heard(seq, PromptId(0), Reading { base, ..Reading::default() });
        for step in 0..2 {
            let cause = match (step, state.act.pick) {
                (1, Some((pick, _))) => Cause::PickEnded { pick, outcome: PickOutcome::Delivered },
                _ => cause.clone(),
            };
            state = manager.next(&state, &cause, at(seq));
            records.push(Record { cause, at: at(seq), state: state.clone() });
        }
    }
    assert_eq!(state.history.of("clear"), 3);
    refold(&mut manager_with(&HISTORY), &records).unwrap();
    let node = PolicyNode::recover(manager_with(&HISTORY), records).unwrap();
    assert_eq!(node.state().history, state.history);
    let markers = settings_with(&[("group.scene", "markers")]);
    let there = markers.manager().unwrap().next(&state, &Cause::Reconfigured, at(99));
    let back = manager.next(&there, &Cause::Reconfigured, at(100));
    assert_eq!(back.history, state.history);
}

#[test]
fn who_denies_everything_is_told_that_it_is_not_here() {
    let mut manager = manager_with(&ABSENT);
    let mut state = asked(&mut manager);
    assert_eq!(belief(&state).len(), 7);
    for seq in 2..40 {
        let prompt = state.act.prompt;
        state = manager.next(&state, &heard(seq, prompt, answer(Response::No)), at(seq));
        if state.open.is_none() {
            break;
        }
    }
    let ended = state.ended.clone().expect("an end");
    assert_eq!((ended.outcome, ended.object, ended.name), (Outcome::NotHere, None, None));
    assert_eq!(state.act.kind, ActKind::Say);
    assert!(state.act.pick.is_none());
    assert!(text(&state).contains("does not seem to be here. I see 6 bowls"), "{:?}", state.act);
    assert!(!state.act.alternatives.is_empty(), "with its reasons");
}

#[test]
fn whoever_wants_what_is_here_gets_it_though_it_might_not_be() {
    let settings = settings_with(&ABSENT);
    let model = Model::new(&settings.scene, settings.dialogue.params);
    for wanted in (0..6).map(ObjectId::from) {
        let mut manager = manager_with(&ABSENT);
        let mut state = asked(&mut manager);
        for seq in 2..30 {
            let truth = Answer::truthful(&model, state.act.question, wanted).reading(&model);
            state = manager.next(&state, &heard(seq, state.act.prompt, truth), at(seq));
            if state.act.kind != ActKind::Ask {
                break;
            }
        }
        assert_eq!(state.act.pick.map(|(_, object)| object), Some(wanted));
    }
}

#[test]
fn clients_see_objects_and_absence_apart() {
    let mut manager = manager_with(&[ABSENT[0], HISTORY[0]]);
    let state = asked(&mut manager);
    for state in [&manager.first(), &state] {
        let view = crate::view::view(&manager, state, 0);
        assert_eq!(view.belief.len(), 6);
        assert!((view.absent - 0.1).abs() < 1e-12, "{view:?}");
        assert!((view.belief.iter().sum::<f64>() - 0.9).abs() < 1e-12, "{view:?}");
    }
    let uniform = super::manager();
    assert_eq!(crate::view::view(&uniform, &uniform.first(), 0).absent, 0.0);
}

/// Turning absence on under an open interaction gives every belief one entry more.
#[test]
fn absence_may_be_switched_while_a_question_stands() {
    let state = asked(&mut manager());
    let on = manager_with(&ABSENT).next(&state, &Cause::Reconfigured, at(2));
    assert_eq!((belief(&on).len(), on.act.kind), (7, ActKind::Ask));
    let off = manager().next(&on, &Cause::Reconfigured, at(3));
    assert_eq!(belief(&off), belief(&state));
}
