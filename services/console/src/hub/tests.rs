//! The hub: control, answers and full queues.

use super::outbound::Done;
use super::*;
use serde_json::{Value as Json, json};
use service::worker_channel::{self, DeviceReceiver};

pub(crate) struct Page {
    pub(crate) hub: Hub,
    commands: DeviceReceiver<Command>,
    motions: DeviceReceiver<Motion>,
}

pub(crate) fn hub() -> Page {
    let (to_commands, commands) = worker_channel::channel().unwrap();
    let (to_motions, motions) = worker_channel::channel().unwrap();
    let (restarts, _) = crossbeam_channel::bounded(1);
    let channels = Channels { commands: to_commands, motions: to_motions, restarts };
    Page {
        hub: Hub::new(channels, 3, Span::from_ms(1_000), Metrics::new("/nowhere".into())),
        commands,
        motions,
    }
}

pub(crate) fn received(frames: &mut mpsc::Receiver<OutboundFrame>) -> Json {
    match frames.try_recv().unwrap() {
        OutboundFrame::Text(frame) => serde_json::from_str(&frame).unwrap(),
        OutboundFrame::Answer(id, outcome) => {
            let done = PageMessage::Done(Done::new(id, &outcome));
            serde_json::from_str(&done.to_text()).unwrap()
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn hub_obeys_the_operator_but_lets_every_viewer_stop() {
    let Page { hub, commands, motions } = hub();
    let (one, mut to_one) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
    let (other, _frames) = hub.join("", "b", Role::Viewer, Time(0)).unwrap();
    hub.ask(one, 1, Verb::NotThat).unwrap();
    assert!(matches!(commands.take(), Some(Command::Do(_, 1, Verb::NotThat))));
    let refused = hub.ask(other, 2, Verb::NotThat).unwrap_err();
    assert_eq!(refused, "v1 is in control; help: request control first");
    assert!(hub.release(other, 3, StopId(0)).is_err());
    assert!(commands.take().is_none() && motions.take().is_none());
    hub.stop(other, 4).unwrap();
    assert!(motions.take().is_some_and(|motion| motion.stop && motion.viewer == other));
    hub.answer(one, 9, Ok(Some(Answer::Accepted { seq: 7, waits_for: None, known: false })));
    assert_eq!(received(&mut to_one), json!({ "t": "done", "id": 9, "ok": true, "seq": 7 }));
}

#[test]
fn participant_of_a_study_stops_the_arm_and_cannot_release_it() {
    let Page { hub, motions, .. } = hub();
    let (viewer, _frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
    hub.release(viewer, 1, StopId(6)).unwrap();
    assert!(motions.take().is_some_and(|motion| !motion.stop && motion.of == StopId(6)));
    hub.ask(viewer, 2, Verb::Study("find".to_owned(), json!({}))).unwrap();
    let refused = hub.release(viewer, 3, StopId(0)).unwrap_err();
    assert!(refused.contains("experimenter"), "{refused}");
    hub.stop(viewer, 4).unwrap();
    assert!(motions.take().is_some_and(|motion| motion.stop));
    // The experimenter's page, which has no control.
    let (experimenter, _more) = hub.join("", "b", Role::Viewer, Time(1)).unwrap();
    hub.release(experimenter, 5, StopId(0)).unwrap();
    hub.leave(experimenter, Time(1));
    let (screen, _most) = hub.join("", "c", Role::Screen, Time(1)).unwrap();
    assert!(hub.release(screen, 6, StopId(0)).is_err());
    // The console's own page on the participant's device.
    let (other, _again) = hub.join("", "a", Role::Operator, Time(2)).unwrap();
    hub.release(other, 7, StopId(0)).unwrap();
    hub.leave(screen, Time(2));
    let (viewer, _frames) = hub.join("", "b", Role::Viewer, Time(2)).unwrap();
    assert!(hub.release(viewer, 8, StopId(0)).is_err());
}

#[test]
fn hub_admits_a_known_session_in_control() {
    let Page { hub, .. } = hub();
    let (_, mut first) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
    let (again, _frames) = hub.join("", "a", Role::Viewer, Time(0)).unwrap();
    assert_eq!(first.try_recv(), Ok(OutboundFrame::Replaced));
    assert_eq!((hub.viewers(), hub.control().lease.operator()), (1, Some(again)));
}

#[test]
fn hub_reserves_a_place_for_an_operator() {
    let Page { hub, .. } = hub();
    let open: Vec<_> =
        (1..=2).map(|n| hub.join("", &format!("{n}"), Role::Viewer, Time(n)).unwrap()).collect();
    for role in [Role::Viewer, Role::Screen] {
        assert!(hub.join("", "d", role, Time(3)).unwrap_err().contains("viewers_max"));
    }
    let (operator, _frames) = hub.join("", "o", Role::Operator, Time(4)).unwrap();
    assert_eq!(hub.control().lease.operator(), Some(operator));
    // If all would operate, the one that was idle for the longest time gives way.
    hub.note(ViewerId(1), Time(5));
    let (next, _more) = hub.join("", "p", Role::Operator, Time(6)).unwrap();
    let [(_, mut first), (_, mut second)] = <[_; 2]>::try_from(open).unwrap();
    assert!(first.try_recv().is_err());
    assert_eq!(second.try_recv(), Ok(OutboundFrame::GaveWay));
    assert_eq!(hub.viewers(), 3);
    assert_eq!(hub.control().lease.operator(), Some(operator), "it keeps control");
    assert!(matches!(hub.take_control(next, Time(7)), Ok(Some(Answer::Control { .. }))));
}

#[test]
fn hub_gives_control_to_who_joins_after_the_operator_has_been_away_too_long() {
    let Page { hub, .. } = hub();
    let (one, _frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
    hub.leave(one, Time(0));
    let back = Time(0) + lease::RELOAD;
    let (next, _more) = hub.join("", "b", Role::Operator, back).unwrap();
    assert_eq!(hub.control().lease.operator(), Some(next));
}

#[test]
fn hub_lets_only_the_operator_end_anothers_participation() {
    let Page { hub, commands, .. } = hub();
    let (one, _to_one) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
    let (other, _to_other) = hub.join("", "b", Role::Viewer, Time(0)).unwrap();
    let study = |verb: &str| Verb::Study(verb.to_owned(), Json::Null);
    for verb in ["resume", "close", "spoilt", "delete", "anything"] {
        assert!(hub.ask(other, 1, study(verb)).unwrap_err().contains("in control"), "{verb}");
        hub.ask(one, 1, study(verb)).unwrap();
        assert!(commands.take().is_some());
    }
    for verb in ["find", "begin", "consent", "next", "start", "answer", "withdraw"] {
        hub.ask(other, 1, study(verb)).unwrap();
        assert!(commands.take().is_some(), "{verb}");
    }
}

#[test]
fn hub_knows_the_operators_page_by_its_session() {
    let Page { hub, .. } = hub();
    assert!(hub.must_operate("").is_err(), "there is no operator");
    let (one, _to_one) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
    let (other, _to_other) = hub.join("", "b", Role::Viewer, Time(0)).unwrap();
    assert!(hub.must_operate("a").is_ok());
    assert!(hub.must_operate("b").unwrap_err().contains("take control first"));
    hub.give_control(one, other).unwrap();
    assert!(hub.must_operate("a").is_err() && hub.must_operate("b").is_ok());
    hub.leave(other, Time(1));
    assert!(hub.must_operate("b").is_err(), "its page is gone");
}

#[test]
fn hub_gives_a_screen_no_control() {
    let Page { hub, .. } = hub();
    let (screen, _to_screen) = hub.join("", "a", Role::Screen, Time(0)).unwrap();
    assert!(hub.take_control(screen, Time(0)).is_err());
    let (one, _to_one) = hub.join("", "b", Role::Operator, Time(0)).unwrap();
    assert!(hub.give_control(one, screen).unwrap_err().contains("screen"));
}

#[test]
fn hub_disconnects_a_viewer_that_does_not_read() {
    let Page { hub, .. } = hub();
    let (viewer, mut frames) = hub.join("", "a", Role::Viewer, Time(0)).unwrap();
    (0..1_000).for_each(|n| hub.answer(viewer, n, Ok(None)));
    assert_eq!(hub.viewers(), 0);
    let mut kept = 0;
    while frames.try_recv().is_ok() {
        kept += 1;
    }
    assert!(kept < 100 && frames.is_closed(), "{kept}");
}
