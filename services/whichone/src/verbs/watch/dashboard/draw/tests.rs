use ratatui::Terminal;
use ratatui::backend::TestBackend;
use scene::Question;
use serde_json::json;
use service::status::{GroupState, ServiceState, ServiceStatus};

use super::*;
use crate::verbs::conversation::example;

fn scene() -> Scene {
    let objects = ["white", "clear"].map(|name| json!({"name": name, "attributes": {}}));
    let json = json!({ "objects": objects, "values": {"color": ["red"]} });
    Scene::from_json("desk", &json).unwrap()
}

fn status() -> GroupStatus {
    let service = |name: &str, state| ServiceStatus {
        name: name.to_owned(),
        state,
        restarts: 2,
        ..ServiceStatus::default()
    };
    let services = vec![service("speech", ServiceState::Ready), service("arm", ServiceState::Held)];
    let (name, state) = ("lab".to_owned(), GroupState::Degraded);
    GroupStatus { name, state, uptime_s: 61.0, services, ..GroupStatus::default() }
}

/// What a terminal of this size shows, a line each.
fn screen(width: u16, height: u16, keyboard: &Keyboard, notice: Option<&Notice>) -> Vec<String> {
    let (scene, status, mut latest) = (scene(), status(), example::asked(Question::None));
    latest.view.as_mut().unwrap().belief = vec![0.25, 0.75];
    latest.arm = Some(messages::ArmStatus { stopped: 1, ..Default::default() });
    let said = vec![
        SaidView { who: Speaker::Person, text: "the bowl \x1b[2J" },
        SaidView { who: Speaker::Robot, text: "Is it white?" },
    ];
    let picture = Picture {
        scene: &scene,
        latest: &latest,
        said,
        status: Some(&status),
        notice,
        style: Style { colour: true },
    };
    let mut terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
    terminal.draw(|frame| draw(frame, &picture, keyboard)).unwrap();
    let buffer = terminal.backend().buffer();
    let row = |y| (0..width).map(|x| buffer[(x, y)].symbol()).collect::<String>();
    (0..height).map(|y| row(y).trim_end().to_owned()).collect()
}

#[test]
fn dashboard_shows_belief_dialogue_arm_and_services() {
    let notice = Notice::bad("not accepted: too long");
    let text = screen(100, 24, &Keyboard::default(), Some(&notice)).join("\n");
    for part in [
        "lab degraded, scene scene, up 1 min 1 s",
        "white  25.0 %",
        "clear  75.0 % ████",
        "interaction 7",
        "decision: ask",
        "robot  Is it white?",
        "the bowl \\u{1b}[2J",
        "speech     ready restarted 2",
        "help: whichone release",
        "STOPPED",
        "not accepted: too long",
        "s, space, Esc stop   r resume",
    ] {
        assert!(text.contains(part), "{part}:\n{text}");
    }
}

#[test]
fn dashboard_fits_terminals_of_every_size() {
    for (width, height) in [(1, 1), (3, 40), (20, 5), (60, 12), (89, 24), (90, 8), (300, 90)] {
        for keyboard in
            [Keyboard::default(), Keyboard::in_mode(Mode::Typing("the white bowl".repeat(20)))]
        {
            assert_eq!(screen(width, height, &keyboard, None).len(), usize::from(height));
        }
    }
    let narrow = screen(60, 24, &Keyboard::default(), None).join("\n");
    assert!(narrow.contains("speech ready  arm held"), "{narrow}");
}

#[test]
fn dashboard_shows_what_is_typed_and_asks_before_a_release() {
    let last = |keyboard| screen(60, 20, &keyboard, None).pop().unwrap();
    assert!(
        last(Keyboard::in_mode(Mode::Typing("the cup".into())))
            .starts_with("say> the cup   Enter says it")
    );
    let long = last(Keyboard::in_mode(Mode::Typing(format!("{}end", "x".repeat(200)))));
    assert!(long.contains("xxxend"), "{long}");
    let releasing = last(Keyboard::in_mode(Mode::Releasing("res".into())));
    assert!(releasing.starts_with("to let the arm move, type resume and Enter: res_"));
}
