use serde_json::json;
use service::control::{RefusalKind, Reply, Request, Target};
use service::exit::Exit;
use service::status::{Actual, Wanted};

use crate::harness::{Group, WAIT_MS, service, with};

fn start(service: &str) -> Request {
    Request::Start(Target::new(service, WAIT_MS))
}

fn stop(service: &str) -> Request {
    Request::Stop(Target::new(service, WAIT_MS))
}

fn restart(service: &str) -> Request {
    Request::Restart { service: service.into(), original: false, wait_ms: WAIT_MS }
}

#[test]
fn services_are_stopped_started_and_restarted_one_by_one() {
    let group = Group::ready(vec![service("arm", &[]), service("policy", &[])]);
    let policy = group.pid("policy");
    assert_eq!(group.done(&stop("arm")), "arm is down");
    let arm = group.service("arm");
    assert_eq!((arm.wanted, arm.actual, arm.pid), (Wanted::Down, Actual::Down, None));
    assert_eq!(group.done(&start("arm")), "arm is ready");
    assert_eq!(group.done(&start("arm")), "arm is ready", "again changes nothing");
    assert_eq!(group.service("arm").incarnation, 2);
    assert_eq!(group.done(&restart("arm")), "arm is ready");
    assert_eq!(group.service("arm").incarnation, 3);
    assert_eq!(group.pid("policy"), policy);
}

#[test]
fn held_service_stays_down_until_released() {
    let group = Group::ready(vec![service("arm", &[])]);
    let hold = Request::Hold(Target::new("arm", WAIT_MS));
    assert_eq!(group.done(&hold), "arm is held");
    let held = group.service("arm");
    assert_eq!((held.wanted, held.actual), (Wanted::Up, Actual::Held));
    assert_eq!(held.why.as_deref(), Some("held by the operator"));
    let release = Request::Release(Target::new("arm", WAIT_MS));
    assert_eq!(group.done(&release), "arm is ready");
}

#[test]
fn operator_mistakes_are_reported() {
    let group = Group::ready(vec![service("arm", &[])]);
    let refusal = group.refused(&stop("leg"));
    assert_eq!(refusal.kind, RefusalKind::Usage);
    assert_eq!(refusal.message, "unknown service leg; help: use one of arm");
}

#[test]
fn reload_restarts_only_affected_services() {
    let description = |fingerprint: &str, stop_ms: u64| {
        let policy = with(service("policy", &[]), "fingerprint", json!(fingerprint));
        json!({ "services": [with(service("arm", &[]), "stop_ms", json!(stop_ms)), policy] })
    };
    let group = Group::start_with(description("a", 5000));
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
    let reload = || group.ask(&Request::Reload { wait_ms: WAIT_MS });
    assert_eq!(reload(), Reply::Reloaded { restarted: vec![] });
    group.describe(&description("b", 6000));
    assert_eq!(reload(), Reply::Reloaded { restarted: vec!["policy".into()] });
    assert_eq!((group.service("arm").incarnation, group.service("policy").incarnation), (1, 2));
    let published = std::fs::read_to_string(group.paths.run().join("published")).unwrap();
    assert!(published.contains("6000"));
}

#[test]
fn reload_that_cannot_be_written_says_so_and_changes_nothing() {
    let description = |fingerprint: &str| json!({ "services": [with(service("arm", &[]), "fingerprint", json!(fingerprint))] });
    let group = Group::start_with(description("a"));
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
    let published = group.paths.run().join("published");
    std::fs::remove_file(&published).unwrap();
    std::fs::create_dir(&published).unwrap();
    group.describe(&description("b"));
    let reload = Request::Reload { wait_ms: WAIT_MS };
    let refusal = group.refused(&reload);
    assert_eq!((refusal.kind, refusal.exit()), (RefusalKind::Storage, Exit::Storage));
    for words in ["settings cannot be written to", "KiB free", "nothing was changed"] {
        assert!(refusal.message.contains(words), "{}", refusal.message);
    }
    std::fs::remove_dir(&published).unwrap();
    assert_eq!(group.ask(&reload), Reply::Reloaded { restarted: vec!["arm".into()] });
}

#[test]
fn reload_of_invalid_configuration_changes_nothing() {
    let group = Group::ready(vec![service("arm", &[])]);
    let reload = Request::Reload { wait_ms: WAIT_MS };
    group.describe(&json!({ "services": "none" }));
    let refusal = group.refused(&reload);
    assert_eq!(refusal.kind, RefusalKind::Config);
    assert_eq!(refusal.details.len(), 1);
    group.describe(&json!({ "services": [service("arm", &[]), service("leg", &[])] }));
    assert_eq!(group.refused(&reload).kind, RefusalKind::Config);
    assert_eq!(group.service("arm").incarnation, 1);
}

#[test]
fn chosen_scene_stays_in_force_for_later_reloads() {
    let description = |words: &[&str]| json!({ "services": [service("arm", words)] });
    let group = Group::start_with(description(&["ready"]));
    let scene = || group.status().scene;
    assert_eq!(scene(), "bowls");
    let reply = group.ask(&Request::UseScene { scene: "tools".into(), wait_ms: WAIT_MS });
    assert_eq!((reply, scene()), (Reply::Reloaded { restarted: vec![] }, "tools".to_owned()));
    group.ask(&Request::Reload { wait_ms: WAIT_MS });
    assert_eq!(scene(), "tools");
}

#[test]
fn reload_releases_a_service_that_rejected_its_configuration() {
    let description = |words: &[&str]| json!({ "services": [service("arm", words)] });
    let group = Group::start_with(description(&["exits", "78"]));
    group.until("arm", Actual::Held);
    group.describe(&description(&["ready"]));
    let reply = group.ask(&Request::Reload { wait_ms: WAIT_MS });
    assert_eq!(reply, Reply::Reloaded { restarted: vec!["arm".into()] });
    assert_eq!(group.service("arm").actual, Actual::Ready);
}
