//! Messages folded into the view model, in the order and number in which services really send them.

use super::line::{Line, Recognisers};
use super::*;
use messages::{
    ActKind, Ended, FixedText, GateVerdict, InteractionId, Interpretation, MicrophoneState,
    Outcome, PickPhase, PresentationState, PromptId, ReceiptStatus, SecondState, UtteranceSeq,
    WireReading,
};
use scene::{AttributeId, Question, Reading, Response, ValueId};
use serde_json::{Map, Value as Json};
use service::view::Speaker;
use vocabulary::{Attributed, QuestionShare};

const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");
const WHITE: Question = Question::Attribute(AttributeId(0), ValueId(0));

fn scene() -> Scene {
    Scene::from_toml("bowls.toml", BOWLS).unwrap()
}

fn model() -> ViewModel {
    ViewModel::new(scene(), Transcript::after(Vec::new(), 1_000))
}

fn now(s: u64) -> Now {
    Now { at: Time(s * 1_000_000_000), unix_ms: 1_700_000_000_000 + s * 1_000 }
}

fn receipt(seq: u64, status: ReceiptStatus, text: &str) -> Receipt {
    Receipt {
        seq,
        status: status.into(),
        confidence: 1.0,
        onset_ns: seq * 1_000_000_000,
        end_ns: seq * 1_000_000_000,
        note: FixedText::truncated(text),
        ..Receipt::default()
    }
}

fn asks(prompt: u64, interaction: u64) -> RobotAct {
    RobotAct {
        prompt,
        interaction,
        presentation: 1,
        kind: ActKind::Ask.into(),
        question: WHITE.into(),
        scene_key: scene().key(),
        text: FixedText::truncated("Is it the white one?"),
        ..RobotAct::default()
    }
}

fn said(prompt: u64, presentation: u32) -> Presented {
    let state = PresentationState::Ended.into();
    Presented { prompt, presentation, started_ns: 5, ended_ns: 6, state, ..Presented::default() }
}

/// "No" to the question of a prompt.
fn no(seq: u64, prompt: u64) -> Observation {
    let reading = Reading { response: Response::No, ..Reading::default() };
    let means =
        |answers, reading| WireReading::new(&Interpretation { weight: 1.0, answers, reading }).0;
    let mut observation = Observation {
        seq,
        scene_key: scene().key(),
        onset_ns: 10,
        reading_count: 2,
        asked_count: 1,
        ..Observation::default()
    };
    observation.readings[0] = means(Some(0), reading);
    observation.readings[1] = means(None, Reading::default());
    observation.asked[0].prompt = prompt;
    observation.asked[0].presentation = 1;
    observation.asked[0].question = WHITE.into();
    observation.asked[0].scene = scene().key();
    observation
}

fn view(interaction: u64, last: Option<Ended>) -> PolicyView {
    PolicyView { scene_key: scene().key(), interaction, last, ..PolicyView::default() }
}

fn delivered(interaction: u64) -> Ended {
    Ended {
        interaction: InteractionId(interaction),
        object: Some(1.into()),
        name: Some("white2".to_owned()),
        outcome: Outcome::Delivered,
        questions: 1,
        seconds: 2.5,
        utterances: (UtteranceSeq(1), UtteranceSeq(2)),
    }
}

fn texts(model: &mut ViewModel) -> Vec<String> {
    model.transcript().lines().map(|line| line.text.clone()).collect()
}

#[test]
fn view_model_ignores_repeated_messages() {
    let mut model = model();
    for _ in 0..3 {
        model.on_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
        model.on_view(view(1, None), now(1));
        model.on_act(&asks(4, 1));
        model.on_presented(said(4, 1), true, now(2));
        model.on_observation(&no(1, 4));
        model.on_view(view(0, Some(delivered(1))), now(3));
    }
    let expected = [
        "get me the bowl",
        "Is it the white one?",
        "Handed over: white bowl on the counter (1 question, 2.5 s)",
    ];
    assert_eq!(texts(&mut model), expected);
    let events = model.take_events();
    let count = |is: fn(&DialogueEvent) -> bool| events.iter().filter(|event| is(event)).count();
    assert_eq!(count(|event| matches!(event, DialogueEvent::Heard(_))), 1);
    assert_eq!(count(|event| matches!(event, DialogueEvent::Asked { .. })), 1);
}

/// As `view`, after the policy has attributed utterance 2 with these shares.
fn attributed(shares: &[(u64, f64)], none: f64) -> PolicyView {
    let question =
        |&(prompt, share)| QuestionShare { prompt: PromptId(prompt), presentation: 1, share };
    let questions = shares.iter().map(question).collect();
    let attributed = Attributed { utterance: UtteranceSeq(2), questions, none };
    PolicyView { attributed, ..view(1, None) }
}

#[test]
fn transcript_shows_the_policys_attribution_in_any_order_of_messages() {
    for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0], [2, 1, 0]] {
        let mut model = model();
        model.on_act(&asks(3, 1));
        model.on_act(&RobotAct { text: FixedText::truncated("Is it big?"), ..asks(4, 1) });
        for step in order {
            match step {
                0 => model.on_receipt(&receipt(2, ReceiptStatus::Accepted, "no"), now(2)),
                1 => model.on_observation(&no(2, 4)),
                _ => model.on_view(attributed(&[(3, 0.75), (4, 0.2)], 0.05), now(2)),
            }
        }
        let line = model.transcript().lines().next().unwrap().clone();
        // The earlier question has the larger share, although the later one was the latest asked.
        let answers: Vec<(&str, f64)> =
            line.answers.iter().map(|a| (a.question.as_str(), a.share)).collect();
        assert_eq!(answers, [("Is it the white one?", 0.75), ("Is it big?", 0.2)], "{order:?}");
        assert_eq!(line.understood[0].text, "no");
        assert_eq!((line.who, line.source.as_str()), (Speaker::Person, "typed"));
    }
}

#[test]
fn transcript_shows_no_question_for_an_utterance_that_answers_none() {
    let mut model = model();
    model.on_act(&asks(4, 1));
    model.on_receipt(&receipt(2, ReceiptStatus::Accepted, "no"), now(2));
    model.on_observation(&no(2, 4));
    model.on_view(attributed(&[], 1.0), now(2));
    let line = model.transcript().lines().find(|line| line.seq == Some(2)).unwrap().clone();
    assert_eq!((line.answers.len(), line.understood[0].text.as_str()), (0, "a request"));
}

#[test]
fn transcript_shows_speech_not_for_the_robot_but_no_refusals() {
    let mut model = model();
    model.on_receipt(&receipt(0, ReceiptStatus::NotForMe, "nice weather"), now(1));
    model.on_receipt(&receipt(0, ReceiptStatus::Refused, "too long"), now(1));
    model.on_receipt(&receipt(0, ReceiptStatus::Over, ""), now(1));
    let lines: Vec<(Speaker, String)> =
        model.transcript().lines().map(|line| (line.who, line.text.clone())).collect();
    assert_eq!(lines, [(Speaker::Unmeant, "nice weather".to_owned())]);
}

#[test]
fn transcript_shows_what_each_recogniser_heard_and_why_nothing_followed() {
    let mut model = model();
    let text = |text: &str| FixedText::truncated(text);
    let heard = Receipt {
        verdict: GateVerdict::OtherTalk.code(),
        second: SecondState::Heard.code(),
        first_text: text("the kite bowl"),
        second_text: text("nice weather"),
        ..receipt(0, ReceiptStatus::NotForMe, "nice weather")
    };
    model.on_receipt(&heard, now(1));
    let late = Receipt { second: SecondState::Late.code(), second_text: text(""), ..heard };
    let late = Receipt { first_text: text("the bowl"), ..late };
    model.on_receipt(&Receipt { seq: 4, status: ReceiptStatus::Accepted.code(), ..late }, now(2));
    let lines: Vec<_> = model.transcript().lines().cloned().collect();
    let views = |first: &str, second: Option<&str>| {
        Some(Recognisers { first: first.to_owned(), second: second.map(str::to_owned) })
    };
    assert_eq!(lines[0].verdict, Some(GateVerdict::OtherTalk));
    assert_eq!(lines[0].recognisers, views("the kite bowl", Some("nice weather")));
    assert_eq!((lines[1].verdict, &lines[1].recognisers), (None, &views("the bowl", None)));
    assert!(lines[0].to_text().contains(r#""verdict":"other_talk""#), "{}", lines[0].to_text());
}

#[test]
fn transcript_continues_its_predecessor() {
    let mut model = model();
    model.on_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
    let kept: Vec<Line> = model.transcript().lines().cloned().collect();
    let mut again = ViewModel::new(scene(), Transcript::after(kept.clone(), 9_000));
    again.on_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
    again.on_receipt(&receipt(2, ReceiptStatus::Accepted, "the white one"), now(2));
    let ids: Vec<u64> = again.transcript().lines().map(|line| line.id).collect();
    assert_eq!(ids, [1_000, 1_001], "numbers continue, and no line is repeated");
    let fresh = Transcript::after(Vec::new(), 9_000);
    assert_eq!(fresh.lines().count(), 0);
}

#[test]
fn view_model_makes_sections_after_a_change() {
    let mut model = model();
    let names = |model: &mut ViewModel| -> Vec<&'static str> {
        model.sections(now(1)).into_iter().map(|(name, _)| name).collect()
    };
    assert_eq!(
        names(&mut model),
        ["scene", "further", "speaking", "arm", "trajectory", "latency", "turn"]
    );
    assert!(names(&mut model).is_empty());
    model.on_view(view(0, None), now(1));
    assert_eq!(
        names(&mut model),
        ["further", "dialogue", "speaking", "arm", "trajectory", "latency", "turn"]
    );
    let other = PolicyView { scene_key: 7, ..view(0, None) };
    model.on_view(other, now(1));
    assert!(model.is_of_another_scene());
    assert!(!names(&mut model).contains(&"dialogue"), "object numbers are of another scene");
}

/// The page's sections are a contract with scripts. `WHICHONE_BLESS=1` rewrites the golden file.
#[test]
fn view_model_sections_keep_their_keys() {
    const GOLDEN: &str =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/page_sections.json");
    let mut model = model();
    model.on_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
    model.on_act(&asks(4, 1));
    model.on_presented(said(4, 1), true, now(2));
    model.on_view(
        PolicyView { belief: vec![0.5, 0.5, 0.0, 0.0, 0.0, 0.0], ..view(1, None) },
        now(2),
    );
    model.on_hearing(Hearing { microphone: MicrophoneState::Off.into(), ..Hearing::default() });
    model.on_arm(ArmStatus { phase: PickPhase::Idle.into(), ..ArmStatus::default() }, now(2));
    let world = WorldView {
        numbers: Vec::new(),
        at_ns: 1,
        objects: vec![Some([0.5, 0.0, 0.1, 0.0, 0.0, 0.0, 1.0]), None],
        held: None,
        grippers: [[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]; 2],
    };
    model.on_world(world);
    let sections = model.sections(now(3)).into_iter();
    let sections: Map<String, Json> = sections
        .map(|(name, text)| (name.to_owned(), serde_json::from_str(&text).unwrap()))
        .collect();
    let text = serde_json::to_string_pretty(&sections).unwrap() + "\n";
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::write(GOLDEN, &text).unwrap();
    }
    let golden = std::fs::read_to_string(GOLDEN).unwrap();
    assert_eq!(text, golden, "if the change is intended, run this test with WHICHONE_BLESS=1");
}

#[test]
fn transcript_notes_a_motion_stop_and_its_release_once() {
    let mut model = model();
    let stopped = |stopped| ArmStatus { stopped, ..ArmStatus::default() };
    for (n, state) in [0, 1, 1, 0, 0].into_iter().enumerate() {
        model.on_arm(stopped(state), now(n as u64));
    }
    assert_eq!(texts(&mut model), ["The arm was stopped", "The arm may move again"]);
}

#[test]
fn arm_that_is_silent_is_unknown() {
    let mut model = model();
    let stopped = ArmStatus { stopped: 1, ..ArmStatus::default() };
    model.on_arm(stopped, now(1));
    model.tick(now(2));
    assert!(model.latest().arm.is_some());
    model.tick(now(3));
    let sections = model.sections(now(3));
    let arm = sections.iter().find(|(name, _)| *name == "arm").map(|(_, text)| text.as_str());
    assert_eq!(arm, Some("null"));
    // It is back, and as it was: that is nothing new.
    model.on_arm(stopped, now(4));
    let said = model.transcript().lines().filter(|line| line.text == "The arm was stopped");
    assert_eq!(said.count(), 1);
}
