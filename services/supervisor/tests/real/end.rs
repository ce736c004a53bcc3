use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use rustix::process::Signal;
use serde_json::json;
use service::control::{DownReport, Reply, Request, Target};
use service::status::Actual;

use crate::harness::{Group, WAIT_MS, send, service, wait_for, with};

#[track_caller]
fn down(group: &mut Group) -> DownReport {
    let Reply::Down(report) = group.ask(&Request::Down) else { panic!("not down") };
    assert_eq!(group.wait_end().code(), Some(0));
    group.check_nothing_left();
    report
}

#[test]
fn services_end_in_the_reverse_order() {
    let mut group = Group::ready(vec![
        service("arm", &[]),
        with(service("policy", &["ends-slowly", "100"]), "after", json!(["arm"])),
        with(service("speech", &["ends-slowly", "100"]), "after", json!(["policy"])),
    ]);
    let report = down(&mut group);
    assert_eq!(report.killed, [""; 0]);
    assert_eq!(report.orphans, [""; 0]);
    assert_eq!(group.events()[3..], ["speech 1 ended", "policy 1 ended", "arm 1 ended"]);
}

#[test]
fn service_that_ignores_the_stop_request_is_killed_and_reported() {
    let mut group = Group::ready(vec![
        with(service("arm", &["ignores-term"]), "stop_ms", json!(200)),
        service("policy", &[]),
    ]);
    assert_eq!(down(&mut group).killed, ["arm"]);
}

#[test]
fn suspended_process_still_shuts_down() {
    let mut group = Group::ready(vec![service("arm", &[])]);
    send(group.pid("arm"), Signal::STOP);
    let begun = Instant::now();
    let report = down(&mut group);
    assert_eq!(report.killed, [""; 0], "it was woken and shut down");
    assert!(begun.elapsed() < Duration::from_secs(10));
    assert_eq!(group.events().last().unwrap(), "arm 1 ended");
}

#[test]
fn signal_to_the_supervisor_shuts_the_group_down() {
    for signal in [Signal::TERM, Signal::INT, Signal::HUP] {
        let mut group = Group::ready(vec![service("arm", &[])]);
        send(group.supervisor_pid(), signal);
        assert_eq!(group.wait_end().code(), Some(0));
        group.check_nothing_left();
        assert_eq!(group.events().last().unwrap(), "arm 1 ended");
    }
}

/// As a shell starts what a script calls with `nohup`, or puts into the background.
#[test]
fn closed_terminal_is_ignored_under_nohup() {
    let mut group = Group::ready(vec![service("arm", &[])]);
    down(&mut group);
    let plain = group.command();
    let mut ignoring = Command::new("sh");
    ignoring.args(["-c", "trap '' HUP; exec \"$0\" \"$@\""]).arg(plain.get_program());
    ignoring.args(plain.get_args()).stdin(Stdio::null());
    ignoring.envs(plain.get_envs().filter_map(|(key, value)| Some((key, value?))));
    group.run_as(ignoring);
    group.done(&Request::WaitReady { wait_ms: WAIT_MS });
    send(group.supervisor_pid(), Signal::HUP);
    // It answers after it has taken its signals.
    assert!(group.status().services.iter().all(|it| it.actual == Actual::Ready));
    send(group.supervisor_pid(), Signal::TERM);
    assert_eq!(group.wait_end().code(), Some(0));
    group.check_nothing_left();
}

#[test]
fn orphans_in_the_process_group_are_killed_and_reported() {
    let mut group = Group::ready(vec![service("arm", &["leaves", "child"])]);
    let left = group.left_behind();
    assert!(crate::harness::is_alive(left));
    let report = down(&mut group);
    assert_eq!(report.orphans, [format!("sleep ({left})")]);
}

#[test]
fn orphans_outside_the_process_group_are_killed_when_their_service_ends() {
    let group = Group::ready(vec![service("arm", &["leaves", "daemon"]), service("policy", &[])]);
    let left = group.left_behind();
    send(group.pid("policy"), Signal::KILL);
    group.until_ready("policy", 2);
    assert!(crate::harness::is_alive(left), "its own service still runs");
    group.done(&Request::Stop(Target::new("arm", WAIT_MS)));
    wait_for("the daemon to be killed", || (!crate::harness::is_alive(left)).then_some(()));
    assert_eq!(group.status().orphans_killed, 1);
}

#[test]
fn group_that_is_stopping_rejects_requests() {
    let mut group = Group::ready(vec![service("arm", &["ends-slowly", "1000"])]);
    send(group.supervisor_pid(), Signal::TERM);
    group.until("arm", Actual::Stopping);
    let refusal = group.refused(&Request::Start(Target::new("arm", 0)));
    assert_eq!(refusal.message, "the group is stopping");
    assert_eq!(down(&mut group).killed, [""; 0]);
}

#[test]
fn group_can_be_restarted_once_down() {
    let mut group = Group::ready(vec![service("arm", &[])]);
    for _ in 0..3 {
        group.ask(&Request::Down);
        group.run();
        group.done(&Request::WaitReady { wait_ms: WAIT_MS });
    }
}
