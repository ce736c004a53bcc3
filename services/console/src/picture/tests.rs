//! Messages folded into the picture, in the order and number in which services really send them.

use super::*;
use ::dialogue::ids::{InteractionId, UtteranceSeq};
use ::scene::{AttributeId, Question, Reading, Response, ValueId};
use messages::WireCode;
use messages::{
    ActKind, Ended, FixedText, Interpretation, Outcome, PresentationState, ReceiptStatus,
    WireReading,
};

const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");
const WHITE: Question = Question::Attribute(AttributeId(0), ValueId(0));

fn scene() -> Scene {
    Scene::from_toml("bowls.toml", BOWLS).unwrap()
}

fn picture() -> Picture {
    Picture::new(scene(), Transcript::after(Vec::new(), 1_000))
}

fn now(s: u64) -> Now {
    Now { at: Time(s * 1_000_000_000), unix_ms: 1_700_000_000_000 + s * 1_000 }
}

fn receipt(seq: u64, status: ReceiptStatus, text: &str) -> Receipt {
    Receipt {
        seq,
        status: status.code(),
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
        kind: ActKind::Ask.code(),
        question: WHITE.into(),
        scene_key: scene().key(),
        text: FixedText::truncated("Is it the white one?"),
        ..RobotAct::default()
    }
}

fn said(prompt: u64, presentation: u32) -> Presented {
    let state = PresentationState::Ended.code();
    Presented { prompt, presentation, started_ns: 5, ended_ns: 6, state, ..Presented::default() }
}

/// "No" to the question of a prompt.
fn no(seq: u64, prompt: u64) -> Observation {
    let reading = Reading { response: Response::No, ..Reading::default() };
    let means = |question, reading| {
        WireReading::new(&Interpretation { weight: 1.0, answers: question, reading }).0
    };
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
        object: Some(::scene::ObjectId(1)),
        name: Some("white2".to_owned()),
        outcome: Outcome::Delivered,
        questions: 1,
        seconds: 2.5,
        utterances: (UtteranceSeq(1), UtteranceSeq(2)),
    }
}

fn texts(picture: &mut Picture) -> Vec<String> {
    picture.transcript().lines().map(|line| line.text.clone()).collect()
}

#[test]
fn what_is_repeated_changes_nothing() {
    let mut picture = picture();
    for _ in 0..3 {
        picture.see_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
        picture.see_view(view(1, None), now(1));
        picture.see_act(&asks(4, 1));
        picture.see_presented(said(4, 1), true, now(2));
        picture.see_observation(&no(1, 4));
        picture.see_view(view(0, Some(delivered(1))), now(3));
    }
    let expected = [
        "get me the bowl",
        "Is it the white one?",
        "Handed over: white bowl on the counter (1 question, 2.5 s)",
    ];
    assert_eq!(texts(&mut picture), expected);
    let events = picture.take_events();
    let count = |is: fn(&PictureEvent) -> bool| events.iter().filter(|event| is(event)).count();
    assert_eq!(count(|event| matches!(event, PictureEvent::Heard(_))), 1);
    assert_eq!(count(|event| matches!(event, PictureEvent::Said { .. })), 1);
    assert_eq!(count(|event| matches!(event, PictureEvent::Ended { .. })), 1);
}

#[test]
fn an_answer_is_told_with_its_question_whichever_comes_first() {
    for observation_first in [true, false] {
        let mut picture = picture();
        picture.see_view(view(1, None), now(1));
        picture.see_act(&asks(4, 1));
        if observation_first {
            picture.see_observation(&no(2, 4));
        }
        picture.see_receipt(&receipt(2, ReceiptStatus::Accepted, "no"), now(2));
        picture.see_observation(&no(2, 4));
        let line = picture.transcript().lines().next().unwrap().clone();
        assert_eq!(line.understood[0].text, "no", "{observation_first}");
        assert_eq!(line.answers.as_deref(), Some("Is it the white one?"));
        assert_eq!((line.who, line.source.as_str()), (Who::Person, "typed"));
    }
}

#[test]
fn a_question_of_another_interaction_is_not_answered() {
    let mut picture = picture();
    picture.see_act(&asks(4, 1));
    picture.see_view(view(2, Some(delivered(1))), now(1));
    picture.see_receipt(&receipt(2, ReceiptStatus::Accepted, "no"), now(2));
    picture.see_observation(&no(2, 4));
    let line = picture.transcript().lines().find(|line| line.seq == Some(2)).unwrap().clone();
    assert_eq!(line.answers, None);
}

#[test]
fn what_was_not_meant_for_the_robot_is_told_and_what_was_refused_is_not() {
    let mut picture = picture();
    picture.see_receipt(&receipt(0, ReceiptStatus::NotForMe, "nice weather"), now(1));
    picture.see_receipt(&receipt(0, ReceiptStatus::Refused, "too long"), now(1));
    picture.see_receipt(&receipt(0, ReceiptStatus::Over, ""), now(1));
    let lines: Vec<(Who, String)> =
        picture.transcript().lines().map(|line| (line.who, line.text.clone())).collect();
    assert_eq!(lines, [(Who::Unmeant, "nice weather".to_owned())]);
}

#[test]
fn a_transcript_goes_on_where_the_one_before_ended() {
    let mut picture = picture();
    picture.see_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
    let kept: Vec<Line> = picture.transcript().lines().cloned().collect();
    let mut again = Picture::new(scene(), Transcript::after(kept.clone(), 9_000));
    again.see_receipt(&receipt(1, ReceiptStatus::Accepted, "get me the bowl"), now(1));
    again.see_receipt(&receipt(2, ReceiptStatus::Accepted, "the white one"), now(2));
    let ids: Vec<u64> = again.transcript().lines().map(|line| line.id).collect();
    assert_eq!(ids, [1_000, 1_001], "numbers go on, and nothing is told twice");
    let fresh = Transcript::after(Vec::new(), 9_000);
    assert_eq!(fresh.lines().count(), 0);
}

#[test]
fn a_section_is_told_when_it_may_have_changed() {
    let mut picture = picture();
    let names = |picture: &mut Picture| -> Vec<&'static str> {
        picture.sections(now(1)).into_iter().map(|(name, _)| name).collect()
    };
    assert_eq!(names(&mut picture), ["scene", "trajectory", "turn"]);
    assert!(names(&mut picture).is_empty());
    picture.see_view(view(0, None), now(1));
    assert_eq!(names(&mut picture), ["dialogue"]);
    picture.see_arm(ArmStatus::default(), now(1));
    assert_eq!(names(&mut picture), ["arm", "turn"]);
    let other = PolicyView { scene_key: 7, ..view(0, None) };
    picture.see_view(other, now(1));
    assert!(picture.is_of_another_scene());
    assert!(names(&mut picture).is_empty(), "nobody reads another scene's numbers");
}

#[test]
fn a_stop_is_told_once_each_way() {
    let mut picture = picture();
    let stopped = |stopped| ArmStatus { stopped, ..ArmStatus::default() };
    for (n, state) in [0, 1, 1, 0, 0].into_iter().enumerate() {
        picture.see_arm(stopped(state), now(n as u64));
    }
    assert_eq!(texts(&mut picture), ["The arm was stopped", "The arm may move again"]);
}

#[test]
fn joints_are_told_with_as_many_digits_as_are_seen() {
    let mut states = JointStates { at_ns: 1_500_000, ..JointStates::default() };
    states.position[3] = 0.123_456_789;
    states.gripper_percent = [99.99, 0.0];
    let frame: Json = serde_json::from_str(&joints(&states)).unwrap();
    assert_eq!((&frame["at_ms"], &frame["q"][3]), (&json!(1.5), &json!(0.12346)));
    assert_eq!(frame["grip"], json!([100.0, 0.0]));
}
