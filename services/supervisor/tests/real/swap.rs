use serde_json::json;
use service::control::{RefusalKind, Request};
use service::exit::ProcessExit;
use service::status::Actual;

use crate::harness::{Group, WAIT_MS, fixture, send, service, with};

fn swap(words: &[&str]) -> Request {
    let mut command = vec![fixture("fixture_service").display().to_string()];
    command.extend(words.iter().map(|&word| word.to_owned()));
    Request::Swap { service: "arm".into(), command, directory: "/".into() }
}

#[test]
fn swapped_command_survives_restarts() {
    let group = Group::ready(vec![service("arm", &[]), service("policy", &[])]);
    let policy = group.pid("policy");
    assert_eq!(group.done(&swap(&["ends-slowly", "0"])), "arm runs the new command");
    let arm = group.service("arm");
    assert_eq!((arm.actual, arm.incarnation), (Actual::Ready, 2));
    assert_eq!(arm.swapped.unwrap()[1..], ["ends-slowly", "0"]);
    send(group.pid("arm"), rustix::process::Signal::KILL);
    let again = group.until_ready("arm", 3);
    assert!(again.swapped.is_some());
    let last = again.last_exit.unwrap();
    assert_eq!((last.exit, last.incarnation, last.killed), (ProcessExit::Signal(9), 2, false));
    assert_eq!(group.pid("policy"), policy);
    let original = Request::Restart { service: "arm".into(), original: true, wait_ms: WAIT_MS };
    group.done(&original);
    assert_eq!(group.service("arm").swapped, None);
}

#[test]
fn swap_to_a_rejecting_command_is_rolled_back_with_the_reason() {
    let group = Group::ready(vec![with(service("arm", &[]), "critical", json!(true))]);
    let command = ["sh", "-c", "echo wrong schema >&2; exit 78"].map(str::to_owned).to_vec();
    let request = Request::Swap { service: "arm".into(), command, directory: "/".into() };
    let refusal = group.refused(&request);
    assert_eq!(refusal.kind, RefusalKind::NotReached);
    assert_eq!(
        refusal.message,
        "arm: the new command was not ready: exit 78 (configuration or schema refused); \
         the earlier command runs again"
    );
    assert_eq!(refusal.details, ["wrong schema"]);
    let arm = group.service("arm");
    assert_eq!((arm.actual, arm.incarnation, arm.swapped), (Actual::Ready, 3, None));
}

#[test]
fn swap_to_a_command_that_is_never_ready_is_rolled_back_at_the_deadline() {
    let group = Group::ready(vec![with(service("arm", &[]), "start_ms", json!(1500))]);
    let refusal = group.refused(&swap(&["never-ready"]));
    assert!(refusal.message.contains("was not ready in time"), "{}", refusal.message);
    assert_eq!(group.service("arm").actual, Actual::Ready);
}

#[test]
fn swap_to_a_missing_command_keeps_the_service_running() {
    let group = Group::ready(vec![service("arm", &[])]);
    let command = vec!["./no-such-arm".to_owned()];
    let request = Request::Swap { service: "arm".into(), command, directory: "/".into() };
    assert_eq!(group.refused(&request).kind, RefusalKind::Usage);
    assert_eq!(group.service("arm").incarnation, 1);
}

#[test]
fn service_can_be_swapped_repeatedly() {
    let group = Group::ready(vec![service("arm", &[])]);
    for round in 0..5 {
        let words: &[&str] = if round % 2 == 0 { &["ready"] } else { &["exits", "1"] };
        match round % 2 {
            0 => drop(group.done(&swap(words))),
            _ => drop(group.refused(&swap(words))),
        }
        assert_eq!(group.service("arm").actual, Actual::Ready);
    }
}
