//! The live view in a real group, as a viewer written from the public protocol sees it.

use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};

use serde_json::{Value as Json, json};
use whichone_tests::console::{Visitor, http};
use whichone_tests::{DIALOGUE_CHANNELS, Ended, Group, run, wait_for};

/// Real time enough for a viewer to see each change, and one other origin.
const SETTINGS: [&str; 3] = [
    "arm.time_scale=10.0",
    "group.recorder.free_min_mib=0",
    "console.foxglove_origins=[\"https://viewer.example\"]",
];

/// The viewer, which has yet to be started.
fn viewer(group: &Group, scenario: &[&str]) -> Command {
    let python =
        std::env::var("WHICHONE_RECORDING_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let console = group.console();
    let mut command = Command::new(python);
    command.arg(concat!(env!("CARGO_MANIFEST_DIR"), "/recording/live.py"));
    command.args([console.place, console.token.unwrap()]).args(scenario);
    command
}

fn found(ended: &Ended) -> Json {
    assert_eq!(ended.code, Some(0), "{ended:?}");
    ended.json()
}

/// A viewer that works beside the test.
fn begin(mut viewer: Command) -> Child {
    viewer.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn metric(group: &Group, line: &str) -> Option<f64> {
    let (status, _, text) = http(&group.console(), "GET", "/metrics", &[], "");
    assert_eq!(status, 200);
    let found = text.lines().find_map(|printed| printed.strip_prefix(line)?.strip_prefix(' '));
    found.and_then(|number| number.parse().ok())
}

#[test]
#[ignore = "needs python3 with websockets, mcap-ros2-support, jsonschema"]
fn live_view_shows_a_dialogue_and_takes_the_operators_words() {
    let group = Group::up(&SETTINGS);
    let mut viewing = begin(viewer(&group, &["dialogue", "white2"]));
    // Once it has spoken the test answers for the user.
    let mut progress = BufReader::new(viewing.stderr.take().unwrap());
    let mut line = String::new();
    progress.read_line(&mut line).unwrap();
    assert_eq!(line, "said\n", "{}", group.logs());
    assert_eq!(group.await_pick(Some("white2"))["object"], "white2");
    let ended = viewing.wait_with_output().unwrap();
    std::io::Read::read_to_string(&mut progress, &mut line).unwrap();
    assert!(ended.status.success(), "{line}\n{}", group.logs());
    let found: Json = serde_json::from_slice(&ended.stdout).unwrap();
    let info = &found["info"];
    assert_eq!(info["capabilities"], json!(["parameters", "parametersSubscribe", "services"]));
    let urdf = found["parameters"]["/robot_description"].as_str().unwrap();
    let (_, _, served) = http(&group.console(), "GET", "/robot.urdf", &[], "");
    assert_eq!(urdf, served);
    assert_eq!(found["parameters"]["/group"], group.paths().name().as_str());
    assert_eq!(
        (&found["subscribed"], &found["set"]),
        (&json!({"/scene": "bowls"}), &json!(["bowls", 1]))
    );
    let says = found["says"].as_array().unwrap();
    assert_eq!(
        says[..2],
        [json!({"utterance": 1, "known": false}), json!({"utterance": 1, "known": true})]
    );
    for (say, why) in says[2..].iter().zip([
        "unknown field",
        "expected json",
        "does not exist",
        "conflict (409): utterance 1",
    ]) {
        assert!(say["failure"].as_str().unwrap().contains(why), "{say}");
    }
    assert_eq!(found["again"], json!({"utterance": 1, "known": true}), "another connection");
    let counts = found["counts"].as_object().unwrap();
    for topic in DIALOGUE_CHANNELS {
        assert!(counts.get(topic).and_then(Json::as_u64) > Some(0), "{topic}: {counts:?}");
    }
    assert!(!counts.contains_key("/speech/audio") && !counts.contains_key("/sound"));
    wait_for("no open topic", 10.0, || {
        (metric(&group, "whichone_console_live_viewers") == Some(0.0)).then_some(())
    });
    group.down();
}

#[test]
#[ignore = "needs python3 with websockets, mcap-ros2-support, jsonschema"]
fn live_view_refuses_foreign_pages_and_strangers() {
    let group = Group::up(&SETTINGS);
    let statuses = found(&run(&mut viewer(&group, &["refusals"]), "", 60.0));
    let expected = json!({
        "own": 101, "allowed": 101, "bearer": 101,
        "foreign": 403, "null": 403, "no_origin": 403,
        "no_token": 401, "wrong_token": 401,
        "older_protocol": 400, "no_protocol": 400, "screen": 400,
    });
    assert_eq!(statuses, expected);
    group.down();
    let group = Group::up(&["console.access=open"]);
    let upgrade = [
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
        "Sec-WebSocket-Protocol: foxglove.sdk.v1",
    ];
    let evil = [&upgrade[..], &["Host: evil.example:8377", "Origin: http://evil.example:8377"]];
    let (status, ..) =
        http(&group.console().without_token(), "GET", "/foxglove", &evil.concat(), "");
    assert_eq!(status, 421, "another name of this machine is an attack by another site");
    group.down();
}

#[test]
#[ignore = "needs python3 with websockets, mcap-ros2-support, jsonschema"]
fn live_view_gives_a_viewer_no_right_and_bears_malformed_frames() {
    let group = Group::up(&SETTINGS);
    let seed = std::env::var("WHICHONE_SEED").unwrap_or_else(|_| std::process::id().to_string());
    let ended = run(&mut viewer(&group, &["viewer", &seed]), "", 120.0);
    print!("{}", ended.stderr);
    let found = found(&ended);
    assert!(found["says"][0]["failure"].as_str().unwrap().contains("role=operator"), "{found}");
    assert_eq!(found["parameters"]["/scene"], "bowls");
    assert!(found["statuses"].as_u64() > Some(100), "{found}");
    assert_eq!(found["levels"], json!([2]));
    assert_eq!(found["too_long"][0], 1009, "{found}");
    assert!(found["too_long"][1].as_str().unwrap().contains("65536 bytes"), "{found}");
    // Not a word of it has reached the robot.
    assert_eq!(group.dialogue()["applied"], 0);
    assert_eq!(group.incarnation("console"), 1, "{}", group.logs());
    group.down();
}

#[test]
#[ignore = "needs python3 with websockets, mcap-ros2-support, jsonschema"]
fn live_view_that_does_not_read_harms_nobody() {
    let group = Group::up(&SETTINGS);
    let mut page = group.page(&Visitor::operator(1));
    let stalled = begin(viewer(&group, &["stall"]));
    wait_for("the viewer", 20.0, || {
        (metric(&group, "whichone_console_live_viewers") == Some(1.0)).then_some(())
    });
    let said = page.ask("say", &json!({ "text": "get me the bowl" }));
    assert_eq!(said["ok"], true, "{said}");
    assert_eq!(page.converse("metal2")["outcome"], "delivered");
    wait_for("its end", 60.0, || {
        (metric(&group, "whichone_console_viewers_dropped_total") == Some(1.0)).then_some(())
    });
    assert_eq!(metric(&group, "whichone_console_live_viewers"), Some(0.0));
    assert_eq!(group.incarnation("console"), 1, "{}", group.logs());
    // It reads its input to the end.
    let ended = stalled.wait_with_output().unwrap();
    assert!(ended.status.success(), "{ended:?}");
    drop(page);
    group.down();
}
