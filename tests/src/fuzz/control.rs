//! Requests to the supervisor's control socket, and its replies.

use serde::{Serialize, de::DeserializeOwned};
use service::control::{Reply, Request, Target};

use super::bytes::{Input, chosen};

pub(super) fn run(input: &[u8]) {
    let mut input = Input(input);
    match input.byte() % 2 {
        0 => check::<Request>(input.0),
        _ => check::<Reply>(input.0),
    }
}

/// What is read is written as one line, and read again as the same.
fn check<T: Serialize + DeserializeOwned + PartialEq + std::fmt::Debug>(line: &[u8]) {
    match serde_json::from_slice::<T>(line) {
        Ok(read) => {
            let written = serde_json::to_string(&read).expect("what was read is written");
            assert!(!written.contains('\n'));
            let again = serde_json::from_str::<T>(&written);
            assert_eq!(again.expect("what was written is read"), read);
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

pub(super) fn seeds() -> Vec<Vec<u8>> {
    let service = || Target::new("grounding", 5_000);
    let requests = [
        Request::Ping,
        Request::Status,
        Request::WaitReady { wait_ms: 20 },
        Request::Start(service()),
        Request::Stop(service()),
        Request::Restart { service: "arm".into(), original: true, wait_ms: 0 },
        Request::Hold(service()),
        Request::Release(service()),
        Request::Swap {
            service: "grounding".into(),
            command: vec!["python3".into(), "own.py".into()],
            directory: "/home/ada".into(),
        },
        Request::Reload { wait_ms: 1 },
        Request::UseScene { scene: "tools".into(), wait_ms: 1 },
        Request::Down,
    ];
    let json = |request| serde_json::to_string(request).expect("a request is JSON");
    let mut seeds: Vec<_> = requests.iter().map(|request| chosen(0, json(request))).collect();
    for reply in [
        r#"{"reply":"done","message":"it runs"}"#,
        r#"{"reply":"reloaded","restarted":["arm"]}"#,
        r#"{"reply":"down","killed":[],"strays":["x"],"leftovers":[],"seconds":0.25}"#,
        r#"{"reply":"refused","kind":"usage","message":"no such service","details":["a"]}"#,
    ] {
        seeds.push(chosen(1, reply));
    }
    seeds
}
