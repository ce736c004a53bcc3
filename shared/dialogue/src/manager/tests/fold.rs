//! Journals fold again.

use super::fixture::{Change, Settings, answer, at, heard, manager, settings, settings_with};
use super::{person, seconds};
use crate::manager::{Cause, Interaction, Record, State, refold};
use crate::{Answer, Belief, Model, Posterior};
use scene::{Intent, ObjectId, Question, Reading, Response};
use vocabulary::ids::PromptId;
use vocabulary::{ActKind, PickOutcome, PriorObjects, Rng};

/// Whole dialogues with a person who sometimes lies, falls silent, speaks late or starts over: the
/// journal folds again to the same states. Also with gestures, or if deliveries or users count.
#[test]
fn journals_fold_again_bit_for_bit() {
    let cases: [(Change, u64); 5] = [
        (|_| {}, 8),
        (|it| it.gestures = true, 2),
        (|it| it.prior.objects = PriorObjects::History, 2),
        (person::learning, 1),
        (seconds::pointing, 1),
    ];
    for (n, (change, seeds)) in cases.into_iter().enumerate() {
        let settings = settings_with(change);
        for seed in 0..seeds {
            let records = random_dialogue(&settings, seed);
            let folded = refold(&mut settings.manager(), &records);
            folded.unwrap_or_else(|e| panic!("settings {n}, seed {seed}: {e}"));
        }
    }
}

#[test]
fn a_journal_that_was_tampered_with_is_told() {
    let mut records = random_dialogue(&settings(), 3);
    let open = records.iter_mut().find_map(|r| r.state.open.as_mut()).expect("a dialogue");
    shift(open, 1e-15);
    assert!(refold(&mut manager(), &records).is_err());
}

/// Shifts the first weight of an interaction's belief.
pub(super) fn shift(open: &mut Interaction, by: f64) {
    let mut log = open.belief().log_weights().to_vec();
    log[0] += by;
    open.posterior = Posterior::Object(Belief::from_log(log).unwrap());
}

pub(super) fn random_dialogue(settings: &Settings, seed: u64) -> Vec<Record> {
    let (mut rng, mut manager) = (Rng::new(seed), settings.manager());
    let model = Model::new(&settings.scene, settings.params);
    let wanted = ObjectId::from(rng.below(6));
    let (mut state, mut records, mut seq) = (manager.first(), Vec::new(), 0);
    for turn in 1..25 {
        let mut cause = random_cause(&mut rng, &model, &state, wanted, &mut seq);
        if let (true, Cause::Utterance(heard)) = (settings.gestures, &mut cause) {
            let shown = settings.scene.objects()[rng.below(6)].placement.unwrap();
            heard.gesture = (rng.below(2) == 0).then_some(shown.xyz);
        }
        state = manager.next(&state, &cause, at(turn));
        records.push(Record { cause, at: at(turn), state: state.clone() });
    }
    records
}

fn random_cause(
    rng: &mut Rng,
    model: &Model,
    state: &State,
    wanted: ObjectId,
    seq: &mut u64,
) -> Cause {
    if let Some((pick, _)) = state.open.as_ref().and_then(|open| open.pick) {
        let outcome = match (rng.below(3), state.act.kind) {
            (0, ActKind::Pick) => {
                *seq += 1;
                return heard(*seq, state.act.prompt, answer(Response::No));
            }
            (_, ActKind::Cancel) => PickOutcome::Cancelled,
            _ => PickOutcome::Delivered,
        };
        return Cause::PickEnded { pick, outcome };
    }
    if state.open.is_some() && rng.below(8) == 0 {
        return Cause::Silence;
    }
    *seq += 1;
    let reading = match (rng.below(10), state.act.question) {
        (0, _) => answer(Response::No),
        (1, _) => Reading { intent: Intent::StartOver, ..Reading::default() },
        (2, _) | (_, Question::None) => Reading::default(),
        (_, question) => Answer::truthful(model, question, wanted).reading(model),
    };
    let prompt = PromptId(state.act.prompt.0.saturating_sub(rng.below(2) as u64));
    heard(*seq, prompt, reading)
}
