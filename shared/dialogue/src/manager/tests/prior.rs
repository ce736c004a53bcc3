//! Priors of the belief: uniform, by history, or with a possibly absent object.

use super::fixture::{
    Change, Settings, answer, asked, at, belief, delivered, manager, markers, remark, reply,
    settings, settings_with, text,
};
use crate::manager::{Cause, Manager, State};
use crate::{Answer, Model};
use scene::{ObjectId, Reading, Response};
use vocabulary::{ActKind, Outcome, PriorObjects};

pub(super) fn by_history(settings: &mut Settings) {
    settings.prior.objects = PriorObjects::History;
}

fn perhaps_absent(settings: &mut Settings) {
    settings.prior.absent = 0.1;
}

fn manager_with(change: Change) -> Manager {
    settings_with(change).manager()
}

/// Requests `name` with every word that it has, up to its delivery.
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
    let mut manager = manager_with(by_history);
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
    let uniform = next(&mut settings().manager());
    assert!(uniform.iter().all(|p| (p - 1.0 / 6.0).abs() < 1e-12), "{uniform:?}");
}

#[test]
fn history_survives_another_scene() {
    let mut manager = manager_with(by_history);
    let first = manager.first();
    let state = deliver(&mut manager, &first, "clear");
    let markers = markers();
    let there = markers.manager().next(&state, &Cause::Reconfigured, at(99));
    let back = manager.next(&there, &Cause::Reconfigured, at(100));
    assert_eq!((back.history.of("clear"), back.history), (1, state.history));
}

#[test]
fn a_user_who_denies_everything_is_told_that_it_is_not_here() {
    let mut manager = manager_with(perhaps_absent);
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
fn an_object_that_is_here_is_fetched_though_it_might_not_be_here() {
    let settings = settings_with(perhaps_absent);
    let model = Model::new(&settings.scene, settings.params);
    for wanted in (0..6).map(ObjectId::from) {
        let mut manager = manager_with(perhaps_absent);
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

/// Turning absence on under an open interaction gives every belief one entry more.
#[test]
fn absence_may_be_switched_while_a_question_stands() {
    let state = asked(&mut manager());
    let on = manager_with(perhaps_absent).next(&state, &Cause::Reconfigured, at(2));
    assert_eq!((belief(&on).len(), on.act.kind), (7, ActKind::Ask));
    let off = manager().next(&on, &Cause::Reconfigured, at(3));
    assert_eq!(belief(&off), belief(&state));
}
