//! The service around the dialogue manager, on the shipped six bowls. The rules of the dialogue are
//! tested beside the manager (`shared/dialogue/src/manager/tests`).

mod arm;
mod journal;
mod objects;
mod people;
mod set_aside;
mod settings;
mod stop;
mod turns;
mod views;

use crate::{In, Out, PolicyNode};
use config::Settings;
use dialogue::manager::{Cause, Manager, Record, State, Utterance, refold};
use dialogue::rendering;
use messages::WireCode;
use messages::{
    ArmStatus, AskedQuestion, FixedText, MessageRef, Observation, PickId, PresentationState,
    Presented, PromptId, UtteranceSeq, WireReading,
};
use scene::{Intent, ObjectId, Reading, Response};
use service::{Effects, Event, Node, Span, Time};
use setup::DialogueSettings;
use std::path::Path;
use std::sync::OnceLock;
use vocabulary::{ActKind, Interpretation, Outcome, PickOutcome, PickPhase, Presentation};

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

/// An utterance that answers no prompt.
fn heard(seq: u64, reading: Reading) -> Cause {
    let meant = Interpretation { weight: 1.0, answers: None, reading };
    Cause::Utterance(Utterance {
        seq: UtteranceSeq(seq),
        typed: true,
        onset: at(seq),
        end: at(seq),
        accepted: at(seq),
        interpretations: vec![meant],
        ..Utterance::default()
    })
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

/// The state after an utterance that answers no prompt.
fn remark(manager: &mut Manager, state: &State, reading: Reading) -> State {
    let seq = state.applied.0 + 1;
    manager.next(state, &heard(seq, reading), at(seq))
}

/// The state after the clear bowl was handed over.
fn handed_over(manager: &mut Manager) -> State {
    let state = first(manager, words(&["clear"]));
    let (pick, _): (PickId, _) = state.act.pick.expect("a unique description");
    let delivered = Cause::PickEnded { pick, outcome: PickOutcome::Delivered };
    manager.next(&state, &delivered, at(state.applied.0 + 1))
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
