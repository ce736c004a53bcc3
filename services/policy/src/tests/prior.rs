//! What is believed before anything is said: alike, by history, or that it may not be here.

use super::*;
use setup::DialogueSettings;

fn manager_with(over: &[(&str, &str)]) -> Manager {
    settings_with(over).manager().unwrap()
}

pub(super) const HISTORY: [(&str, &str); 1] = [("dialogue.prior.objects", "history")];
const ABSENT: [(&str, &str); 1] = [("dialogue.prior.absent", "0.1")];

/// Has `name` asked for with every word that it has, and delivered.
fn deliver(manager: &mut Manager, state: &State, name: &str) -> State {
    let scene = settings().scene;
    let wanted = scene.object_named(name).unwrap();
    let base: Vec<_> = scene.vocabulary(wanted).flat_map(|word| [word; 4]).collect();
    let state = remark(manager, state, Reading { base, ..Reading::default() });
    let (pick, object) = state.act.pick.expect("sure enough");
    assert_eq!(object, wanted);
    manager.next(&state, &delivered(pick), at(state.applied.0))
}

#[test]
fn history_raises_the_prior_only_where_that_is_configured() {
    let mut manager = manager_with(&HISTORY);
    let mut state = manager.first();
    for name in ["clear", "clear", "metal", "clear"] {
        state = deliver(&mut manager, &state, name);
    }
    assert_eq!((state.history.of("clear"), state.history.of("metal")), (3, 1));
    let next = |manager: &mut Manager| belief(&remark(manager, &state, Reading::default()));
    let expected = [1.0, 1.0, 1.0, 2.0, 1.0, 4.0].map(|n| n / 10.0);
    for (p, expected) in next(&mut manager).iter().zip(expected) {
        assert!((p - expected).abs() < 1e-12, "{p} {expected}");
    }
    let uniform = next(&mut super::manager());
    assert!(uniform.iter().all(|p| (p - 1.0 / 6.0).abs() < 1e-12), "{uniform:?}");
}

#[test]
fn history_survives_another_scene() {
    let mut manager = manager_with(&HISTORY);
    let first = manager.first();
    let state = deliver(&mut manager, &first, "clear");
    let markers = settings_with(&[("group.scene", "markers")]);
    let there = markers.manager().unwrap().next(&state, &Cause::Reconfigured, at(99));
    let back = manager.next(&there, &Cause::Reconfigured, at(100));
    assert_eq!((back.history.of("clear"), back.history), (1, state.history));
}

#[test]
fn who_denies_everything_is_told_that_it_is_not_here() {
    let mut manager = manager_with(&ABSENT);
    let mut state = asked(&mut manager);
    assert_eq!(belief(&state).len(), 7);
    for _ in 2..40 {
        state = reply(&mut manager, &state, answer(Response::No));
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
        for _ in 2..30 {
            let truth = Answer::truthful(&model, state.act.question, wanted).reading(&model);
            state = reply(&mut manager, &state, truth);
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
