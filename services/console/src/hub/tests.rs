//! Control, answers and full mailboxes.

use super::*;
use service::worker_channel::{self, DeviceReceiver};

struct World {
    hub: Hub,
    commands: DeviceReceiver<Command>,
    motions: DeviceReceiver<Motion>,
}

fn world() -> World {
    let (to_commands, commands) = worker_channel::channel().unwrap();
    let (to_motions, motions) = worker_channel::channel().unwrap();
    let (restarts, _) = crossbeam_channel::bounded(1);
    let ways = Ways { commands: to_commands, motions: to_motions, restarts };
    World { hub: Hub::new(ways, 3, Span::from_ms(1_000)), commands, motions }
}

fn told(letters: &mut mpsc::Receiver<Letter>) -> Json {
    match letters.try_recv().unwrap() {
        Letter::Frame(frame) => serde_json::from_str(&frame).unwrap(),
        Letter::Replaced => panic!("replaced"),
    }
}

#[test]
fn only_the_operator_is_obeyed_but_anybody_may_stop() {
    let World { hub, commands, motions } = world();
    let (one, mut to_one) = hub.join("", "a", Role::Operator).unwrap();
    let (other, mut to_other) = hub.join("", "b", Role::Viewer).unwrap();
    hub.ask(one, 1, Verb::NotThat);
    assert!(matches!(commands.take(), Some(Command::Do(_, 1, Verb::NotThat))));
    hub.ask(other, 2, Verb::NotThat);
    assert!(commands.take().is_none());
    assert_eq!(told(&mut to_other)["error"], "v1 is in control; ask for it first");
    hub.motion(other, 3, false);
    assert!(motions.take().is_none() && told(&mut to_other)["ok"] == false);
    hub.motion(other, 4, true);
    assert!(motions.take().is_some_and(|motion| motion.stop && motion.viewer == other));
    hub.answer(one, 9, Ok(json!({ "seq": 7 })));
    assert_eq!(told(&mut to_one), json!({ "t": "done", "id": 9, "ok": true, "seq": 7 }));
}

#[test]
fn a_full_house_and_a_page_that_comes_again() {
    let World { hub, .. } = world();
    let open: Vec<_> =
        ["a", "b", "c"].iter().map(|s| hub.join("", s, Role::Operator).unwrap()).collect();
    assert!(hub.join("", "d", Role::Viewer).unwrap_err().contains("viewers_max"));
    let (again, _letters) = hub.join("", "a", Role::Viewer).unwrap();
    let [(_, mut first), ..] = <[_; 3]>::try_from(open).unwrap();
    assert_eq!(first.try_recv(), Ok(Letter::Replaced));
    assert_eq!(hub.viewers(), 3);
    assert_eq!(hub.control().lease.operator(), Some(again), "its session is in control");
}

#[test]
fn a_screen_only_shows() {
    let World { hub, .. } = world();
    let (screen, mut letters) = hub.join("", "a", Role::Screen).unwrap();
    hub.take_control(screen, 1, Time(0));
    assert_eq!(told(&mut letters)["ok"], false);
    let (one, mut to_one) = hub.join("", "b", Role::Operator).unwrap();
    hub.give_control(one, 2, screen);
    assert!(told(&mut to_one)["error"].as_str().unwrap().contains("screen"));
}

#[test]
fn who_does_not_read_its_answers_is_shut_out() {
    let World { hub, .. } = world();
    let (deaf, mut letters) = hub.join("", "a", Role::Viewer).unwrap();
    (0..1_000).for_each(|n| hub.answer(deaf, n, Ok(Json::Null)));
    assert_eq!(hub.viewers(), 0);
    let mut kept = 0;
    while letters.try_recv().is_ok() {
        kept += 1;
    }
    assert!(kept < 100 && letters.is_closed(), "{kept}");
}
