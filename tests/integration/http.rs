//! Programs that talk to the robot over HTTP: rights, dialogues, the stop, keys through kills, events.

use std::collections::BTreeSet;
use std::os::unix::fs::MetadataExt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use rustix::process::Signal;
use scene::Scene;
use serde_json::{Value as Json, json};
use whichone_tests::console::http;
use whichone_tests::gateway::Gateway;
use whichone_tests::http_program::Program;
use whichone_tests::{Group, wait_for};

/// The arm in real time, so that it moves for seconds.
const REAL_TIME: &str = "arm.time_scale=1";
const ALL: &str = "see,talk,stop,resume";

fn bowls() -> Scene {
    let text = include_str!("../../config/scenes/bowls.toml");
    Scene::from_toml("bowls.toml", text).unwrap()
}

/// Waits until the robot is in a state, and returns it whole.
pub(crate) fn until_state(program: &Program, word: &str) -> Json {
    wait_for(&format!("the state {word}"), 20.0, || {
        let state = program.get("/state").body;
        (state["state"] == word).then_some(state)
    })
}

#[test]
fn tokens_have_names_rights_and_an_audit() {
    let group = Group::up(&[]);
    let nobody = Program::with_token(&group, None);
    let info = nobody.get("/info").body;
    assert_eq!((&info["api"], &info["name"]), (&json!(1), &json!(group.paths().name().as_str())));
    let orders = [
        ("GET", "/state", "see"),
        ("POST", "/say", "talk"),
        ("POST", "/cancel", "talk"),
        ("POST", "/motion/stop", "stop"),
        ("POST", "/motion/resume", "resume"),
    ];
    let body = json!({ "text": "the bowl" }).to_string();
    for (method, path, _) in orders {
        let refused = nobody.ask(method, path, &[], &body);
        assert_eq!((refused.status, &refused.body["code"]), (401, &json!("token")), "{path}");
        assert_eq!(refused.header("www-authenticate").as_deref(), Some("Bearer"));
    }
    for right in ["see", "talk", "stop", "resume"] {
        let program = Program::new(&group, right, right);
        for (method, path, needed) in orders.iter().filter(|(.., needed)| *needed != right) {
            let refused = program.ask(method, path, &[], &body);
            let found = (refused.status, &refused.body["code"]);
            assert_eq!(found, (403, &json!("right")), "{right} {path} {needed}");
        }
    }
    let see = Program::with_token(&group, None);
    assert_eq!(group.arm()["stopped"], false, "nothing that was refused is done");
    assert_eq!(group.dialogue()["interaction"], 0);

    let program = Program::new(&group, "hall", "see,talk");
    let secret = program.console.token.clone().unwrap();
    let file = group.paths().root().join("http.tokens");
    assert_eq!(std::fs::metadata(&file).unwrap().mode() & 0o777, 0o600);
    assert!(!std::fs::read_to_string(&file).unwrap().contains(&secret));
    assert_eq!(program.say("get me the bowl").reply()["kind"], "question");
    let listed = group.must(&["token", "list", "--json"]).json();
    let hall = listed["tokens"].as_array().unwrap().iter().find(|it| it["name"] == "hall").unwrap();
    assert_eq!(hall["may"], json!(["see", "talk"]));
    assert!(hall["used_s"].as_u64() > Some(1_700_000_000), "{listed}");
    let audit = std::fs::read_to_string(group.paths().root().join("http-audit.jsonl")).unwrap();
    let entries = audit.lines().map(|line| serde_json::from_str::<Json>(line).unwrap());
    let entries: Vec<Json> = entries.filter(|entry| entry["token"] == "hall").collect();
    assert_eq!(entries.len(), 1, "{audit}");
    assert_eq!(
        (&entries[0]["what"], &entries[0]["text"]),
        (&json!("say"), &json!("get me the bowl"))
    );

    // Whoever removes the audit does not end it.
    std::fs::remove_file(group.paths().root().join("http-audit.jsonl")).unwrap();
    program.say("the white one");
    let audit = std::fs::read_to_string(group.paths().root().join("http-audit.jsonl")).unwrap();
    assert!(audit.contains("the white one"), "{audit}");

    // Rights change at once, and so does the end.
    let mut events = program.events(None);
    assert_eq!(events.next_event().unwrap().0, "snapshot");
    assert!(group.must(&["token", "add", "hall", "--may", "see"]).stdout.contains("secret stays"));
    assert_eq!(program.say("yes").status, 403);
    assert_eq!(program.get("/state").status, 200);
    while events.next_event().is_some() {}
    group.must(&["token", "revoke", "hall"]);
    assert_eq!(program.get("/state").status, 401);
    assert_eq!(group.call(&["token", "revoke", "hall"]).code, Some(64));
    // The console's own token has every right, and the gateway asks with it.
    let owner = Program::with_token(&group, group.console().token);
    assert_eq!((owner.get("/state").status, see.get("/state").status), (200, 401));
    let busy = owner.post("/cancel");
    assert_eq!(
        (busy.status, &busy.body["code"]),
        (423, &json!("busy")),
        "it is the hall's request"
    );
    group.down();
}

#[test]
fn dialogue_over_http_ends_with_the_right_object() {
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", ALL);
    let mut events = program.events(None);
    assert_eq!(events.next_event().unwrap().0, "snapshot");
    let reply = program.converse(&bowls(), "get me the bowl", "white2");
    assert_eq!((&reply["kind"], &reply["expects_answer"]), (&json!("fetching"), &json!(false)));
    assert!(reply["text"].as_str().unwrap().starts_with("I will get the white bowl"), "{reply}");
    let (ended, before) = events.until("the end", |name, _| name == "ended");
    assert_eq!((&ended["object"], &ended["outcome"]), (&json!("white2"), &json!("delivered")));
    assert!(before.iter().any(|name| name == "question"), "{before:?}");
    assert_eq!(until_state(&program, "idle")["ended"], ended);

    // Withdrawn while the robot asks; then there is nothing to withdraw.
    assert_eq!(program.say("get me the bowl").reply()["kind"], "question");
    assert_eq!(program.get("/state").body["state"], "asking");
    let cancelled = program.post("/cancel");
    assert_eq!(cancelled.reply()["ended"]["outcome"], "cancelled", "{cancelled:?}");
    let again = program.post("/cancel");
    assert_eq!((again.status, &again.body["code"]), (409, &json!("nothing_open")));
    group.verify_journals();
    group.down();
}

#[test]
fn stop_asks_for_no_owner_and_is_answered_at_rest() {
    let group = Group::up(&[REAL_TIME]);
    let hall = Program::new(&group, "hall", ALL);
    let guard = Program::new(&group, "guard", "see,stop");
    let fetching = hall.say("get me the clear bowl");
    assert_eq!(fetching.reply()["kind"], "fetching", "{fetching:?}");
    wait_for("motion", 20.0, || (group.arm()["moving"] == true).then_some(()));
    let kitchen =
        hall.say_under("k", &json!({ "text": "the white bowl", "conversation": "kitchen" }));
    assert_eq!((kitchen.status, &kitchen.body["code"]), (423, &json!("busy")));
    assert!(kitchen.header("retry-after").is_some());

    assert_eq!(guard.stop().body["at_rest"], true);
    wait_for("a stopped arm at rest", 20.0, || {
        let state = hall.get("/state").body;
        (state["state"] == "stopped" && state["arm"]["moving"] == false).then_some(())
    });
    assert_eq!(guard.post("/motion/resume").status, 403);
    guard.stop();
    let early = hall.post("/motion/resume");
    assert_eq!((early.status, &early.body["code"]), (409, &json!("too_soon")), "{early:?}");
    wait_for("the release", 20.0, || (hall.post("/motion/resume").status == 200).then_some(()));
    wait_for("motion", 20.0, || (group.arm()["moving"] == true).then_some(()));

    // In words, by who may not talk, while others do.
    let said = guard.say("stop!");
    assert_eq!((said.status, &said.reply()["kind"]), (200, &json!("stopped")), "{said:?}");
    assert_eq!(said.body["utterance"], Json::Null);
    wait_for("rest", 20.0, || (group.arm()["moving"] == false).then_some(()));
    assert_eq!(guard.say("the white one").status, 403);
    wait_for("the release", 20.0, || (hall.post("/motion/resume").status == 200).then_some(()));
    let outcome = group.await_pick(None);
    assert_eq!(outcome["outcome"], "delivered", "{outcome}");

    // Without a main loop, and without those that hear and decide.
    for service in ["speech", "policy", "grounding"] {
        group.must(&["hold", service]);
    }
    assert_eq!(
        until_state(&hall, "held")["why"].as_str().map(|why| why.contains("held")),
        Some(true)
    );
    assert_eq!(guard.say("stop").reply()["kind"], "stopped");
    let away = hall.say("the white bowl");
    assert_eq!((away.status, &away.body["code"]), (503, &json!("unavailable")), "{away:?}");
    assert!(away.header("retry-after").is_some());
    group.must(&["hold", "arm"]);
    let unconfirmed = guard.post("/motion/stop");
    assert_eq!((unconfirmed.status, &unconfirmed.body["code"]), (504, &json!("not_confirmed")));
    group.down();
}

#[test]
fn words_under_one_key_are_said_once_through_kills() {
    let group = Group::up(&["dialogue.turns.questions_max=1000"]);
    let program = Program::new(&group, "hall", "see,talk");
    let mut expected = 0;
    for service in ["speech", "grounding", "policy", "console"] {
        for turn in 0..3 {
            let body = json!({ "text": "the white one or the metal one", "wait_s": 20 });
            let key = format!("{service}-{turn}");
            let first = std::thread::scope(|scope| {
                let said = scope.spawn(|| program.try_to_say(&key, &body));
                group.signal(service, Signal::KILL);
                said.join().unwrap()
            });
            // The robot's console listens where it did before.
            let second = program.say_until_answered(&key, &body);
            let third = program.say_until_answered(&key, &body);
            expected += 1;
            let first = first.filter(|first| first.status == 200);
            for answer in first.iter().chain([&second, &third]) {
                assert_eq!(answer.body["utterance"], expected, "{service} {turn}: {answer:?}");
            }
            assert_eq!(third.body["known"], true);
            let other = json!({ "text": "the clear one" });
            let conflict = wait_for("an answer", 20.0, || program.try_to_say(&key, &other));
            assert_eq!(
                (conflict.status, &conflict.body["code"]),
                (409, &json!("key_of_another_text"))
            );
        }
    }
    assert_eq!(group.dialogue()["applied"], expected);
    group.verify_journals();
    group.down();
}

#[test]
fn thousand_requests_of_twenty_clients_are_an_utterance_each() {
    const CLIENTS: usize = 20;
    const EACH: usize = 50;
    let group = Group::up_in_memory(&["dialogue.turns.questions_max=1000"]);
    // Nothing is fetched, so that the interaction stays open.
    group.must(&["stop-motion"]);
    let program = Program::new(&group, "hall", "see,talk");
    let (seqs, busy) = (Mutex::new(BTreeSet::new()), AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for client in 0..CLIENTS {
            let (program, seqs, busy) = (&program, &seqs, &busy);
            scope.spawn(move || {
                for number in 0..EACH {
                    let (key, body) = (
                        format!("{client}-{number}"),
                        json!({ "text": format!("the metal one {client} {number}"), "wait_s": 0 }),
                    );
                    let say = || {
                        wait_for("an utterance", 60.0, || {
                            let answer = program.say_under(&key, &body);
                            let is_accepted = [200, 202].contains(&answer.status);
                            if !is_accepted {
                                assert!(answer.header("retry-after").is_some(), "{answer:?}");
                                busy.fetch_add(1, Ordering::Relaxed);
                            }
                            is_accepted.then(|| answer.body["utterance"].as_u64().unwrap())
                        })
                    };
                    let seq = say();
                    assert_eq!(say(), seq, "said again under its key");
                    assert!(seqs.lock().unwrap().insert(seq), "{seq} is two requests'");
                }
            });
        }
    });
    let seqs = seqs.into_inner().unwrap();
    let all = (CLIENTS * EACH) as u64;
    eprintln!("refused for a while: {}", busy.into_inner());
    assert_eq!((seqs.len() as u64, seqs.first(), seqs.last()), (all, Some(&1), Some(&all)));
    let applied = || (group.dialogue()["applied"] == all).then_some(());
    wait_for("every utterance to be applied", 60.0, applied);
    group.verify_journals();
    group.down();
}

#[test]
fn events_go_on_where_a_client_left_off() {
    let group = Group::up(&[]);
    let program = Program::new(&group, "hall", "see,talk");
    let mut events = program.events(None);
    assert_eq!(events.next_event().unwrap().0, "snapshot");
    assert_eq!(program.say("get me the bowl").reply()["kind"], "question");
    events.until("the question", |name, _| name == "question");
    let seen = events.last.clone().unwrap();
    drop(events);

    // Missed while it was away, through another incarnation of the console.
    program.say("never mind");
    wait_for("the end", 10.0, || (program.get("/state").body["ended"] != Json::Null).then_some(()));
    let before = group.incarnation("console");
    group.signal("console", Signal::KILL);
    group.wait_for_restart("console", before);
    let mut back = program.events(Some(&seen));
    let (ended, missed) = back.until("the end", |name, _| name == "ended");
    assert_eq!(ended["outcome"], "cancelled");
    assert!(
        !missed.iter().any(|name| ["gap", "snapshot", "question"].contains(&&**name)),
        "{missed:?}"
    );

    for unknown in ["nonsense", "0123abcd-7"] {
        let mut other = program.events(Some(unknown));
        let first = [other.next_event(), other.next_event()].map(|event| event.unwrap().0);
        assert_eq!(first, ["gap", "snapshot"], "{unknown}");
    }
    // So many of one token; the places come back.
    let open: Vec<_> = (0..7).map(|_| program.events(None)).collect();
    let refused = http(&program.console, "GET", "/api/v1/events", &["Connection: close"], "");
    assert!(refused.0 == 429 && refused.1.to_lowercase().contains("retry-after"), "{refused:?}");
    drop(open);
    group.down();
}

#[test]
fn gateway_passes_programs_with_their_persons_rights() {
    let group = Group::up(&[]);
    let robot = group.paths().name().to_string();
    let gateway = Gateway::start(group.paths().home(), &["--group", &robot]);
    let ann = gateway.add("ann", &["--operator", &robot]);
    let bob = gateway.add("bob", &["--viewer", "*"]);
    let folder = format!("/{robot}");
    let [ann, bob] =
        [ann, bob].map(|secret| Program::at(gateway.console(&robot, &secret), &folder));
    assert_eq!(bob.get("/state").status, 200);
    assert_eq!(bob.events(None).next_event().unwrap().0, "snapshot");
    for path in ["/motion/stop", "/motion/resume", "/cancel"] {
        assert_eq!(bob.post(path).status, 403, "{path}");
    }
    assert_eq!(bob.say("get me the bowl").status, 403);
    assert_eq!(bob.say("stop").status, 403, "people elsewhere do not stop what they only see");
    let reply = ann.converse(&bowls(), "get me the bowl", "white2");
    assert_eq!(reply["kind"], "fetching");
    assert_eq!(ann.stop().body["stopped"], true);
    for (person, what, outcome) in
        [("ann", "say", "ordered"), ("ann", "stop", "done"), ("bob", "stop", "refused")]
    {
        gateway.wait_for_entry(person, what, outcome);
    }
    assert_eq!(gateway.wait_for_entry("ann", "say", "ordered")["text"], "get me the bowl");
    let foreign = ann.ask("POST", "/motion/stop", &["Origin: http://evil.example"], "");
    assert_eq!(foreign.status, 403);
    drop(gateway);
    group.down();
}
