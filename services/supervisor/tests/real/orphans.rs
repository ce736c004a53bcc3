use rustix::process::Signal;
use serde_json::json;
use service::control::{Request, Target};
use service::status::Actual;

use crate::harness::{Group, WAIT_MS, is_alive, send, service, wait_for, with};

/// Kills the supervisor and waits until it is reaped.
fn kill_supervisor(group: &mut Group) {
    send(group.supervisor_pid(), Signal::KILL);
    group.wait_end();
}

#[test]
fn services_end_by_themselves_when_the_supervisor_is_killed() {
    let deaf = with(service("policy", &["ignores-term"]), "stop_ms", json!(500));
    let mut group = Group::ready(vec![service("arm", &[]), deaf]);
    let services = [group.pid("arm"), group.pid("policy")];
    kill_supervisor(&mut group);
    wait_for("the services to end", || services.iter().all(|&pid| !is_alive(pid)).then_some(()));
    assert!(group.events().contains(&"policy 1 orphaned".to_owned()), "by its lifeline");
    group.run();
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
    group.ask(&Request::Down);
    group.wait_end();
    group.check_nothing_left();
}

#[test]
fn what_an_operator_put_down_stays_down_when_the_supervisor_is_killed() {
    let services = ["arm", "policy", "speech"].map(|name| service(name, &[]));
    let mut group = Group::ready(services.into());
    group.done(&Request::Hold(Target::new("arm", WAIT_MS)));
    group.done(&Request::Stop(Target::new("policy", WAIT_MS)));
    kill_supervisor(&mut group);
    group.run();
    group.until_ready("speech", 1);
    let states = ["arm", "policy"].map(|name| group.service(name).actual);
    assert_eq!(states, [Actual::Held, Actual::Down]);
    group.done(&Request::Release(Target::new("arm", WAIT_MS)));
    kill_supervisor(&mut group);
    group.run();
    group.until_ready("arm", 1);
    assert_eq!(group.service("policy").actual, Actual::Down);
    group.ask(&Request::Down);
    group.wait_end();
    group.run();
    group.until_ready("policy", 1);
}

#[test]
fn held_service_stays_so_when_the_group_fails_and_is_not_swapped() {
    let critical = with(service("policy", &[]), "critical", json!(true));
    let mut group = Group::ready(vec![service("arm", &[]), critical]);
    group.done(&Request::Hold(Target::new("arm", WAIT_MS)));
    let command = Request::Swap {
        service: "arm".into(),
        command: vec!["sleep".into(), "9".into()],
        directory: "/".into(),
    };
    let refusal = group.refused(&command);
    assert!(refusal.message.contains("whichone release arm"), "{}", refusal.message);
    // As by an init system: asked to end by a signal, and started again.
    send(group.supervisor_pid(), Signal::TERM);
    group.wait_end();
    group.run();
    group.until_ready("policy", 1);
    assert_eq!(group.service("arm").actual, Actual::Held);
}

#[test]
fn program_without_a_lifeline_ends_with_its_supervisor() {
    let sleep = json!({ "name": "arm", "command": ["sleep", "1000"] });
    let mut group = Group::start(vec![sleep]);
    let arm = wait_for("a process", || group.service("arm").pid);
    kill_supervisor(&mut group);
    wait_for("its end", || (!is_alive(arm)).then_some(()));
}

#[test]
fn new_supervisor_waits_for_services_of_the_previous_run() {
    let mut group = Group::ready(vec![service("arm", &["ends-slowly", "1500"])]);
    let arm = group.pid("arm");
    kill_supervisor(&mut group);
    group.run();
    assert!(!is_alive(arm));
    group.wait_for_log("waiting for services of a previous run");
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
    assert_eq!(group.events(), ["arm 1 ready", "arm 1 orphaned", "arm 1 ready"]);
}

#[test]
fn orphaned_service_is_killed_by_the_next_supervisor() {
    let shell = "trap '' TERM; echo deaf > $WHICHONE_HOME/lab/events; while :; do sleep 1; done";
    let stubborn = json!({ "name": "arm", "command": ["sh", "-c", shell], "stop_ms": 500 });
    let mut group = Group::start(vec![stubborn]);
    wait_for("its deafness", || (group.events() == ["deaf"]).then_some(()));
    let arm = group.pid("arm");
    kill_supervisor(&mut group);
    assert!(is_alive(arm));
    group.describe(&json!({ "services": [with(service("arm", &[]), "stop_ms", json!(500))] }));
    group.run();
    assert!(!is_alive(arm));
    group.wait_for_log("killing services of a previous run");
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
}
