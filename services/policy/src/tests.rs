//! The policy's rules, on the shipped six bowls.

mod concede;
mod correct;
mod hand_over;
mod held_back;
mod kept;
mod long;
mod objects;
mod person;
mod pointing;
mod prior;
mod put_back;
mod queue;
mod reconfigure;
mod replies;
mod seconds;
mod set_aside;
mod stop;
mod turns;
mod words;

use crate::{In, Out, PolicyNode};
use config::Settings;
use dialogue::manager::{
    Cause, Interaction, Manager, Record, State, Utterance, refold, refold_since,
};
use dialogue::rendering;
use dialogue::{Answer, Belief, Model, Posterior};
use messages::WireCode;
use messages::{
    ArmStatus, AskedQuestion, FixedText, MessageRef, Observation, PickId, PresentationState,
    Presented, PromptId, UtteranceSeq, WireReading,
};
use scene::{Intent, ObjectId, Question, Reading, Response};
use service::{Effects, Event, Node, Span, Time};
use setup::DialogueSettings;
use std::path::Path;
use std::sync::OnceLock;
use vocabulary::{ActKind, Interpretation, Outcome, PickOutcome, PickPhase, Presentation, Rng};

/// The shipped ones. They are loaded once: whether the arm reaches every bowl takes its time.
fn settings() -> Settings {
    static SHIPPED: OnceLock<Settings> = OnceLock::new();
    SHIPPED.get_or_init(|| settings_with(&[])).clone()
}

fn settings_with(over: &[(&str, &str)]) -> Settings {
    let config = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../config"));
    let over: Vec<_> = over.iter().map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
    preflight::load(config, None, &over).unwrap_or_else(|e| panic!("{e}"))
}

fn manager() -> Manager {
    settings().manager().unwrap()
}

/// The shipped configuration with another planner.
pub(crate) fn manager_of(planner: &str) -> Manager {
    let mut settings = settings();
    settings.dialogue.planner = planner.to_owned();
    settings.manager().unwrap()
}

/// An utterance typed after that prompt had been said, if any had.
fn heard(seq: u64, prompt: PromptId, reading: Reading) -> Cause {
    Cause::Utterance(typed(seq, prompt, reading))
}

fn typed(seq: u64, prompt: PromptId, reading: Reading) -> Utterance {
    let accepted = at(seq);
    let began = Time(accepted.ns() - 500_000_000);
    let asking = Presentation {
        prompt,
        number: 1,
        began,
        ended: Some(began),
        complete: true,
        ..Presentation::default()
    };
    let asked = if prompt == PromptId(0) { Vec::new() } else { vec![asking] };
    let as_answer_to =
        |question| Interpretation { weight: 1.0, answers: question, reading: reading.clone() };
    let meant = (0..asked.len()).map(Some).chain([None]).map(as_answer_to).collect();
    let (seq, onset, end) = (UtteranceSeq(seq), accepted, accepted);
    Utterance {
        seq,
        presentations: asked,
        typed: true,
        onset,
        end,
        accepted,
        interpretations: meant,
        ..Utterance::default()
    }
}

fn answer(response: Response) -> Reading {
    Reading { response, ..Reading::default() }
}

fn at(seconds: u64) -> Time {
    Time(seconds * 1_000_000_000)
}

/// A reading of the scene's words.
fn words(words: &[&str]) -> Reading {
    let scene = settings().scene;
    let base = words.iter().map(|word| scene.word_named(word).expect("a word of the scene"));
    Reading { base: base.collect(), ..Reading::default() }
}

/// The state after the first utterance.
fn first(manager: &mut Manager, reading: Reading) -> State {
    let nothing_said = manager.first();
    remark(manager, &nothing_said, reading)
}

/// The state after an utterance that answers the standing prompt, typed a second per utterance.
fn reply(manager: &mut Manager, state: &State, reading: Reading) -> State {
    let seq = state.applied.0 + 1;
    manager.next(state, &heard(seq, state.act.prompt, reading), at(seq))
}

/// The state after an utterance that answers no prompt.
fn remark(manager: &mut Manager, state: &State, reading: Reading) -> State {
    let seq = state.applied.0 + 1;
    manager.next(state, &heard(seq, PromptId(0), reading), at(seq))
}

fn delivered(pick: PickId) -> Cause {
    Cause::PickEnded { pick, outcome: PickOutcome::Delivered }
}

/// A dialogue after the first request, with a question standing.
fn asked(manager: &mut Manager) -> State {
    let state = first(manager, Reading::default());
    assert_eq!(state.act.kind, ActKind::Ask);
    state
}

/// The English of the standing line.
fn text(state: &State) -> String {
    rendering::text(&settings().scene, &state.act)
}

fn belief(state: &State) -> Vec<f64> {
    state.open.as_ref().expect("an open interaction").belief().probabilities()
}

#[test]
fn a_late_answer_is_scored_against_the_question_that_was_heard() {
    let mut manager = manager();
    let first = asked(&mut manager);
    let second = reply(&mut manager, &first, answer(Response::Yes));
    assert_ne!(second.act.question, first.act.question, "another question stands now");
    // Said before the second question was heard: it can only be meant for the first.
    let late = manager.next(&second, &heard(3, first.act.prompt, answer(Response::Yes)), at(3));
    let Question::Attribute(k, v) = first.act.question else { panic!("{:?}", first.act) };
    let scene = settings().scene;
    let mass = |state: &State| -> f64 {
        let has = |i: &usize| scene.has(ObjectId::from(*i), k, v);
        belief(state).iter().enumerate().filter(|(i, _)| has(i)).map(|(_, p)| p).sum()
    };
    assert!(mass(&late) > mass(&second), "the first question's value gains once more");
    assert_eq!(late.act.prompt, second.act.prompt, "the unheard question is not said again");
}

#[test]
fn an_answer_to_nothing_begins_nothing() {
    let mut manager = manager();
    let state =
        manager.next(&manager.first(), &heard(1, PromptId(5), answer(Response::Yes)), at(1));
    assert_eq!((state.open, state.applied), (None, UtteranceSeq(1)));
}

#[test]
fn an_answer_to_another_interaction_s_question_changes_no_belief() {
    let mut manager = manager();
    let state = asked(&mut manager);
    let stale = PromptId(state.act.prompt.0 + 70);
    let after = manager.next(&state, &heard(2, stale, answer(Response::No)), at(2));
    assert_eq!(belief(&state), belief(&after));
}

#[test]
fn silence_repeats_the_same_question_and_then_ends_the_interaction() {
    let mut manager = manager();
    let mut state = asked(&mut manager);
    let first = state.act.clone();
    for n in 1..=manager.turns().repeats_max {
        state = manager.next(&state, &Cause::Silence, at(10 * u64::from(n)));
        assert_eq!((state.act.prompt, state.act.presentation), (first.prompt, 1 + n));
        assert_eq!(state.open.as_ref().map(|open| open.questions), Some(1));
    }
    state = manager.next(&state, &Cause::Silence, at(100));
    assert_eq!(state.ended.map(|ended| ended.outcome), Some(Outcome::Abandoned));
}

#[test]
fn starting_over_forgets_what_was_said() {
    let mut manager = manager();
    let state = asked(&mut manager);
    let informed = reply(&mut manager, &state, answer(Response::Yes));
    let over = Reading { intent: Intent::StartOver, ..Reading::default() };
    let over = reply(&mut manager, &informed, over);
    assert_eq!(belief(&over), belief(&state));
}

/// Speaks to the reducer as grounding would.
fn observation(seq: u64, prompt: u64, reading: &Reading) -> In<'static> {
    let mut observation = Observation {
        seq,
        scene_key: settings().scene.key(),
        reading_count: 1,
        unknown: FixedText::default(),
        ..Observation::default()
    };
    if prompt > 0 {
        observation.asked_count = 1;
        observation.asked[0] = AskedQuestion { prompt, whole: 1, ..AskedQuestion::default() };
    }
    let question = (prompt > 0).then_some(0);
    let meant = Interpretation { weight: 1.0, answers: question, reading: reading.clone() };
    observation.readings[0] = WireReading::new(&meant).0;
    In::Observation(MessageRef::from(observation))
}

fn tell(node: &mut PolicyNode, message: In<'_>, now: Time) -> (Vec<Record>, Vec<Out>) {
    let mut effects = Effects::default();
    node.on(Event::Message(message), now, &mut effects);
    (effects.take_records(), effects.take_outputs())
}

#[test]
fn each_utterance_is_applied_once_and_in_order() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let request = |seq| observation(seq, 0, &Reading::default());
    assert!(tell(&mut node, request(2), at(1)).0.is_empty(), "the first is missing");
    assert!(node.pending_since().is_some(), "the operator sees that something waits");
    assert_eq!(tell(&mut node, request(1), at(2)).0.len(), 1);
    assert!(tell(&mut node, request(1), at(3)).0.is_empty(), "a repeat changes nothing");
    assert_eq!(tell(&mut node, request(2), at(4)).0.len(), 1);
    assert_eq!(node.state().applied, UtteranceSeq(2));
}

#[test]
fn an_observation_that_makes_no_sense_is_refused_and_comes_again() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let In::Observation(good) = observation(1, 0, &Reading::default()) else { unreachable!() };
    let other_scene = Observation { scene_key: good.scene_key ^ 1, ..*good };
    let no_readings = Observation { reading_count: 0, ..*good };
    for bad in [other_scene, no_readings] {
        assert!(tell(&mut node, In::Observation(bad.into()), at(1)).0.is_empty());
        assert_eq!(node.state().applied, UtteranceSeq(0));
    }
    assert_eq!(tell(&mut node, In::Observation(good), at(2)).0.len(), 1);
}

#[test]
fn silence_counts_from_the_end_of_the_spoken_question() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    tell(&mut node, observation(1, 0, &Reading::default()), at(1));
    let act = node.state().act.clone();
    let silent = |node: &mut PolicyNode, now| {
        let mut effects: Effects<Out, Record> = Effects::default();
        node.on(Event::Tick, now, &mut effects);
        effects.take_records().iter().any(|record| record.cause == Cause::Silence)
    };
    assert!(!silent(&mut node, at(1000)), "no one has heard it yet");
    let said = Presented {
        prompt: act.prompt.0,
        presentation: act.presentation,
        state: PresentationState::Ended.code(),
        ended_ns: at(1000).ns(),
        ..Presented::default()
    };
    // Speech says it again all the time, but for an hour in which it is down; then the policy is.
    let says = |node: &mut PolicyNode, from: Time, until: Time| {
        let mut now = from;
        while now < until {
            tell(node, In::Presented(said), now);
            assert!(!silent(node, now), "{now:?}");
            now = now + Span::from_ms(250);
        }
    };
    let window = Span::from_s(manager().turns().response_window_s);
    let (down, up) = (at(1000) + window - Span::from_ms(1_100), at(4600));
    says(&mut node, at(1000), down);
    assert!(!silent(&mut node, up), "speech is down");
    says(&mut node, up, up + Span::from_ms(1));
    assert!(silent(&mut node, up + Span::from_ms(500)));
    let record = Record { cause: Cause::Snapshot, at: up, state: node.state().clone() };
    let mut node = PolicyNode::recover(manager().into(), vec![record]).unwrap();
    let again = Presented { presentation: 2, ended_ns: up.ns(), ..said };
    tell(&mut node, In::Presented(again), at(8000));
    assert!(!silent(&mut node, at(8000)), "the policy was down");
}

/// Whole dialogues with a person who sometimes lies, falls silent, speaks late or starts over: the
/// journal folds again to the same states, and recovery from any prefix gives its last state. So it is
/// with gestures, and where deliveries, the user or the robot's own seconds count.
#[test]
fn journals_fold_again_bit_for_bit() {
    let cases: [(&[(&str, &str)], u64); 5] = [
        (&[], 40),
        (&pointing::GESTURES, 8),
        (&prior::HISTORY, 8),
        (&person::LEARNING, 3),
        (&seconds::POINTING, 3),
    ];
    for (over, seeds) in cases {
        let settings = settings_with(over);
        let manager = || settings.manager().unwrap();
        for seed in 0..seeds {
            let records = random_dialogue(&settings, seed);
            refold(&mut manager(), &records).unwrap_or_else(|e| panic!("{over:?}, {seed}: {e}"));
            for cut in 0..records.len() {
                let node = PolicyNode::recover(manager().into(), records[..=cut].to_vec()).unwrap();
                assert_eq!(node.state(), &records[cut].state, "{over:?}, seed {seed}, {cut}");
            }
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
fn shift(open: &mut Interaction, by: f64) {
    let mut log = open.belief().log_weights().to_vec();
    log[0] += by;
    open.posterior = Posterior::Object(Belief::from_log(log).unwrap());
}

fn random_dialogue(settings: &Settings, seed: u64) -> Vec<Record> {
    let (mut rng, mut manager) = (Rng::new(seed), settings.manager().unwrap());
    let model = Model::new(&settings.scene, settings.dialogue.params);
    let wanted = ObjectId::from(rng.below(6));
    let (mut state, mut records, mut seq) = (manager.first(), Vec::new(), 0);
    for turn in 1..25 {
        let mut cause = random_cause(&mut rng, &model, &state, wanted, &mut seq);
        if let (true, Cause::Utterance(heard)) = (settings.dialogue.gesture.enabled, &mut cause) {
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

/// What a planner that was swapped in has decided folds again, though the settings name another.
#[test]
fn decisions_of_a_planner_swapped_in_fold_again_with_it() {
    let settings = settings();
    let swapped_in = |key| settings.manager_of_key(key).unwrap().planner();
    assert_eq!(swapped_in(manager().key()), "lookahead");
    assert_eq!(swapped_in(1), "lookahead", "a key of other settings");
    let key = settings.manager_key("always-ask");
    assert_ne!(key, manager().key());
    assert_eq!(swapped_in(key), "always-ask");
}

#[test]
fn only_the_ordered_pick_s_end_ends_the_interaction() {
    let mut node = PolicyNode::recover(manager().into(), Vec::new()).unwrap();
    let sure = words(&["small", "white", "plastic", "dishwasher", "dishwasher", "dishwasher"]);
    tell(&mut node, observation(1, 0, &sure), at(1));
    let (pick, object) = node.state().act.pick.expect("sure enough to pick");
    let done = |interaction| ArmStatus {
        interaction,
        attempt: pick.attempt,
        object: object.0.into(),
        phase: PickPhase::Done.code(),
        outcome: PickOutcome::Delivered.code(),
        ..ArmStatus::default()
    };
    assert!(tell(&mut node, In::Arm(done(pick.interaction.0 + 1)), at(2)).0.is_empty());
    assert_eq!(tell(&mut node, In::Arm(done(pick.interaction.0)), at(3)).0.len(), 1);
    assert!(tell(&mut node, In::Arm(done(pick.interaction.0)), at(4)).0.is_empty());
    assert_eq!(node.state().ended.as_ref().map(|e| e.object), Some(Some(object)));
}
