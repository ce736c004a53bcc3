//! The view's keys are a contract with scripts and pages. `WHICHONE_BLESS=1` rewrites the golden
//! file.

use super::*;
use messages::{
    ActKind, Activity, Delivery, Ended, FixedText, InteractionId, Outcome, PolicyView,
    PresentationState, Presented, PromptId, Receipt, ReceiptStatus, UtteranceSeq,
};
use scene::{AttributeId, Question, ValueId};
use vocabulary::{Action, Attributed, QuestionShare};

const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");
const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/view.json");

fn policy_view(scene: &Scene) -> PolicyView {
    PolicyView {
        scene_key: scene.key(),
        applied: 3,
        interaction: 7,
        from: "Ann".to_owned(),
        belief: vec![0.5, 0.25, 0.125, 0.125, 0.0, 0.0],
        absent: 0.0,
        person: Some((0.9, 0.05)),
        question: Question::Attribute(AttributeId::from(0), ValueId::from(0)),
        prompt: 5,
        text: "Is it white?".to_owned(),
        decision: ActKind::Ask,
        alternatives: vec![
            (Action::Wait, 40.5),
            (Action::Ask(Question::Which(AttributeId::from(1))), 40.0),
            (Action::Pick(1.into()), -25.0),
            (Action::Pick(6.into()), -30.0),
        ],
        attributed: Attributed {
            utterance: UtteranceSeq(3),
            questions: vec![QuestionShare { prompt: PromptId(4), presentation: 1, share: 0.75 }],
            none: 0.25,
        },
        value: 41.25,
        bounds: Some((41.0, 41.5)),
        questions: 1,
        expected_questions: 0.5,
        planner: "lookahead".to_owned(),
        last: Some(Ended {
            interaction: InteractionId(6),
            object: Some(1.into()),
            name: Some("white2".to_owned()),
            outcome: Outcome::Delivered,
            questions: 2,
            seconds: 12.5,
            utterances: (UtteranceSeq(1), UtteranceSeq(2)),
        }),
        refusable: Some(Delivery { interaction: 6, object: 1, until_ns: 90_000_000_000 }),
        ..PolicyView::default()
    }
}

fn asked() -> Latest {
    let scene = Scene::from_toml("bowls.toml", BOWLS).unwrap();
    let state = PresentationState::Ended.into();
    let presented = Presented { prompt: 5, presentation: 1, state, ..Presented::default() };
    let activity = Some(Activity::default());
    Latest {
        view: Some(policy_view(&scene)),
        presented,
        activity,
        accepted: 3,
        ..Latest::default()
    }
}

#[test]
fn view_keeps_its_keys() {
    let scene = Scene::from_toml("bowls.toml", BOWLS).unwrap();
    let latest = asked();
    let hearing = Hearing {
        microphone: MicrophoneState::Listening.into(),
        level_db: -31.4,
        note: FixedText::truncated("arecord"),
        ..Hearing::default()
    };
    let arm = ArmStatus {
        interaction: 7,
        object: 1,
        phase: PickPhase::Moving.into(),
        hindrance: MotionInhibit::None.into(),
        moving: 1,
        remaining_s: 3.26,
        ..ArmStatus::default()
    };
    let view = View {
        dialogue: latest.dialogue(&scene),
        said: vec![SaidView { who: Speaker::Robot, text: "Is it white?" }],
        hearing: Some(HearingView::new(&hearing)),
        arm: Some(ArmView::new(&scene, &arm)),
        group: Some(&()),
    };
    let text = serde_json::to_string_pretty(&view).unwrap() + "\n";
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        std::fs::write(GOLDEN, &text).unwrap();
    }
    let golden = std::fs::read_to_string(GOLDEN).unwrap();
    assert_eq!(text, golden, "if the change is intended, run this test with WHICHONE_BLESS=1");
}

#[test]
fn latest_is_settled_once_the_view_holds_every_accepted_utterance() {
    let settled = asked();
    assert!(settled.is_settled());
    assert!(!Latest { accepted: 4, ..settled.clone() }.is_settled());
    let recognising = Some(Activity { pending: 1, ..Activity::default() });
    assert!(!Latest { activity: recognising, ..settled.clone() }.is_settled());
    assert!(!Latest { activity: None, ..settled.clone() }.is_settled());
    assert!(!Latest { view: None, ..settled }.is_settled());
    for (status, settles) in [(ReceiptStatus::Refused, true), (ReceiptStatus::Accepted, false)] {
        let mut latest = asked();
        latest.on_receipt(&Receipt { seq: 9, status: status.into(), ..Receipt::default() });
        assert_eq!(latest.is_settled(), settles, "{status:?}");
    }
}

#[test]
fn latest_question_is_open_from_the_end_of_its_presentation() {
    let mut latest = asked();
    assert_eq!(latest.open_question(), Some((5, 1)));
    latest.presented.state = PresentationState::Speaking.into();
    assert_eq!(latest.open_question(), None);
    assert_eq!(latest.presented_line(), Some(((5, 1), "Is it white?")));
    latest.presented.prompt = 4;
    assert_eq!(latest.presented_line(), None);
}
