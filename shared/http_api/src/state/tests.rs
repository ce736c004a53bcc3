use messages::{Code, FixedText, InteractionId, PolicyView, UtteranceSeq};
use scene::{AttributeId, Options, ValueId};
use serde_json::{Value as Json, json};
use service::status::GroupStatus;
use vocabulary::Ended;

use super::*;

const BOWLS: &str = include_str!("../../../../config/scenes/bowls.toml");

fn bowls() -> Scene {
    Scene::from_toml("bowls.toml", BOWLS).unwrap()
}

fn group(arm: &str) -> GroupStatus {
    let service = |name: &str, state: &str| {
        let actual = if state == "ready" { "ready" } else { "down" };
        json!({ "name": name, "wanted": "up", "actual": actual, "state": state, "incarnation": 1,
                "restarts": 0 })
    };
    let services: Vec<Json> = ["speech", "grounding", "policy"]
        .iter()
        .map(|name| service(name, "ready"))
        .chain([service("arm", arm)])
        .collect();
    let group = json!({
        "name": "lab", "state": "ready", "supervisor_pid": 7, "version": "0", "epoch": 1,
        "uptime_s": 1.0, "scene": "bowls", "config": "/c", "strays_killed": 0, "services": services,
    });
    serde_json::from_value(group).unwrap()
}

fn view(interaction: u64, decision: ActKind, question: Question) -> PolicyView {
    PolicyView {
        interaction,
        decision,
        question,
        scene_key: bowls().key(),
        applied: 5,
        prompt: 3,
        text: "Is it white?".to_owned(),
        utterances: (4, 5),
        belief: vec![0.5, 0.5, 0.0, 0.0, 0.0, 0.0],
        ..PolicyView::default()
    }
}

fn answers(acts: &[RobotAct]) -> Answers {
    let mut answers = Answers::default();
    for act in acts {
        answers.add(act);
    }
    answers
}

/// An act that answers an utterance.
fn act(utterance: u64) -> RobotAct {
    RobotAct { utterance, ..RobotAct::default() }
}

fn state_after(view: Option<PolicyView>, arm: ArmStatus, acts: &[RobotAct]) -> State {
    let latest = Latest { view, arm: Some(arm), ..Latest::default() };
    let (scene, group) = (bowls(), group("ready"));
    State::new(&Robot { scene: &scene, latest: &latest, group: Some(&group) }, answers(acts))
}

fn state_of(view: Option<PolicyView>, arm: ArmStatus, answered: u64) -> State {
    state_after(view, arm, &[act(answered)])
}

const WHITE: Question = Question::None;

fn white() -> Question {
    Question::Attribute(AttributeId::from(0), ValueId::from(0))
}

#[test]
fn state_is_one_of_six_words_the_gravest_first() {
    let still = ArmStatus::default();
    let stopped = ArmStatus { stopped: 1, hindrance: MotionInhibit::Stopped.into(), ..still };
    let unheard = ArmStatus { hindrance: MotionInhibit::Stale.into(), ..still };
    let off = ArmStatus { hindrance: MotionInhibit::Disabled.into(), ..still };
    let moves = ArmStatus { phase: Code::from(PickPhase::Moving), ..still };
    let asks = view(1, ActKind::Ask, white());
    for (view, arm, expected) in [
        (Some(asks.clone()), stopped, Word::Stopped),
        (None, still, Word::Disconnected),
        (Some(asks.clone()), unheard, Word::Disconnected),
        (Some(asks.clone()), off, Word::Held),
        (Some(asks.clone()), moves, Word::Fetching),
        (Some(view(1, ActKind::Pick, WHITE)), still, Word::Fetching),
        (Some(asks), still, Word::Asking),
        (Some(view(0, ActKind::Pick, WHITE)), still, Word::Idle),
    ] {
        assert_eq!(state_of(view.clone(), arm, 5).state, expected, "{view:?} {arm:?}");
    }
}

#[test]
fn state_says_which_service_is_away_or_held() {
    let view = Some(view(1, ActKind::Ask, white()));
    let latest = Latest { view, arm: Some(ArmStatus::default()), ..Latest::default() };
    let scene = bowls();
    for (arm, expected, why) in [
        ("held", Word::Held, "held by the operator"),
        ("restarting", Word::Disconnected, "arm is restarting"),
        ("failed", Word::Disconnected, "arm has failed"),
    ] {
        let group = group(arm);
        let state = State::new(
            &Robot { scene: &scene, latest: &latest, group: Some(&group) },
            answers(&[act(5)]),
        );
        assert_eq!(state.state, expected);
        assert!(state.why.as_ref().is_some_and(|found| found.contains(why)), "{state:?}");
    }
}

#[test]
fn reply_is_what_the_robot_answers() {
    let still = ArmStatus::default();
    let question = state_of(Some(view(1, ActKind::Ask, white())), still, 4).reply(5, 0);
    assert_eq!(question.kind, Kind::Question);
    assert_eq!(question.options, ["yes", "no", "I don't know"]);
    assert!(question.expects_answer && question.prompt == 3 && question.text == "Is it white?");
    let fetching = state_of(Some(view(1, ActKind::Pick, WHITE)), still, 5).reply(5, 0);
    assert_eq!((fetching.kind, fetching.expects_answer), (Kind::Fetching, false));
    let last = Ended {
        interaction: InteractionId(1),
        object: None,
        name: Some("white1".to_owned()),
        outcome: Outcome::Delivered,
        questions: 2,
        seconds: 4.0,
        utterances: (UtteranceSeq(4), UtteranceSeq(5)),
    };
    let over = PolicyView { last: Some(last), ..view(0, ActKind::Say, WHITE) };
    let ended = state_of(Some(over.clone()), still, 5).reply(5, 0);
    assert_eq!(ended.kind, Kind::Ended);
    assert_eq!(ended.ended.unwrap().object.as_deref(), Some("white1"));
    let later = state_of(Some(PolicyView { applied: 6, ..over.clone() }), still, 6);
    assert_eq!((later.reply(6, 0).kind, later.reply(6, 0).ended), (Kind::Line, None));
    assert_eq!(later.reply(6, 1).kind, Kind::Ended, "never mind");
    let nothing = state_of(Some(PolicyView { applied: 6, ..over }), still, 5).reply(6, 0);
    assert_eq!((nothing.kind, nothing.text.as_str()), (Kind::Silent, ""));
}

#[test]
fn reply_keeps_the_line_that_gives_up_an_object_though_the_question_after_it_came_at_once() {
    let (kind, text) = (Code::from(ActKind::Cancel), FixedText::truncated("All right."));
    let gives_up = RobotAct { kind, text, interaction: 1, ..act(5) };
    let asks = Some(view(1, ActKind::Ask, white()));
    for (acts, expected) in [
        (vec![gives_up, act(5)], "All right. Is it white?"),
        (vec![gives_up, act(6)], "All right. Is it white?"),
        (vec![RobotAct { utterance: 4, ..gives_up }, act(5)], "Is it white?"),
        (vec![RobotAct { text: FixedText::truncated("Is it"), ..gives_up }], "Is it white?"),
    ] {
        let state = state_after(asks.clone(), ArmStatus::default(), &acts);
        assert_eq!(state.reply(5, 1).text, expected, "{acts:?}");
    }
}

#[test]
fn options_fit_the_question() {
    let scene = bowls();
    let attribute = AttributeId::from(0);
    let spoken: Vec<&str> =
        scene.attributes()[0].values.iter().map(|value| value.spoken.as_str()).collect();
    let which = options(&scene, Question::Which(attribute));
    assert_eq!(which[..which.len() - 1], spoken);
    let two = Options::new(&[0, 1].map(ValueId::from)).unwrap();
    let choice = options(&scene, Question::Choice(attribute, two));
    assert_eq!(choice[..2], spoken[..2]);
    assert_eq!(choice.last(), Some(&"I don't know"));
}

#[test]
fn another_scene_than_the_dialogues_is_not_shown() {
    let other = PolicyView { scene_key: 1, ..view(1, ActKind::Ask, white()) };
    let state = state_of(Some(other), ArmStatus::default(), 5);
    assert_eq!((state.state, state.text.as_str()), (Word::Disconnected, ""));
    assert!(state.belief.is_empty() && !state.inner.is_known);
}
