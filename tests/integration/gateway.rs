//! The gateway before the console of a group of this machine: people's rights, the audit, and what strangers get.

use rustix::process::Signal;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;
use whichone_tests::console::{Console, Page, Visitor, http};
use whichone_tests::gateway::Gateway;
use whichone_tests::{Group, wait_for};

fn started(group: &Group) -> (Gateway, String) {
    let robot = group.paths().name().to_string();
    let gateway = Gateway::start(group.paths().home(), &["--group", &robot]);
    group.console();
    (gateway, robot)
}

fn visitor(number: u32) -> Visitor<'static> {
    Visitor::operator(number)
}

fn is_refused(done: &Value) -> bool {
    done["ok"] == false
        && done["error"].as_str().is_some_and(|why| why.contains("may see this robot"))
}

#[test]
fn gateway_gives_each_person_their_rights_and_records_orders() {
    let group = Group::up(&[]);
    let (gateway, robot) = started(&group);
    let ann = gateway.add("ann", &["--operator", &robot]);
    let bob = gateway.add("bob", &["--viewer", "*"]);
    let eve = gateway.add("eve", &["--operator", "another-robot"]);
    let [ann_here, bob_here, eve_here] =
        [&ann, &bob, &eve].map(|secret| gateway.console(&robot, secret));
    let path = |rest: &str| format!("/{robot}{rest}");

    // A viewer looks, and commands nothing.
    assert_eq!(http(&bob_here, "GET", &path("/api/state"), &[], "").0, 200);
    assert_eq!(http(&bob_here, "GET", &path("/study/export.json"), &[], "").0, 403);
    let mut look = Page::open(&bob_here, &visitor(1)).unwrap();
    for verb in ["stop", "say", "resume", "take_control"] {
        let done = look.ask(verb, &json!({ "text": "get me the bowl" }));
        assert!(is_refused(&done), "{verb}: {done}");
    }
    assert_eq!(group.arm()["stopped"], false);
    look.until_part("control", |control| control["operator"].is_null());
    gateway.wait_for_entry("bob", "stop", "refused");

    // An operator of another robot gets nothing of this one.
    for rest in ["/", "/api/state", "/ws", "/robot.urdf"] {
        assert_eq!(http(&eve_here, "GET", &path(rest), &[], "").0, 403, "{rest}");
    }
    assert!(Page::connect(&eve_here, &visitor(2)).unwrap_err().contains("403"));

    // An operator commands; the viewer sees it.
    let mut page = Page::open(&ann_here, &visitor(3)).unwrap();
    for (verb, stopped) in [("stop", true), ("resume", false)] {
        let done = page.ask(verb, &json!({}));
        assert_eq!(done["ok"], true, "{done}");
        wait_for("the arm's report", 5.0, || (group.arm()["stopped"] == stopped).then_some(()));
        // No release counts sooner.
        std::thread::sleep(std::time::Duration::from_millis(2_200));
    }
    let said = page.ask("say", &json!({ "text": "get me the bowl" }));
    assert_eq!(said["ok"], true, "{said}");
    look.until_line("the operator's words", |line| line["text"] == "get me the bowl");
    assert_eq!(page.until_part("control", |control| control["name"] == "ann")["name"], "ann");
    for what in ["stop", "resume", "say"] {
        let ordered = gateway.wait_for_entry("ann", what, "ordered");
        let done = gateway.wait_for_entry("ann", what, "done");
        assert_eq!((&ordered["order"], &ordered["robot"]), (&done["order"], &json!(robot)));
        assert!(ordered["unix_ms"].as_u64() > Some(1_700_000_000_000), "{ordered}");
    }
    assert_eq!(gateway.wait_for_entry("ann", "say", "ordered")["text"], "get me the bowl");

    // Each person's list has their robots.
    let list = |secret: &str| -> Value {
        let (status, _, body) = http(&gateway.console("", secret), "GET", "/_/robots", &[], "");
        assert_eq!(status, 200, "{body}");
        serde_json::from_str(&body).unwrap()
    };
    // The console polls the group's state once a second.
    let row = wait_for("a ready robot in the list", 60.0, || {
        let row = list(&ann)["robots"][0].clone();
        (row["presence"]["state"] == "ready").then_some(row)
    });
    assert_eq!((&row["robot"], &row["right"]), (&json!(robot), &json!("operator")), "{row}");
    assert_eq!(list(&bob)["robots"][0]["right"], "viewer");
    let others = list(&eve);
    assert_eq!(others["robots"].as_array().map(Vec::len), Some(1), "{others}");
    assert_eq!(others["robots"][0]["connected"], false, "{others}");

    // Rights that are taken away end what is open.
    assert_eq!(gateway.call("add", &["bob", "--viewer", "another-robot"]).code, Some(0));
    let closed = look.until("the end of the viewer's page", |page| page.closed.clone());
    assert_eq!(closed.0, 1008, "{closed:?}");
    assert_eq!(http(&bob_here, "GET", &path("/api/state"), &[], "").0, 403);
    assert_eq!(gateway.call("remove", &["ann"]).code, Some(0));
    page.until("the end of the operator's page", |page| page.closed.clone());
    assert_eq!(http(&ann_here, "GET", &path("/api/state"), &[], "").0, 401);
    assert!(gateway.end().success());
    group.down();
}

#[test]
fn gateway_refuses_strangers_and_other_sites() {
    let group = Group::up(&[]);
    let (gateway, robot) = started(&group);
    let secret = gateway.add("ann", &["--operator", "*"]);
    let ann = gateway.console("", &secret);
    let stranger = Console { token: None, ..ann.clone() };
    let html = "Accept: text/html";
    let page = format!("/{robot}/");
    for path in ["/", &page, "/_/robots"] {
        assert_eq!(http(&stranger, "GET", path, &[], "").0, 401, "{path}");
        let (status, head, _) = http(&stranger, "GET", path, &[html], "");
        assert!(path == "/_/robots" || status == 303 && head.contains("/_/login"), "{head}");
        assert_eq!(http(&ann, "GET", path, &["Host: evil.example"], "").0, 421, "{path}");
    }
    let guess = Console { token: Some("0123456789abcdef".to_owned()), ..ann.clone() };
    assert_eq!(http(&guess, "GET", &page, &[], "").0, 401);
    // The console's own token is for its owner, not for the gateway's people.
    let owner = Console { token: group.console().token, ..ann.clone() };
    assert_eq!(http(&owner, "GET", &page, &[], "").0, 401);
    let foreign = Visitor {
        headers: vec![("origin", "http://evil.example".to_owned())],
        ..Visitor::operator(1)
    };
    let refused = Page::connect(&gateway.console(&robot, &secret), &foreign).unwrap_err();
    assert!(refused.contains("403"), "{refused}");
    for (method, path, expected) in [
        ("GET", format!("/{robot}/foxglove"), 403),
        ("POST", format!("/{robot}/login"), 405),
        ("GET", "/nowhere/".to_owned(), 503),
        ("GET", "/_/nothing".to_owned(), 404),
        ("GET", format!("/{robot}/nothing"), 404),
        ("POST", "/_/login".to_owned(), 403),
        ("POST", "/_/logout".to_owned(), 403),
    ] {
        assert_eq!(http(&ann, method, &path, &[], "token=x").0, expected, "{method} {path}");
    }
    // A link with the secret becomes a session, which works for the page and its socket.
    let (status, head, body) = http(&stranger, "GET", &format!("{page}?token={secret}"), &[], "");
    assert!(status == 200 && body.contains(&format!("url={page}")), "{head}{body}");
    let lower = head.to_lowercase();
    let (_, cookie) = lower.split_once("set-cookie: ").unwrap_or_else(|| panic!("{head}"));
    let cookie = cookie.split(';').next().unwrap().to_owned();
    assert!(!cookie.contains(&secret) && !head.contains(&secret));
    let session = format!("Cookie: {cookie}");
    let (status, head, body) = http(&stranger, "GET", &page, &[&session, html], "");
    assert!(status == 200 && body.contains("js/main.js"), "{head}");
    let policy = format!("connect-src 'self' ws://{}", gateway.place);
    assert!(head.to_lowercase().contains(&policy), "{head}");
    let visitor = Visitor { headers: vec![("cookie", cookie)], ..Visitor::operator(1) };
    let here = Console { token: None, ..gateway.console(&robot, &secret) };
    drop(Page::open(&here, &visitor).unwrap());
    assert!(gateway.end().success());
    group.down();
}

#[test]
fn gateway_outlives_its_robots_console() {
    let group = Group::up(&[]);
    let (gateway, robot) = started(&group);
    let secret = gateway.add("ann", &["--operator", "*"]);
    let here = gateway.console(&robot, &secret);
    let mut page = Page::open(&here, &visitor(1)).unwrap();
    let before = group.incarnation("console");
    group.signal("console", Signal::KILL);
    page.until("the end of the page", |page| page.closed.clone());
    group.wait_for_restart("console", before);
    let mut page = wait_for("the page again", 20.0, || Page::open(&here, &visitor(1)).ok());
    page.stop();
    group.must(&["stop", "console"]);
    let (status, _, body) = http(&here, "GET", &format!("/{robot}/"), &[], "");
    assert!((500..=599).contains(&status), "{status} {body}");
    assert!(gateway.end().success());
    group.down();
}

/// What cannot be recorded is not ordered, but for a stop.
#[test]
fn gateway_with_a_full_disk_stops_and_commands_nothing_else() {
    let group = Group::up(&[]);
    let robot = group.paths().name().to_string();
    let full = |folder: &Path| {
        std::fs::create_dir(folder).unwrap();
        std::os::unix::fs::symlink("/dev/full", folder.join("audit.jsonl")).unwrap();
    };
    let gateway = Gateway::start_in(group.paths().home(), &["--group", &robot], full);
    let secret = gateway.add("ann", &["--operator", "*"]);
    group.console();
    let mut page = Page::open(&gateway.console(&robot, &secret), &visitor(1)).unwrap();
    page.stop();
    group.wait_shown(true);
    for verb in ["resume", "say"] {
        let done = page.ask(verb, &json!({ "text": "get me the bowl" }));
        let why = done["error"].as_str().unwrap_or_default();
        assert!(done["ok"] == false && why.contains("cannot be recorded"), "{done}");
    }
    assert_eq!(group.arm()["stopped"], true);
    assert!(gateway.end().success());
    group.down();
}

/// A frame of 0.1 s of silence in a page's stream of sound.
fn silence(stream: u32, before: u64) -> Vec<u8> {
    let mut bytes = vec![1, 0, 0, 0];
    bytes.extend(stream.to_le_bytes());
    bytes.extend(0_f64.to_le_bytes());
    bytes.extend(before.to_le_bytes());
    bytes.extend([0; 3_200]);
    bytes
}

/// What an operator's page may try so that the audit says less, or something else, than what was ordered.
#[test]
fn gateway_records_what_it_passes_on_however_it_is_ordered() {
    const STOPS: usize = 60;
    let group = Group::up(&[]);
    let (gateway, robot) = started(&group);
    let ann = gateway.console(&robot, &gateway.add("ann", &["--operator", &robot]));
    let mut page = Page::open(&ann, &visitor(1)).unwrap();
    let alternatives = json!([{ "text": "get me the metal bowl", "weight": 1e6 }]);
    page.ask("say", &json!({ "text": "hello there", "alternatives": alternatives }));
    let said = gateway.wait_for_entry("ann", "say", "ordered");
    assert_eq!(
        (&said["text"], &said["with"]["alternatives"]),
        (&json!("hello there"), &alternatives)
    );
    page.ask("restart_service", &json!({ "text": "policy", "service": "recorder" }));
    assert_eq!(gateway.wait_for_entry("ann", "restart_service", "ordered")["text"], "recorder");
    let twice = r#"{"t":"do","id":70,"do":"say","text":"hello","text":"get me the clear bowl"}"#;
    page.send_raw(tungstenite::Message::text(twice));
    wait_for("the words that count", 10.0, || {
        gateway.audit().iter().any(|it| it["text"] == "get me the clear bowl").then_some(())
    });

    // Sound, and stops beyond the budget, of a page that closes at once.
    page.send_raw(tungstenite::Message::binary(silence(7, 0)));
    (0..STOPS).for_each(|_| page.send(&json!({ "t": "do", "id": 9, "do": "stop" })));
    page.send(&json!({ "t": "do", "id": 10, "do": "stop" }));
    page.send_raw(tungstenite::Message::Close(None));
    page.until("the end of the page", |page| page.closed.clone());
    let closed = gateway.wait_for_entry("ann", "close", "done");
    let entries = gateway.audit();
    let stops = entries.iter().filter(|it| it["what"] == "stop" && it["outcome"] == "ordered");
    let counted = stops.map(|stop| match stop["text"].as_str() {
        Some(more) => more.trim_end_matches(" more").parse().unwrap(),
        None => 1,
    });
    assert_eq!(counted.sum::<usize>(), STOPS + 1, "{entries:#?}");
    group.wait_shown(true);
    assert_eq!(gateway.wait_for_entry("ann", "sound", "ordered")["order"][0], closed["order"][0]);
    assert!(gateway.end().success());
    group.down();
}

#[test]
fn gateway_closes_pages_when_their_session_or_secret_ends() {
    let group = Group::up(&[]);
    let (gateway, robot) = started(&group);
    let secret = gateway.add("ann", &["--operator", "*"]);
    let [here, root] = [&robot, ""].map(|robot| gateway.console(robot, &secret).without_token());
    let log_in = || {
        let (_, head, _) = http(&root, "GET", &format!("/{robot}/?token={secret}"), &[], "");
        let lower = head.to_lowercase();
        let (_, cookie) = lower.split_once("set-cookie: ").unwrap_or_else(|| panic!("{head}"));
        cookie.split(';').next().unwrap().to_owned()
    };
    let open = |number, cookie: &str| {
        let headers = vec![("cookie", cookie.to_owned())];
        Page::open(&here, &Visitor { headers, ..Visitor::operator(number) }).unwrap()
    };
    let (first, second) = (log_in(), log_in());
    let (mut out, mut renewed) = (open(1, &first), open(2, &second));
    let mut by_secret = Page::open(&gateway.console(&robot, &secret), &visitor(3)).unwrap();
    let origin = format!("Origin: http://{}", gateway.place);
    let began = Instant::now();
    let (status, head, _) =
        http(&root, "POST", "/_/logout", &[&origin, &format!("Cookie: {first}")], "");
    assert_eq!(status, 303, "{head}");
    let closed = out.until("the end of the page", |page| page.closed.clone());
    println!("page closed after {:.1} s", began.elapsed().as_secs_f64());
    assert_eq!(closed.0, 1008, "{closed:?}");
    // Another session goes on.
    renewed.stop();
    let began = Instant::now();
    assert_eq!(gateway.call("add", &["ann", "--operator", "*", "--renew"]).code, Some(0));
    for page in [&mut renewed, &mut by_secret] {
        let closed = page.until("the end of the page", |page| page.closed.clone());
        println!("page closed after {:.1} s", began.elapsed().as_secs_f64());
        assert_eq!(closed.0, 1008, "{closed:?}");
    }
    assert!(gateway.end().success());
    group.down();
}
