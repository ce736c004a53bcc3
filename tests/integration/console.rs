//! The console as pages see it, with real groups and sockets.

use std::time::Duration;
use std::time::Instant;

use rustix::process::Signal;
use serde_json::{Value as Json, json};
use tungstenite::Message;
use whichone_tests::console::{Page, Visitor, http};
use whichone_tests::{Group, YES_NO, wait_for};

fn ok(done: &Json) -> bool {
    assert!(done["ok"].as_bool().is_some(), "{done}");
    done["ok"] == true
}

fn why(done: &Json) -> &str {
    done["error"].as_str().unwrap_or_else(|| panic!("{done}"))
}

fn stands(page: &mut Page) -> Json {
    page.until_part("dialogue", |dialogue| dialogue["decision"] == "ask")
}

/// Asks for the clear bowl until the robot is sure.
fn have_it_fetch(page: &mut Page) {
    let said = page.ask("say", &json!({ "text": "the clear bowl" }))["seq"].as_u64();
    page.until_part("dialogue", |dialogue| dialogue["applied"].as_u64() >= said);
    page.answer_until("clear", |dialogue| dialogue["decision"] == "pick");
}

#[test]
fn page_follows_a_dialogue_to_the_hand_over() {
    let group = Group::up(&[YES_NO]);
    let mut page = group.page(&Visitor::operator(1));
    assert_eq!(page.welcome["protocol"], 2);
    page.until_part("turn", |turn| turn["state"] == "idle");
    let said = page.ask("say", &json!({ "text": "get me the bowl" }));
    assert!(ok(&said) && said["seq"] == 1, "{said}");
    let dialogue = stands(&mut page);
    assert_eq!(dialogue["belief"].as_object().unwrap().len(), 6);
    assert!(!dialogue["alternatives"].as_array().unwrap().is_empty(), "{dialogue}");
    let last = page.converse("metal2");
    assert_eq!((&last["outcome"], &last["object"]), (&json!("delivered"), &json!("metal2")));
    let person = page.until_line("what was understood", |line| {
        line["who"] == "person" && line["answers"].is_array() && line["understood"].is_array()
    });
    let meaning = person["understood"][0]["text"].as_str().unwrap();
    assert!(["yes", "no"].iter().any(|word| meaning.contains(word)), "{person}");
    page.until_line("the robot's question", |line| line["who"] == "robot");
    let outcome = page.until_line("the outcome", |line| line["outcome"] == "delivered");
    assert!(outcome["text"].as_str().unwrap().contains("big metallic bowl"), "{outcome}");
    page.until_part("latency", |latency| {
        latency["count"].as_u64() > Some(1) && latency["p99"]["total_ms"].as_f64() > Some(0.0)
    });
    page.until_part("world", |world| world["objects"].as_array().unwrap()[4].is_null());
    assert!(
        page.messages
            .iter()
            .any(|message| message["t"] == "joints" && message["q"].as_array().unwrap().len() == 17)
    );
    let (status, _, body) = http(&group.console(), "GET", "/api/state", &[], "");
    let state: Json = serde_json::from_str(&body).unwrap();
    assert_eq!((status, &state["dialogue"]["last"]["object"]), (200, &json!("metal2")));
    drop(page);
    group.down();
}

#[test]
fn not_that_denies_the_question_or_the_pick() {
    let group = Group::up(&["arm.time_scale=2.0", YES_NO]);
    let mut page = group.page(&Visitor::operator(1));
    page.until_part("dialogue", |dialogue| dialogue["interaction"] == 0);
    assert!(why(&page.ask("not_that", &Json::Null)).contains("neither"));
    assert!(ok(&page.ask("say", &json!({ "text": "get me the bowl" }))));
    let asked = stands(&mut page);
    // A question that has not begun to be said is not answered.
    page.until_part("turn", |turn| turn["state"] == "asked");
    let value = asked["question"]["value"].as_str().unwrap().to_owned();
    assert!(ok(&page.ask("not_that", &Json::Null)));
    let line = page.until_line("the denial", |line| line["answers"].is_array());
    assert_eq!((&line["text"], &line["understood"][0]["text"]), (&json!("no"), &json!("no")));
    page.until_part("dialogue", |dialogue| dialogue["question"]["value"] != value.as_str());
    // The evidence goes; the request stays.
    assert!(ok(&page.ask("start_over", &Json::Null)));
    page.until_part("dialogue", |dialogue| {
        let belief = dialogue["belief"].as_object().unwrap();
        dialogue["decision"] == "ask" && belief.values().all(|p| *p == belief["white"])
    });
    have_it_fetch(&mut page);
    page.until_part("arm", |arm| arm["phase"] == "moving");
    assert!(ok(&page.ask("not_that", &Json::Null)));
    let line = page.until_line("the denial", |line| {
        line["text"] == "no, not the clear bowl" && line["understood"].is_array()
    });
    assert_eq!(line["understood"][0]["text"], "no · not clear");
    // What was said before counts on, in the same interaction.
    page.until_part("dialogue", |dialogue| {
        let goes_on = ["ask", "pick"].contains(&dialogue["decision"].as_str().unwrap());
        goes_on && dialogue["interaction"] == 1 && dialogue["belief"]["clear"].as_f64() < Some(0.5)
    });
    drop(page);
    group.down();
}

#[test]
fn one_operator_at_a_time_hands_over_control() {
    let group = Group::up(&["console.handover_s=2.0"]);
    let mut first = group.page(&Visitor::operator(1));
    let mut second = group.page(&Visitor::operator(2));
    let (one, other) = (first.viewer(), second.viewer());
    second.until_part("control", |control| control["operator"] == one.as_str());
    assert!(why(&second.ask("say", &json!({ "text": "the clear bowl" }))).contains("in control"));
    let taken = second.ask("take_control", &Json::Null);
    assert!(ok(&taken) && taken["granted"] == false, "{taken}");
    first.until_part("control", |control| control["asked_by"] == other.as_str());
    assert!(ok(&first.ask("keep_control", &Json::Null)));
    second.until_part("control", |control| control["asked_by"].is_null());
    assert!(ok(&second.ask("take_control", &Json::Null)));
    assert!(ok(&first.ask("give_control", &json!({ "viewer": other }))));
    second.until_part("control", |control| control["operator"] == other.as_str());
    assert!(ok(&second.ask("say", &json!({ "text": "hello" }))));
    // Without an answer, control passes after the timeout.
    assert!(ok(&first.ask("take_control", &Json::Null)));
    first.until_part("control", |control| control["operator"] == one.as_str());
    assert!(why(&second.ask("restart_service", &json!({ "service": "arm" }))).contains("control"));
    assert!(ok(&first.ask("restart_service", &json!({ "service": "grounding" }))));
    first.until_line("grounding to be back", |line| {
        line["text"].as_str().unwrap().starts_with("grounding is back")
    });
    assert!(!ok(&first.ask("restart_service", &json!({ "service": "legs" }))));
    drop((first, second));
    group.down();
}

#[test]
fn reloaded_page_resumes_its_session() {
    let group = Group::up(&[]);
    let mut page = group.page(&Visitor::operator(1));
    assert!(ok(&page.ask("say", &json!({ "text": "get me the bowl" }))));
    page.until_line("the question", |line| line["who"] == "robot");
    let last_line = page.last_line();
    let again = Visitor { role: "viewer", last_line, ..Visitor::operator(1) };
    let mut second = group.page(&again);
    assert_eq!(page.until("the old page's end", |page| page.closed.clone()).0, 4001);
    let viewer = second.viewer();
    second.until_part("control", |control| control["operator"] == viewer.as_str());
    assert!(ok(&second.ask("say", &json!({ "text": "the white one" }))));
    second.until_line("the new line", |line| line["text"] == "the white one");
    let old = second.lines.iter().filter(|line| line["id"].as_u64() <= Some(last_line)).count();
    assert_eq!(old, 0, "{:?}", second.lines);
    drop((page, second));
    group.down();
}

#[test]
fn every_viewer_may_stop_the_arm() {
    let group = Group::up(&["arm.time_scale=1.0"]);
    let mut operator = group.page(&Visitor::operator(1));
    let mut viewer = group.page(&Visitor { role: "viewer", ..Visitor::operator(2) });
    have_it_fetch(&mut operator);
    viewer.until_part("arm", |arm| arm["moving"] == true && arm["phase"] == "moving");
    assert_eq!(viewer.stop()["stopped"], true);
    viewer.until_part("turn", |turn| turn["state"] == "stopped");
    viewer.until_part("arm", |arm| arm["stopped"] == true && arm["moving"] == false);
    // Whoever may not speak to the robot can still tell it to stop.
    let said = viewer.ask("say", &json!({ "text": "stop" }));
    assert!(why(&said).contains("control") && why(&said).contains("the stop is given"), "{said}");
    assert!(why(&viewer.ask("resume", &Json::Null)).contains("control"));
    viewer.stop();
    assert!(why(&operator.ask("resume", &Json::Null)).contains("less than 2 s"));
    std::thread::sleep(Duration::from_millis(2_200));
    assert!(ok(&operator.ask("resume", &Json::Null)));
    operator.until_part("turn", |turn| turn["state"] == "moving");
    operator.until_line("the stop", |line| line["text"] == "The arm was stopped");
    drop((operator, viewer));
    group.down();
}

#[test]
fn invalid_messages_are_reported_and_harmless() {
    let group = Group::up(&[]);
    let place = group.console();
    let mut page = group.page(&Visitor::operator(1));
    for bad in ["", "null", "{\"t\":\"dance\"}", "{\"t\":\"do\"}", "{\"t\":\"hello\"}", "\u{1F916}"]
    {
        page.messages.clear();
        page.send_raw(Message::Text(bad.into()));
        page.until("an error", |page| {
            page.messages.iter().any(|t| t["t"] == "error").then_some(())
        });
    }
    page.messages.clear();
    page.send_raw(Message::Binary(vec![9; 7].into()));
    page.until("an error", |page| page.messages.iter().any(|t| t["t"] == "error").then_some(()));
    assert!(why(&page.ask("fly", &Json::Null)).contains("fly"));
    assert!(why(&page.ask("say", &json!({ "text": "" }))).contains("words"));
    assert!(why(&page.ask("say", &json!({ "text": "a", "began_ms": -1 }))).contains("began_ms"));
    page.send(&json!({ "t": "ping", "at": 12.5 }));
    page.until("a pong", |page| {
        page.messages.iter().any(|t| t["t"] == "pong" && t["at"] == 12.5).then_some(())
    });
    page.send_raw(Message::Text("x".repeat(65 << 10).into()));
    let closed = page.until("the end of a page that sends too much", |page| page.closed.clone());
    assert!(closed.0 == 1009 && closed.1.contains("65536 bytes"), "{closed:?}");
    let mut mute = Page::connect(&place, &Visitor::operator(3)).unwrap();
    mute.send(&json!({ "t": "ping", "at": 1 }));
    mute.until("the end of a page without a hello", |page| page.closed.clone());
    for (path, status) in [
        ("/", 200),
        ("/healthz", 200),
        ("/metrics", 200),
        ("/robot.urdf", 200),
        ("/strings/en.json", 200),
        ("/nowhere", 404),
        ("/../Cargo.toml", 404),
        ("/voice/line-1-1.wav", 404),
        ("/voice/..%2f..%2fsettings.toml", 404),
    ] {
        assert_eq!(http(&place, "GET", path, &[], "").0, status, "{path}");
    }
    assert_eq!(http(&place, "POST", "/", &[], "").0, 405);
    let mut page = group.page(&Visitor::operator(1));
    assert!(
        ok(&page.ask("say", &json!({ "text": "the clear bowl" }))),
        "the group is still running"
    );
    drop((page, mute));
    group.down();
}

/// A stop behind a good connection, with nobody to carry it out.
#[test]
fn stop_without_the_arms_service_alarms_every_page_until_it_is_confirmed() {
    let group = Group::up(&[]);
    let mut page = group.page(&Visitor::operator(1));
    let mut viewer = group.page(&Visitor { role: "viewer", ..Visitor::operator(2) });
    viewer.until_part("motion", |motion| motion["unconfirmed"].is_null());
    group.must(&["hold", "arm"]);
    viewer.until_part("arm", Json::is_null);
    let held = |group: &Json| {
        let mut services = group["services"].as_array().unwrap().iter();
        services.any(|service| service["name"] == "arm" && service["state"] == "held")
    };
    viewer.until_part("group", held);
    let pressed = Instant::now();
    let id = page.begin("stop", &Json::Null);
    viewer.until_part("motion", |motion| motion["unconfirmed"]["why"] == "held");
    let after = pressed.elapsed();
    let late =
        page.until("an answer", |page| page.messages.iter().find(|m| m["id"] == id).cloned());
    assert!(why(&late).contains("emergency stop") && why(&late).contains("held"), "{late}");
    println!("the alarm came {after:?} after the stop");
    // Words that the arm will be needed for are kept, with the reason why nothing follows.
    let said = page.ask("say", &json!({ "text": "get me the bowl" }));
    assert!(said["waits_for"].as_str().unwrap().contains("arm is held"), "{said}");
    drop(page);
    group.must(&["release", "arm"]);
    viewer.until_part("motion", |motion| motion["unconfirmed"].is_null());
    viewer.until_part("arm", |arm| arm["stopped"] == true);
    group.must(&["hold", "speech"]);
    let mut page = group.page(&Visitor::operator(1));
    page.until_part("group", |group| {
        let mut services = group["services"].as_array().unwrap().iter();
        services.any(|service| service["name"] == "speech" && service["state"] == "held")
    });
    let refused = page.ask("say", &json!({ "text": "get me the bowl" }));
    assert!(why(&refused).contains("speech is held"), "{refused}");
    drop((page, viewer));
    group.down();
}

#[test]
fn killed_console_returns_to_its_address() {
    let group = Group::up(&[]);
    let place = group.console();
    let mut page = group.page(&Visitor::operator(1));
    assert!(ok(&page.ask("say", &json!({ "text": "get me the bowl" }))));
    page.until_line("the question", |line| line["who"] == "robot");
    let (lines, first_line) = (page.lines.clone(), page.welcome["first_line"].clone());
    // What was said is kept some time after it was shown.
    let kept = group.paths().run().join("console.lines");
    wait_for("the transcript to be kept", 5.0, || {
        let text = std::fs::read_to_string(&kept).ok()?;
        (text.lines().count() >= lines.len()).then_some(())
    });
    let before = group.incarnation("console");
    group.signal("console", Signal::KILL);
    page.until("the end of the socket", |page| page.closed.clone());
    group.wait_for_restart("console", before);
    assert_eq!(group.console(), place);
    let again = Visitor { last_line: page.last_line(), ..Visitor::operator(1) };
    let mut page = group.page(&again);
    assert_eq!(page.converse("white2")["object"], "white2");
    let known = lines.last().unwrap()["id"].as_u64();
    assert!(page.lines.iter().all(|line| line["id"].as_u64() > known), "{:?}", page.lines);
    assert!(first_line.as_u64() <= page.welcome["first_line"].as_u64());
    let mut all = group.page(&Visitor { role: "viewer", ..Visitor::operator(2) });
    let first = lines[0].clone();
    all.until_line("the first line", |line| {
        line["text"] == first["text"] && line["id"] == first["id"]
    });
    drop((page, all));
    group.verify_journals();
    group.down();
}

#[test]
fn page_shows_restarts_of_services() {
    let group = Group::up(&[]);
    let mut page = group.page(&Visitor::operator(1));
    for (service, object) in
        [("speech", "white"), ("grounding", "metal"), ("policy", "clear"), ("arm", "white3")]
    {
        assert!(ok(&page.ask("say", &json!({ "text": "get me the bowl" }))));
        stands(&mut page);
        let before = page.last_line();
        group.signal(service, Signal::KILL);
        page.until_line(&format!("{service} to be back"), |line| {
            let text = line["text"].as_str().unwrap();
            line["id"].as_u64() > Some(before) && text.starts_with(&format!("{service} is back"))
        });
        let last = page.converse(object);
        assert_eq!((&last["outcome"], &last["object"]), (&json!("delivered"), &json!(object)));
        page.until_part("dialogue", |dialogue| dialogue["interaction"] == 0);
    }
    assert!(page.closed.is_none());
    drop(page);
    group.verify_journals();
    group.down();
}

#[test]
fn slow_reader_is_disconnected_without_delaying_others() {
    let group = Group::up(&["arm.joint_rate_hz=200.0"]);
    let mut deaf = group.page(&Visitor { role: "viewer", ..Visitor::operator(2) });
    let mut page = group.page(&Visitor::operator(1));
    let dropped = || {
        let (_, _, text) = http(&group.console(), "GET", "/metrics", &[], "");
        let line =
            text.lines().find(|line| line.starts_with("whichone_console_viewers_dropped_total"));
        line.is_some_and(|line| !line.ends_with(" 0"))
    };
    // It asks and never reads the answers.
    let ping = json!({ "t": "ping", "at": 1.0, "more": "" }).to_string();
    wait_for("a page that does not read to be shut out", 60.0, || {
        (0..200).for_each(|_| deaf.send_raw(Message::Text(ping.clone().into())));
        page.look();
        dropped().then_some(())
    });
    page.until_part("control", |control| control["viewers"] == 1);
    assert!(ok(&page.ask("say", &json!({ "text": "get me the bowl" }))));
    assert_eq!(page.converse("white")["object"], "white");
    drop((page, deaf));
    group.down();
}

#[test]
fn console_is_swapped_for_itself() {
    let group = Group::up(&[]);
    let place = group.console();
    let program = whichone_tests::program("whichone-console").display().to_string();
    group.must(&["swap", "console", "--", &program]);
    assert_eq!(group.console(), place);
    let mut page = group.page(&Visitor::operator(1));
    page.until_part("group", |group| {
        let mut all = group["services"].as_array().unwrap().iter();
        all.any(|service| service["name"] == "console" && service["swapped"].is_array())
    });
    drop(page);
    group.must(&["stop", "console"]);
    group.say("get me the bowl");
    assert_eq!(
        group.await_pick(Some("clear"))["object"],
        "clear",
        "the dialogue works without the console"
    );
    group.down();
}
