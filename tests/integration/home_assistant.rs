//! The integration for Home Assistant: its fake robot serves answers that a real console gave, and still gives.
//!
//! `WHICHONE_BLESS=1` records them again.

use std::path::PathBuf;

use serde_json::{Map, Value as Json, json};
use whichone_tests::http_program::{Answer, Program};
use whichone_tests::{Group, wait_for};

use crate::http::until_state;

/// Recorded answers and events, which the integration's own tests serve.
const FIXTURES: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../shared/sdk/home-assistant/tests/fixtures/console.json"
);
/// Values that differ from run to run, with the moment, or in the last digit between processors.
const VARYING: [&str; 11] = [
    "id",
    "name",
    "version",
    "prompt",
    "utterance",
    "phase",
    "moving",
    "seconds",
    "remaining_s",
    "stop",
    "belief",
];

/// Answers by name, as they are asked for.
#[derive(Default)]
struct Recorder(Map<String, Json>);

impl Recorder {
    /// Asks, and records what is answered.
    fn ask(
        &mut self,
        name: &str,
        program: &Program,
        request: (&str, &str, &[&str], Json),
    ) -> Answer {
        let (method, path, headers, body) = request;
        let text = if body.is_null() { String::new() } else { body.to_string() };
        let answer = program.ask(method, path, headers, &text);
        self.add(name, (method, path), &answer);
        answer
    }

    fn add(&mut self, name: &str, (method, path): (&str, &str), answer: &Answer) {
        let recorded = json!({
            "method": method, "path": path, "status": answer.status,
            "type": answer.header("content-type"), "retry_after": answer.header("retry-after"),
            "body": answer.body,
        });
        assert!(self.0.insert(name.to_owned(), recorded).is_none(), "{name}: recorded twice");
    }

    fn get(&mut self, name: &str, program: &Program, path: &str) -> Answer {
        self.ask(name, program, ("GET", path, &[], Json::Null))
    }

    fn post(&mut self, name: &str, program: &Program, path: &str) -> Answer {
        self.ask(name, program, ("POST", path, &[], Json::Null))
    }

    /// Waits until robot and arm are both in the state, which they do not enter at once, and records it.
    fn state(&mut self, name: &str, program: &Program, state: &str, arm: &Json) {
        let found = wait_for(name, 20.0, || {
            let answer = program.get("/state");
            let (body, arm_now) = (&answer.body, &answer.body["arm"]);
            let wanted = body["state"] == state
                && (&arm_now["object"], &arm_now["stopped"]) == (&arm["object"], &arm["stopped"]);
            wanted.then_some(answer)
        });
        self.add(name, ("GET", "/state"), &found);
    }

    fn say(&mut self, name: &str, program: &Program, key: &str, body: Json) -> Answer {
        self.ask(name, program, ("POST", "/say", &[&format!("Idempotency-Key: {key}")], body))
    }
}

/// What does not vary of a value.
fn fixed(value: &Json) -> Json {
    match value {
        Json::Object(fields) => {
            let kept = fields.iter().filter(|(key, _)| !VARYING.contains(&key.as_str()));
            kept.map(|(key, value)| (key.clone(), fixed(value))).collect()
        }
        Json::Array(items) => items.iter().map(fixed).collect(),
        other => other.clone(),
    }
}

/// A dialogue with everything that the integration distinguishes. The arm moves in real time.
fn record_answers(recorder: &mut Recorder) {
    let group = Group::up(&["arm.time_scale=1"]);
    let hall = Program::new(&group, "hall", "see,talk,stop,resume");
    let viewer = Program::new(&group, "viewer", "see");
    until_state(&hall, "idle");
    recorder.get("info", &Program::with_token(&group, None), "/info");
    recorder.get("no_token", &Program::with_token(&group, None), "/state");
    let at_rest = json!({ "object": null, "stopped": false });
    recorder.state("state_idle", &hall, "idle", &at_rest);
    recorder.say("right", &viewer, "k0", json!({ "text": "get me the bowl" }));
    let request = json!({ "text": "get me the bowl", "conversation": "hall" });
    recorder.say("question", &hall, "k1", request.clone());
    recorder.say("question_again", &hall, "k1", request);
    let other = json!({ "text": "get me the clear bowl", "conversation": "kitchen" });
    recorder.say("other_words", &hall, "k1", other.clone());
    recorder.say("busy", &hall, "k2", other);
    recorder.state("state_asking", &hall, "asking", &at_rest);
    let says = |text: &str| json!({ "text": text, "conversation": "hall" });
    let early = json!({ "text": "yes", "conversation": "hall", "seen": 999 });
    recorder.say("unseen_line", &hall, "k3", early);
    recorder.say("fetching", &hall, "k4", says("the clear one"));
    let with_clear = json!({ "object": "clear", "stopped": false });
    recorder.state("state_fetching", &hall, "fetching", &with_clear);
    recorder.say("denied", &hall, "k5", says("no, not that one"));
    recorder.say("ended", &hall, "k6", says("never mind"));
    until_state(&hall, "idle");
    recorder.post("nothing_open", &hall, "/cancel");
    recorder.say("stopped", &hall, "k7", says("stop"));
    recorder.add("stop", ("POST", "/motion/stop"), &hall.stop());
    wait_for("the line about it", 10.0, || {
        let state = hall.get("/state").body;
        state["text"].as_str().is_some_and(|text| text.starts_with("I have stopped")).then_some(())
    });
    let stopped = json!({ "object": null, "stopped": true });
    recorder.state("state_stopped", &hall, "stopped", &stopped);
    hall.stop();
    recorder.post("too_soon", &hall, "/motion/resume");
    let other = json!({ "stop": 1 });
    recorder.ask("other_stop", &hall, ("POST", "/motion/resume", &[], other));
    let resumed = wait_for("the release", 20.0, || {
        Some(hall.post("/motion/resume")).filter(|answer| answer.status == 200)
    });
    recorder.add("resumed", ("POST", "/motion/resume"), &resumed);
    group.must(&["hold", "speech"]);
    recorder.state("state_held", &hall, "held", &at_rest);
    recorder.say("unavailable", &hall, "k8", says("the white one"));
    group.down();
}

/// The events of a dialogue that ends with a delivery.
fn record_events() -> Vec<Json> {
    let group = Group::up(&[]);
    let hall = Program::new(&group, "hall", "see,talk,stop,resume");
    until_state(&hall, "idle");
    let mut stream = hall.events(None);
    hall.say("get me the bowl");
    hall.say("the clear one");
    let mut events = Vec::new();
    while let Some((name, data)) = stream.next_event() {
        events.push(json!({ "event": name, "data": data }));
        if name == "ended" {
            break;
        }
    }
    group.down();
    events
}

/// Events in their order, but for `state`, which several changes may share.
fn lines(recorded: &Json) -> Vec<Json> {
    let events = recorded["events"].as_array().expect("events");
    events.iter().filter(|event| event["event"] != "state").map(fixed).collect()
}

#[test]
fn fake_robot_of_home_assistant_answers_as_a_console_does() {
    let mut recorder = Recorder::default();
    let events = std::thread::scope(|scope| {
        let events = scope.spawn(record_events);
        record_answers(&mut recorder);
        events.join().expect("events")
    });
    let found = json!({ "answers": recorder.0, "events": events });
    let path = PathBuf::from(FIXTURES);
    if std::env::var_os("WHICHONE_BLESS").is_some() {
        let text = serde_json::to_string_pretty(&found).unwrap();
        std::fs::write(&path, format!("{text}\n")).unwrap();
        return;
    }
    let text = std::fs::read_to_string(&path).unwrap();
    let recorded: Json = serde_json::from_str(&text).unwrap();
    let names =
        |of: &Json| of["answers"].as_object().map(|all| all.keys().cloned().collect::<Vec<_>>());
    assert_eq!(names(&found), names(&recorded), "help: WHICHONE_BLESS=1 records the answers again");
    for name in names(&recorded).unwrap_or_default() {
        let [now, then] = [&found, &recorded].map(|all| fixed(&all["answers"][&name]));
        assert_eq!(now, then, "{name}; help: WHICHONE_BLESS=1 records the answers again");
    }
    assert_eq!(lines(&found), lines(&recorded), "help: WHICHONE_BLESS=1 records the events again");
}
